"""dazzle_footage.py RADIANCE RECORDING: what a camera makes of the radiance that dazzle_scene.py rendered.

Writes png/%04d.png (the plate with noise, 8-bit sRGB) into RADIANCE, and into RECORDING truth/, plate_clean/, mask/, probe.exr, camera.yaml. The truth glares: the glare is
convolved here by numpy's FFT with the kernel that docs/glare.md states, from Cycles' own radiance; nothing of the program takes part.
"""
import os
import sys

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2
import numpy

EXPOSURE = 0.4
NOISE = 2.3e-4  # variance over exposed linear signal
FRAMES, FOCAL_PX = 24, 620.0
PROBE = (512, 256)


def read_rgb(path):
    image = cv2.imread(path, cv2.IMREAD_UNCHANGED)
    if image is None:
        sys.exit(f"{path}: missing; run dazzle_scene.py to its end first")
    return image[:, :, 2::-1].astype(numpy.float64)


def codes(linear):
    light = numpy.clip(linear, 0, 1)
    srgb = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * numpy.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055)
    return numpy.round(255 * srgb).astype(numpy.uint8)


def write_rgb(path, image):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    cv2.imwrite(path, image[:, :, ::-1])


def probe_of(panorama):
    """OpenEXR's latlong (pixel centres on the poles and on +-180 degrees), each texel the mean of 8 x 8 places in it."""
    height, width, _ = panorama.shape
    across, down = PROBE
    fine = (numpy.arange(8) + 0.5) / 8 - 0.5
    columns = (numpy.arange(across)[:, None] + fine).ravel() / (across - 1) * width - 0.5
    rows = numpy.clip((numpy.arange(down)[:, None] + fine).ravel() / (down - 1), 0, 1) * height - 0.5
    wrapped = numpy.concatenate([panorama[:, -2:], panorama, panorama[:, :2]], axis=1).astype(numpy.float32)
    x, y = numpy.meshgrid((columns + 2).astype(numpy.float32), rows.astype(numpy.float32))
    samples = cv2.remap(wrapped, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return numpy.maximum(samples.reshape(down, 8, across, 8, 3).mean(axis=(1, 3)), 0)  # Blender upsamples the sky with overshoot


def camera_yaml(width, height):
    return f"""%YAML:1.0
---
image_width: {width}
image_height: {height}
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ {FOCAL_PX}, 0., {(width - 1) / 2}, 0., {FOCAL_PX}, {(height - 1) / 2}, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
"""


BLOOM_STRENGTH, STREAK_STRENGTH, DIRECTIONS, ROTATION_DEG, ATTENUATION = 0.05, 0.04, 4, 45.0, 0.92
THRESHOLD, BRIGHTEST = 1.0, 3e4


def cubic_b_spline(x):
    x = numpy.abs(x)
    return numpy.where(x < 1, 2 / 3 - x**2 + x**3 / 2, numpy.where(x < 2, (2 - x) ** 3 / 6, 0))


def excess_of(light):
    """What is over the sensor's white: the first filter, then the gate (docs/glare.md), at every pixel."""
    texel = light.shape[0] / 240
    reach = int(2 * texel)
    taps = cubic_b_spline(numpy.arange(-reach, reach + 1) / texel)
    filtered = cv2.sepFilter2D(light, -1, taps / taps.sum(), taps / taps.sum(), borderType=cv2.BORDER_CONSTANT)
    peak = filtered.max(axis=2)
    size = 2 * reach + 1
    highest = cv2.dilate(peak, numpy.ones((size, size)))
    gate = numpy.clip((highest - THRESHOLD) / (0.5 * THRESHOLD), 0, 1)
    mean = cv2.GaussianBlur(peak, (0, 0), texel)
    return filtered * (gate * gate * (3 - 2 * gate) / (1 + mean / BRIGHTEST))[:, :, None]


def glare_kernel(rows, columns, height):
    """Light that a pixel of 1 adds around it; the middle of the picture is its place."""
    y, x = numpy.mgrid[0:rows, 0:columns].astype(numpy.float64)
    y, x = y - rows // 2, x - columns // 2
    weights = 0.65 ** numpy.arange(6)
    kernel = numpy.zeros((rows, columns))
    for weight, octave in zip(weights / weights.sum(), range(6)):
        sigma = 0.006 * 2**octave * height
        kernel += BLOOM_STRENGTH * weight / (2 * numpy.pi * sigma**2) * numpy.exp(-(x**2 + y**2) / (2 * sigma**2))
    fade, sigma = -numpy.log(ATTENUATION) * 480 / height, 0.003 * height
    for arm in range(DIRECTIONS):
        angle = numpy.radians(ROTATION_DEG) + 2 * numpy.pi * arm / DIRECTIONS
        along, across = x * numpy.cos(angle) + y * numpy.sin(angle), y * numpy.cos(angle) - x * numpy.sin(angle)
        # exp(-fade u) for u > 0, blurred by the Gaussian: summed over finely spaced places along the arm.
        places = numpy.arange(0.125, 12 / fade, 0.25)
        profile_at = numpy.arange(-6 * sigma, 12 / fade, 0.25)
        profile = numpy.array([(fade * numpy.exp(-fade * places) * numpy.exp(-((u - places) ** 2) / (2 * sigma**2))).sum() * 0.25 for u in profile_at])
        profile /= numpy.sqrt(2 * numpy.pi) * sigma
        cross = numpy.exp(-(across**2) / (2 * sigma**2)) / (numpy.sqrt(2 * numpy.pi) * sigma)
        kernel += STREAK_STRENGTH / DIRECTIONS * numpy.interp(along, profile_at, profile, left=0, right=0) * cross
    return kernel


def glare_of(light):
    height, width, _ = light.shape
    rows, columns = 3 * height, 3 * width
    spectrum = numpy.fft.rfft2(numpy.fft.ifftshift(glare_kernel(rows, columns, height)))
    padded = numpy.zeros((rows, columns, 3))
    padded[:height, :width] = excess_of(light)
    return numpy.stack([numpy.fft.irfft2(numpy.fft.rfft2(padded[:, :, c]) * spectrum, (rows, columns)) for c in range(3)], axis=2)[:height, :width]


def main():
    radiance, recording = sys.argv[1:3]
    random = numpy.random.default_rng(1)
    for frame in range(FRAMES):
        light = EXPOSURE * read_rgb(os.path.join(radiance, "plate", f"{frame:04d}.exr"))
        noisy = light + random.normal(size=light.shape) * numpy.sqrt(NOISE * numpy.maximum(light, 0))
        write_rgb(os.path.join(radiance, "png", f"{frame:04d}.png"), codes(noisy))
        if frame % 16 == 0:
            coverage = cv2.imread(os.path.join(radiance, "mask", f"{frame:04d}.png"), cv2.IMREAD_UNCHANGED)[:, :, 3]
            truth = EXPOSURE * read_rgb(os.path.join(radiance, "truth", f"{frame:04d}.exr"))
            truth += glare_of(truth * (coverage / 255.0)[:, :, None])
            write_rgb(os.path.join(recording, "truth", f"{frame:04d}.png"), codes(truth))
            write_rgb(os.path.join(recording, "plate_clean", f"{frame:04d}.png"), codes(light))
            os.makedirs(os.path.join(recording, "mask"), exist_ok=True)
            cv2.imwrite(os.path.join(recording, "mask", f"{frame:04d}.png"), coverage)
    probe = probe_of(read_rgb(os.path.join(radiance, "panorama.exr"))).astype(numpy.float32)
    cv2.imwrite(os.path.join(recording, "probe.exr"), probe[:, :, ::-1], [cv2.IMWRITE_EXR_TYPE, cv2.IMWRITE_EXR_TYPE_HALF])
    height, width, _ = light.shape
    with open(os.path.join(recording, "camera.yaml"), "w") as file:
        file.write(camera_yaml(width, height))


main()
