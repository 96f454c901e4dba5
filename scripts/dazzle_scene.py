"""recordings/dazzle's scene for Blender 3.4 (Debian's): a polished pebble on a tag under a low sun.

blender -b -noaudio -P scripts/dazzle_scene.py -- TAG.png OUT [FIRST LAST]

Blender's world is the tag's frame: x right, y up as the tag is read, z out of the print, metres. Writes to OUT scene-linear radiance:
plate/%04d.exr of every frame, truth/%04d.exr and mask/%04d.png of every sixteenth, panorama.exr (equirectangular), object.glb, poses.csv.
"""
import math
import os
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

FRAMES, WIDTH, HEIGHT, FOCAL_PX = 24, 640, 480, 620.0
TAG_M, SHEET_M = 0.08, (0.21, 0.297)
WHITE, BLACK = 0.8, 0.04
SUN_RADIUS_RAD, SUN_AZIMUTH_DEG, SUN_ELEVATION_DEG = math.radians(1.0), 76.0, 34.0
SUN_COLOR = numpy.array([1.0, 0.88, 0.72])
SUN_OVER_SKY = 0.8  # irradiance of a level surface
PEBBLE_M = (0.044, 0.034, 0.016)


def metal(name, color, roughness):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    shader = result.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Metallic"].default_value = 1.0
    shader.inputs["Roughness"].default_value = roughness
    return result


def diffuse(name, color):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    nodes.remove(nodes["Principled BSDF"])
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1.0)
    links.new(shader.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])
    return result, shader


def rectangle(name, size, height, look):
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0, 0, height))
    bpy.context.object.name = name
    bpy.context.object.scale = (size[0], size[1], 1.0)
    bpy.context.object.data.materials.append(look)


def table_look():
    look, shader = diffuse("table", (0.2, 0.12, 0.07))
    nodes, links = look.node_tree.nodes, look.node_tree.links
    place, noise, ramp = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeValToRGB")
    stretch = nodes.new("ShaderNodeMapping")
    stretch.inputs["Scale"].default_value = (6.0, 40.0, 1.0)
    noise.inputs["Detail"].default_value = 6.0
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.08, 0.05, 0.03, 1), (0.33, 0.22, 0.14, 1)
    ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = 0.35, 0.65
    links.new(place.outputs["Object"], stretch.inputs["Vector"])
    links.new(stretch.outputs["Vector"], noise.inputs["Vector"])
    links.new(noise.outputs["Fac"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], shader.inputs["Color"])
    return look


def tag_cells(path):
    """The 8 x 8 cells of a print that `catchlight tag -o TAG.png` made: its first dark row is the border's."""
    sheet = bpy.data.images.load(path)
    dark = numpy.array(sheet.pixels[:]).reshape(sheet.size[1], sheet.size[0], -1)[::-1, :, 0] < 0.5
    top = int(numpy.argmax(dark.any(axis=1)))
    left, right = numpy.flatnonzero(dark[top])[[0, -1]]
    cell = (right + 1 - left) // 8
    middles = numpy.arange(8) * cell + cell // 2
    white = ~dark[numpy.ix_(top + middles, left + middles)]
    image = bpy.data.images.new("cells", 8, 8, float_buffer=True, is_data=True)
    image.pixels = numpy.repeat(white[::-1].astype(numpy.float32)[:, :, None], 4, axis=2).ravel()
    return image


def tag_look(path):
    look, shader = diffuse("tag", (WHITE,) * 3)
    nodes, links = look.node_tree.nodes, look.node_tree.links
    picture = nodes.new("ShaderNodeTexImage")
    picture.image = tag_cells(path)
    picture.interpolation = "Closest"
    ramp = nodes.new("ShaderNodeMix")
    ramp.data_type = "RGBA"
    ramp.inputs[6].default_value, ramp.inputs[7].default_value = (BLACK,) * 3 + (1,), (WHITE,) * 3 + (1,)
    links.new(picture.outputs["Color"], ramp.inputs[0])
    links.new(ramp.outputs[2], shader.inputs["Color"])
    return look


