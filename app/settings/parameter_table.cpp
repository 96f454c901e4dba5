#include "app/settings/parameters.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/math/sh.hpp"
#include "render/render_scene.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::app {
namespace {

std::vector<std::string> same_or_family() {
  std::vector<std::string> choices = tracking::tag_families();
  choices.insert(choices.begin(), "same");
  return choices;
}

std::vector<Parameter> make_table() {
  using enum ChangeCost;
  return {
      {"look", "", passes,
       "\"camera\": as the footage's camera would show it; \"classic\": exposure, bloom and star of the first real-time HDR "
       "pictures, which sets `exposure` and `glare` where they are left out.",
       ChoiceKind{[](auto& s) { return &s.look; }}},

      {"tag.family", "", track, "Family of the printed tag.",
       WordKind{[](auto& s) { return &s.tag.family; }, tracking::tag_families()}},
      {"tag.id", "", track, "Number of the tag within its family.", IntegerKind{[](auto& s) { return &s.tag.id; }, 0, 1'000'000}},
      {"tag.size_m", "m", track,
       "Side of the square whose corners detectors return: the outer edge of the black border for tag36h11.",
       RealKind{[](auto& s) { return &s.tag.size_m; }, 0.001, 100}},
      {"tag.white_albedo", "", track, "Reflectance of the print's white: the reference for matching the exposure.",
       RealKind{[](auto& s) { return &s.tag.white_albedo; }, 0.01, 1}},
      {"tag.black_albedo", "", track, "Reflectance of the print's black.",
       RealKind{[](auto& s) { return &s.tag.black_albedo; }, 0, 1}},

      {"tag.refinement", "", track,
       "What follows detection, from exact to cheap: the whole pattern (pose, blur and light at once), the four edges, nothing.",
       ChoiceKind{[](auto& s) { return &s.tag.refinement; }}},
      {"tag.bundle.family", "", track, "Family of a further tag of a board.",
       WordKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].family; }, same_or_family()}},
      {"tag.bundle.id", "", track, "Its number.",
       IntegerKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].id; }, 0, 1'000'000}},
      {"tag.bundle.size_m", "m", track, "Its size; 0: the same as the first tag's.",
       RealKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].size_m; }, 0, 100}},
      {"tag.bundle.tag_from_this.translation_m", "m", track, "Where its centre is in the first tag's frame.",
       VectorKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].translation_m; }, -1000, 1000}},
      {"tag.bundle.tag_from_this.rotation_deg", "deg", track, "How it is turned there: about x first, then y, then z.",
       VectorKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].rotation_deg; }, -360, 360}},

      {"object.mesh", "", mesh, "glTF 2.0 (`.glb`, `.gltf`), OBJ or PLY file, in metres.",
       PathKind{[](auto& s, std::size_t i) { return &s.objects[i].mesh; }}},
      {"object.tag_from_object.translation_m", "m", mesh, "Where the object's origin is in the tag frame.",
       VectorKind{[](auto& s, std::size_t i) { return &s.objects[i].translation_m; }, -1000, 1000}},
      {"object.tag_from_object.rotation_deg", "deg", mesh,
       "Turns about the tag's x axis first, then y, then z. `[90, 0, 0]` stands glTF's +y up on the tag.",
       VectorKind{[](auto& s, std::size_t i) { return &s.objects[i].rotation_deg; }, -360, 360}},
      {"object.tag_from_object.scale", "", mesh, "Size of the object relative to its file.",
       RealKind{[](auto& s, std::size_t i) { return &s.objects[i].scale; }, 1e-6, 1e6}},
      {"object.shading", "", mesh, "Lighting model: precomputed radiance transfer with mirror reflections.",
       ChoiceKind{[](auto& s, std::size_t i) { return &s.objects[i].shading; }}},

      {"receiver.plane", "", bake, "The real surface that catches the shadow: the tag's plane, or none.",
       ChoiceKind{[](auto& s) { return &s.receiver.plane; }}},
      {"receiver.albedo", "", bake, "Reflectance (linear RGB) of that surface, where no probe fixed to the tag shows it.",
       VectorKind{[](auto& s) { return &s.receiver.albedo; }, 0, 1}},

      {"probe.image", "", light, "Light probe: OpenEXR or Radiance HDR, scene-linear Rec. 709.",
       PathKind{[](auto& s) { return &s.probe.image; }}},
      {"probe.layout", "", light, "How directions lie in the image; \"auto\": as the file says, else by its shape.",
       ChoiceKind{[](auto& s) { return &s.probe.layout; }}},
      {"probe.up", "", light, "The tag axis that points up in the world: \"z\" for a tag on a table, \"y\" for one on a wall.",
       ChoiceKind{[](auto& s) { return &s.probe.up; }}},
      {"probe.yaw_deg", "deg", light, "Turns the probe about up, counter-clockwise seen from above.",
       RealKind{[](auto& s) { return &s.probe.yaw_deg; }, -360, 360}},
      {"probe.fixed_to", "", light,
       "What the light stands still with: \"tag\" (moving camera) or \"camera\" (still camera, tag in the hand).",
       ChoiceKind{[](auto& s) { return &s.probe.fixed_to; }}},
      {"probe.ev", "EV", light, "Brightens the probe.", RealKind{[](auto& s) { return &s.probe.ev; }, -30, 30}},

      {"exposure.mode", "", passes,
       "\"match\" follows the footage by the tag's own white and black; \"fixed\" takes radiance as exposed; \"auto\" matches, "
       "then exposes the whole picture anew as an adapting eye does.",
       ChoiceKind{[](auto& s) { return &s.exposure.mode; }}},
      {"exposure.ev", "EV", view, "Brightens the virtual layer on top of that.",
       RealKind{[](auto& s) { return &s.exposure.ev; }, -30, 30}},
      {"exposure.key", "", passes, "Of \"auto\": the exposed value that the picture's log-average becomes.",
       RealKind{[](auto& s) { return &s.exposure.key; }, 0.01, 2}},
      {"exposure.adapt_bright_s", "s", view, "Of \"auto\": time constant of adapting to bright light; 0: with the next frame.",
       RealKind{[](auto& s) { return &s.exposure.adapt_bright_s; }, 0, 600}},
      {"exposure.adapt_dark_s", "s", view, "Of \"auto\": time constant of adapting to the dark.",
       RealKind{[](auto& s) { return &s.exposure.adapt_dark_s; }, 0, 600}},
      {"exposure.response", "", footage,
       "The camera's response, where the stream does not say it: a formula, or a curve from OpenCV (`.yaml`, `.xml`), `.csv` or "
       "`.cube` "
       "(docs/exposure.md).",
       PathKind{[](auto& s) { return &s.exposure.response; }, {"footage", "srgb", "linear", "gamma:2.4"}}},

      {"glare.enabled", "", passes, "Whether what exceeds the sensor's white spills as bloom and streaks.",
       FlagKind{[](auto& s) { return &s.glare.enabled; }}},
      {"glare.threshold", "", passes,
       "Exposed linear value above which the lens spills, 1 is the sensor's white; from half as much again all of a highlight.",
       RealKind{[](auto& s) { return &s.glare.threshold; }, 0, 1000}},
      {"glare.brightest", "", passes, "Exposed linear value that a highlight's glare tends to, however bright it is.",
       RealKind{[](auto& s) { return &s.glare.brightest; }, 1, 1e6}},
      {"glare.bloom_strength", "", passes, "Share of the excess that becomes bloom.",
       RealKind{[](auto& s) { return &s.glare.bloom_strength; }, 0, 10}},
      {"glare.streak_strength", "", passes, "Share of the excess that becomes streaks.",
       RealKind{[](auto& s) { return &s.glare.streak_strength; }, 0, 10}},
      {"glare.streak_directions", "", passes, "Number of arms of a star.",
       IntegerKind{[](auto& s) { return &s.glare.streak_directions; }, 1, 16}},
      {"glare.streak_attenuation", "", passes, "What is left of a streak a pixel further on, at a frame height of 480 px.",
       RealKind{[](auto& s) { return &s.glare.streak_attenuation; }, 0, 0.999}},
      {"glare.streak_dispersion", "", passes,
       "Colours of the streaks: 0 none, 1 as long as each colour's wavelength makes them, more exaggerates.",
       RealKind{[](auto& s) { return &s.glare.streak_dispersion; }, 0, 5}},
      {"glare.streak_rotation_deg", "deg", passes, "Direction of the first arm.",
       RealKind{[](auto& s) { return &s.glare.streak_rotation_deg; }, -360, 360}},
      {"glare.streak_width", "", passes,
       "Width of a streak across, its standard deviation in shares of the frame's height; below 0.006 drawn at twice the "
       "resolution.",
       RealKind{[](auto& s) { return &s.glare.streak_width; }, 0.002, 0.1}},
      {"glare.emitter_strength", "", passes,
       "Glare of what the object's own materials emit, as a factor on that of its reflections.",
       RealKind{[](auto& s) { return &s.glare.emitter_strength; }, 0, 100}},
      {"glare.emitter_directions", "", passes, "Number of arms of what the object's own materials emit; 0: as its reflections.",
       IntegerKind{[](auto& s) { return &s.glare.emitter_directions; }, 0, 16}},
      {"glare.streak_passes", "", passes,
       "Passes of four samples that a streak is drawn in, which reach 4 to that power texels; 0: as many as can be seen.",
       IntegerKind{[](auto& s) { return &s.glare.streak_passes; }, 0, 6}},
      {"glare.grid_rows", "", passes,
       "Resolution that glare is computed at, in rows of the whole frame; its texels are never below a pixel.",
       IntegerKind{[](auto& s) { return &s.glare.grid_rows; }, 60, 2160}},

      {"glare.method", "", passes,
       "\"fast\": bloom and streaks. \"fft\": by FFT at full resolution, what glare.aperture diffracts; seconds a frame.",
       ChoiceKind{[](auto& s) { return &s.glare.method; }}},
      {"glare.aperture", "", passes,
       "With \"fft\": what stands in the light's way, drawn, or a square picture, white where light passes; \"none\": the bloom "
       "and "
       "streaks of \"fast\", convolved.",
       PathKind{[](auto& s) { return &s.glare.aperture; }, {"none", "blades:6", "eyelashes", "dust", "circle"}}},
      {"glare.aperture_mm", "mm", passes, "Width of that picture: half of it makes the glare twice as wide.",
       RealKind{[](auto& s) { return &s.glare.aperture_mm; }, 0.05, 100}},
      {"glare.aperture_strength", "", passes,
       "Share of what the aperture diffracts that is added, instead of bloom_strength and streak_strength; 1: all.",
       RealKind{[](auto& s) { return &s.glare.aperture_strength; }, 0, 1000}},

      {"lens.noise", "", view,
       "Gives the virtual layer the footage's grain, as measured on the tag; \"auto\": where it is more than rounding's own.",
       SwitchKind{[](auto& s) { return &s.lens.noise; }}},
      {"lens.motion_blur", "", view,
       "Blurs the virtual layer along the tag's motion; \"auto\": where the tag's own edges are blurred along it.",
       SwitchKind{[](auto& s) { return &s.lens.motion_blur; }}},
      {"lens.defocus", "", view,
       "Blurs the virtual layer as the tag's edges are blurred, apart from motion; \"auto\": where they are.",
       SwitchKind{[](auto& s) { return &s.lens.defocus; }}},
      {"lens.distortion", "", view, "Bends the virtual layer as the camera file says; \"auto\" is on.",
       SwitchKind{[](auto& s) { return &s.lens.distortion; }}},

      {"lens.shutter", "", view,
       "Share of the frame's interval that the shutter is open, for motion blur; 0: measured on the tag.",
       RealKind{[](auto& s) { return &s.lens.shutter; }, 0, 1}},
      {"lens.vignetting", "", view,
       "Darkens the virtual layer towards the corners as the camera file's `vignetting` says; \"auto\" is on.",
       SwitchKind{[](auto& s) { return &s.lens.vignetting; }}},
      {"lens.chroma_subsampling", "", view,
       "Gives the virtual layer the footage's own resolution of colour; false: all that the output can hold.",
       SwitchKind{[](auto& s) { return &s.lens.chroma_subsampling; }}},

      {"quality.tolerance", "", bake,
       "The visible error allowed, as a share of white; `quality.rays` is chosen from it where left out.",
       RealKind{[](auto& s) { return &s.quality.tolerance; }, 0.0001, 0.5}},
      {"quality.bands", "", bake, "Bands of spherical harmonics that carry the diffuse light.",
       IntegerKind{[](auto& s) { return &s.quality.bands; }, 1, render::kMaxShBands}},
      {"quality.rays", "", bake, "Rays per vertex in the transfer bake.",
       IntegerKind{[](auto& s) { return &s.quality.rays; }, 16, 65536}},
      {"quality.bounces", "", bake,
       "Most interreflections within the object, and between it and the receiver; they end where they stop mattering.",
       IntegerKind{[](auto& s) { return &s.quality.bounces; }, 0, 16}},
      {"quality.light_samples", "", light,
       "Most shadow maps for the lights that are split off the probe, a sample of a light each; 0: none is split off.",
       IntegerKind{[](auto& s) { return &s.quality.light_samples; }, 0, render::kMaxLightSamples}},
      {"quality.samples", "", passes, "Samples per pixel on the object's edges.",
       IntegerKind{[](auto& s) { return &s.quality.samples; }, 1, 16}},
      {"quality.reflection_rays", "", passes,
       "Rays over what a rough surface mirrors, which find the object itself and the receiver in its true place; 0: everything "
       "mirrored "
       "is as far away as the probe.",
       IntegerKind{[](auto& s) { return &s.quality.reflection_rays; }, 0, 256}},
      {"quality.receiver_points", "", bake, "Points along each side of the grid that holds the shadow.",
       IntegerKind{[](auto& s) { return &s.quality.receiver_points; }, 2, 1024}},
  };
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> table = make_table();
  return table;
}

const Parameter* find_parameter(const std::string& key) {
  for (const Parameter& parameter : parameters())
    if (parameter.key == key) return &parameter;
  return nullptr;
}

}  // namespace catchlight::app