def build_places(tag_path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rectangle("table", (3.0, 3.0), -4e-4, table_look())
    rectangle("sheet", SHEET_M, -2e-4, diffuse("sheet", (WHITE,) * 3)[0])
    rectangle("tag", (TAG_M, TAG_M), 0.0, tag_look(tag_path))
    for name, place, size, turn, color in (
        ("box", (-0.22, 0.25, 0.05), (0.12, 0.08, 0.10), 20, (0.15, 0.3, 0.5)),
        ("brick", (0.20, 0.30, 0.04), (0.16, 0.09, 0.08), -35, (0.5, 0.16, 0.1)),
        ("block", (0.26, -0.02, 0.03), (0.06, 0.06, 0.06), 10, (0.2, 0.42, 0.18)),
    ):
        bpy.ops.mesh.primitive_cube_add(size=1.0, location=place, rotation=(0, 0, math.radians(turn)))
        bpy.context.object.scale = size
        bpy.context.object.data.materials.append(diffuse(name, color)[0])


def add_pebble():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1.0, location=(0, 0, PEBBLE_M[2]))
    pebble = bpy.context.object
    pebble.name = "pebble"
    pebble.scale = PEBBLE_M
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    bpy.ops.object.shade_smooth()
    pebble.data.materials.append(metal("polished", (0.95, 0.93, 0.90), 0.03))
    return pebble


def sky_with_sun():
    """Debian's CC0 studio light and a sun, which such pictures cannot hold."""
    folder = os.path.join(bpy.utils.resource_path("LOCAL"), "datafiles", "studiolights", "world")
    folder = folder if os.path.isdir(folder) else "/usr/share/blender/datafiles/studiolights/world"
    source = bpy.data.images.load(os.path.join(folder, "forest.exr"))
    width, height = 2048, 1024
    source.scale(width, height)
    sky = numpy.array(source.pixels[:], dtype=numpy.float64).reshape(height, width, -1)[:, :, :3]
    # Row 0 is the bottom. Blender: longitude 0 (+x) in the middle, growing to the left.
    latitude = (numpy.arange(height) + 0.5) / height * math.pi - math.pi / 2
    longitude = math.pi - (numpy.arange(width) + 0.5) / width * 2 * math.pi
    up = numpy.sin(latitude)[:, None] * numpy.ones(width)
    texel_sr = (numpy.cos(latitude) * math.pi / height * 2 * math.pi / width)[:, None]
    level = (sky * (numpy.maximum(up, 0) * texel_sr)[:, :, None]).sum(axis=(0, 1))
    azimuth, elevation = math.radians(SUN_AZIMUTH_DEG), math.radians(SUN_ELEVATION_DEG)
    sun = numpy.array([math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)])
    towards = numpy.stack([numpy.cos(latitude)[:, None] * numpy.cos(longitude), numpy.cos(latitude)[:, None] * numpy.sin(longitude), up], axis=2) @ sun
    texel_rad = math.pi / height
    share = numpy.clip((SUN_RADIUS_RAD - numpy.arccos(numpy.clip(towards, -1, 1))) / texel_rad + 0.5, 0, 1)
    solid_sr = (share * texel_sr).sum()
    radiance = SUN_OVER_SKY * level.mean() / (solid_sr * sun[2]) * SUN_COLOR / SUN_COLOR.mean()
    sky += share[:, :, None] * radiance
    image = bpy.data.images.new("sky", width, height, float_buffer=True)
    image.pixels = numpy.concatenate([sky, numpy.ones((height, width, 1))], axis=2).astype(numpy.float32).ravel()
    print("sun's radiance", radiance, "sky's irradiance", level)
    return image


def light_world():
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    picture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = sky_with_sun()
    world.node_tree.links.new(picture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])


def camera_pose(frame):
    """camera_from_tag in OpenCV's camera frame: a hand that circles the tag, and shakes a little."""
    t = frame / 35
    azimuth = math.radians(-104 + 26 * t + 0.5 * math.sin(9 * t))
    elevation = math.radians(36 + 3 * math.sin(3 * t) + 0.4 * math.sin(14 * t))
    distance = 0.42 - 0.05 * t
    eye = Vector((math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation), math.sin(elevation))) * distance
    aim = Vector((0.004 * math.sin(7 * t), 0.012 + 0.004 * math.sin(11 * t), 0.004))
    forward = (aim - eye).normalized()
    right = forward.cross(Vector((0, 0, 1))).normalized()
    right = (right + 0.03 * math.sin(5 * t) * forward.cross(right)).normalized()
    down = forward.cross(right)
    rotation = Matrix((right, down, forward))
    return rotation, -(rotation @ eye)


def make_camera():
    data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", data)
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    data.sensor_width = 36.0
    data.lens = FOCAL_PX / WIDTH * 36.0
    data.clip_start = 0.01
    return camera


def place(camera, rotation, translation):
    tag_from_camera = rotation.transposed()
    pose = (tag_from_camera @ Matrix(((1, 0, 0), (0, -1, 0), (0, 0, -1)))).to_4x4()
    pose.translation = -(tag_from_camera @ translation)
    camera.matrix_world = pose


def render(path, samples, file_format="OPEN_EXR"):
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.render.filepath = path
    scene.render.image_settings.file_format = file_format
    scene.render.image_settings.color_mode = "RGB" if file_format == "OPEN_EXR" else "RGBA"
    scene.render.image_settings.color_depth = "32" if file_format == "OPEN_EXR" else "8"
    bpy.ops.render.render(write_still=True)


def settings():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.max_bounces = 6
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.03
    scene.cycles.filter_width = 1.0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.view_settings.view_transform = "Raw"


def render_probe(out):
    scene = bpy.context.scene
    camera = make_camera()
    camera.data.type = "PANO"
    camera.data.cycles.panorama_type = "EQUIRECTANGULAR"
    camera.location, camera.rotation_euler = (0, 0, PEBBLE_M[2]), (math.pi / 2, 0, math.pi)  # tag -y in the middle
    scene.render.resolution_x, scene.render.resolution_y = 2048, 1024
    render(os.path.join(out, "panorama.exr"), 64)
    settings()


def render_mask(path):
    scene = bpy.context.scene
    hidden = [o for o in scene.objects if o.type == "MESH" and o.name != "pebble"]
    for other in hidden:
        other.hide_render = True
    scene.render.film_transparent = True
    render(path, 16, "PNG")
    scene.render.film_transparent = False
    for other in hidden:
        other.hide_render = False


def write_poses(out):
    with open(os.path.join(out, "poses.csv"), "w") as file:
        file.write("frame," + ",".join(f"r{r}{c}" for r in range(3) for c in range(3)) + ",tx,ty,tz\n")
        for frame in range(FRAMES):
            rotation, translation = camera_pose(frame)
            numbers = [rotation[r][c] for r in range(3) for c in range(3)] + list(translation)
            file.write(f"{frame}," + ",".join(f"{number:.9g}" for number in numbers) + "\n")


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :]
    tag_path, out = arguments[:2]
    first, last = (int(arguments[2]), int(arguments[3])) if len(arguments) > 2 else (0, FRAMES - 1)
    os.makedirs(out, exist_ok=True)
    build_places(os.path.abspath(tag_path))
    settings()
    light_world()
    write_poses(out)
    if first == 0:
        render_probe(out)
    camera = make_camera()
    for frame in range(first, last + 1):
        place(camera, *camera_pose(frame))
        render(os.path.join(out, "plate", f"{frame:04d}.exr"), 256 if frame % 16 == 0 else 48)
    pebble = add_pebble()
    if first == 0:
        bpy.ops.object.select_all(action="DESELECT")
        pebble.select_set(True)
        bpy.ops.export_scene.gltf(filepath=os.path.join(out, "object.glb"), use_selection=True, export_texcoords=False)
    for frame in range(first, last + 1):
        if frame % 16 == 0:
            place(camera, *camera_pose(frame))
            render(os.path.join(out, "truth", f"{frame:04d}.exr"), 256)
            render_mask(os.path.join(out, "mask", f"{frame:04d}.png"))


main()
