#include "app/settings/parameters.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/math/sh.hpp"
#include "render/render_scene.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::app {
namespace {

using Scene = SceneSettings;

std::vector<std::string> same_or_family() {
  std::vector<std::string> choices = tracking::tag_families();
  choices.insert(choices.begin(), "same");
  return choices;
}

std::vector<Parameter> make_table() {
  return {
      {"look", "",
       "\"camera\": as the footage's camera would show it; \"classic\": exposure, bloom and star of the first real-time HDR "
       "pictures, which sets `exposure` and `glare` where they are left out.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.look; }, {"camera", "classic"}}},

      {"tag.family", "", "Family of the printed tag.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.tag.family; }, tracking::tag_families()}},
      {"tag.id", "", "Number of the tag within its family.",
       IntegerKind{[](Scene& s) -> int& { return s.tag.id; }, 0, 1'000'000}},
      {"tag.size_m", "m", "Side of the square whose corners detectors return: the outer edge of the black border for tag36h11.",
       RealKind{[](Scene& s) -> double& { return s.tag.size_m; }, 0.001, 100}},
      {"tag.white_albedo", "", "Reflectance of the print's white: the reference for matching the exposure.",
       RealKind{[](Scene& s) -> double& { return s.tag.white_albedo; }, 0.01, 1}},
      {"tag.black_albedo", "", "Reflectance of the print's black.",
       RealKind{[](Scene& s) -> double& { return s.tag.black_albedo; }, 0, 1}},

      {"tag.refinement", "",
       "What follows detection, from exact to cheap: the whole pattern (pose, blur and light at once), the four edges, nothing.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.tag.refinement; }, {"direct", "corners", "none"}}},
      {"tag.bundle.family", "", "Family of a further tag of a board.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.tag.bundle.back().family; }, same_or_family()}},
      {"tag.bundle.id", "", "Its number.", IntegerKind{[](Scene& s) -> int& { return s.tag.bundle.back().id; }, 0, 1'000'000}},
      {"tag.bundle.size_m", "m", "Its size; 0: the same as the first tag's.",
       RealKind{[](Scene& s) -> double& { return s.tag.bundle.back().size_m; }, 0, 100}},
      {"tag.bundle.tag_from_this.translation_m", "m", "Where its centre is in the first tag's frame.",
       VectorKind{[](Scene& s) -> glm::dvec3& { return s.tag.bundle.back().translation_m; }, -1000, 1000}},
      {"tag.bundle.tag_from_this.rotation_deg", "deg", "How it is turned there: about x first, then y, then z.",
       VectorKind{[](Scene& s) -> glm::dvec3& { return s.tag.bundle.back().rotation_deg; }, -360, 360}},

      {"object.mesh", "", "glTF 2.0 (`.glb`, `.gltf`), OBJ or PLY file, in metres.",
       PathKind{[](Scene& s) -> std::string& { return s.objects.back().mesh; }}},
      {"object.tag_from_object.translation_m", "m", "Where the object's origin is in the tag frame.",
       VectorKind{[](Scene& s) -> glm::dvec3& { return s.objects.back().translation_m; }, -1000, 1000}},
      {"object.tag_from_object.rotation_deg", "deg",
       "Turns about the tag's x axis first, then y, then z. `[90, 0, 0]` stands glTF's +y up on the tag.",
       VectorKind{[](Scene& s) -> glm::dvec3& { return s.objects.back().rotation_deg; }, -360, 360}},
      {"object.tag_from_object.scale", "", "Size of the object relative to its file.",
       RealKind{[](Scene& s) -> double& { return s.objects.back().scale; }, 1e-6, 1e6}},
      {"object.shading", "", "Lighting model: precomputed radiance transfer with mirror reflections.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.objects.back().shading; }, {"prt"}}},

      {"receiver.plane", "", "The real surface that catches the shadow: the tag's plane, or none.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.receiver.plane; }, {"tag", "none"}}},
      {"receiver.albedo", "", "Reflectance (linear RGB) of that surface, where no probe fixed to the tag shows it.",
       VectorKind{[](Scene& s) -> glm::dvec3& { return s.receiver.albedo; }, 0, 1}},

      {"probe.image", "", "Light probe: OpenEXR or Radiance HDR, scene-linear Rec. 709.",
       PathKind{[](Scene& s) -> std::string& { return s.probe.image; }}},
      {"probe.layout", "", "How directions lie in the image; \"auto\": as the file says, else by its shape.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.probe.layout; },
                  {"auto", "latlong", "angular", "mirror-ball", "cube-cross", "cube"}}},
      {"probe.up", "", "The tag axis that points up in the world: \"z\" for a tag on a table, \"y\" for one on a wall.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.probe.up; }, {"z", "y"}}},
      {"probe.yaw_deg", "deg", "Turns the probe about up, counter-clockwise seen from above.",
       RealKind{[](Scene& s) -> double& { return s.probe.yaw_deg; }, -360, 360}},
      {"probe.fixed_to", "",
       "What the light stands still with: \"tag\" (moving camera) or \"camera\" (still camera, tag in the hand).",
       ChoiceKind{[](Scene& s) -> std::string& { return s.probe.fixed_to; }, {"tag", "camera"}}},
      {"probe.ev", "EV", "Brightens the probe.", RealKind{[](Scene& s) -> double& { return s.probe.ev; }, -30, 30}},

      {"exposure.mode", "",
       "\"match\" follows the footage by the tag's own white and black; \"fixed\" takes radiance as exposed; \"auto\" matches, "
       "then exposes the whole picture anew as an adapting eye does.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.exposure.mode; }, {"match", "fixed", "auto"}}},
      {"exposure.ev", "EV", "Brightens the virtual layer on top of that.",
       RealKind{[](Scene& s) -> double& { return s.exposure.ev; }, -30, 30}},
      {"exposure.key", "", "Of \"auto\": the exposed value that the picture's log-average becomes.",
       RealKind{[](Scene& s) -> double& { return s.exposure.key; }, 0.01, 2}},
      {"exposure.adapt_bright_s", "s", "Of \"auto\": time constant of adapting to bright light; 0: with the next frame.",
       RealKind{[](Scene& s) -> double& { return s.exposure.adapt_bright_s; }, 0, 600}},
      {"exposure.adapt_dark_s", "s", "Of \"auto\": time constant of adapting to the dark.",
       RealKind{[](Scene& s) -> double& { return s.exposure.adapt_dark_s; }, 0, 600}},
      {"exposure.response", "",
       "The camera's response, where the stream does not say it: a formula, or a curve from OpenCV (`.yaml`, `.xml`), `.csv` or "
       "`.cube` "
       "(docs/exposure.md).",
       PathKind{[](Scene& s) -> std::string& { return s.exposure.response; }, {"footage", "srgb", "linear", "gamma:2.4"}}},

      {"glare.enabled", "", "Whether what exceeds the sensor's white spills as bloom and streaks.",
       FlagKind{[](Scene& s) -> bool& { return s.glare.enabled; }}},
      {"glare.threshold", "",
       "Exposed linear value above which the lens spills, 1 is the sensor's white; from half as much again all of a highlight.",
       RealKind{[](Scene& s) -> double& { return s.glare.threshold; }, 0, 1000}},
      {"glare.brightest", "", "Exposed linear value that a highlight's glare tends to, however bright it is.",
       RealKind{[](Scene& s) -> double& { return s.glare.brightest; }, 1, 1e6}},
      {"glare.bloom_strength", "", "Share of the excess that becomes bloom.",
       RealKind{[](Scene& s) -> double& { return s.glare.bloom_strength; }, 0, 10}},
      {"glare.streak_strength", "", "Share of the excess that becomes streaks.",
       RealKind{[](Scene& s) -> double& { return s.glare.streak_strength; }, 0, 10}},
      {"glare.streak_directions", "", "Number of arms of a star.",
       IntegerKind{[](Scene& s) -> int& { return s.glare.streak_directions; }, 1, 16}},
      {"glare.streak_attenuation", "", "What is left of a streak a pixel further on, at a frame height of 480 px.",
       RealKind{[](Scene& s) -> double& { return s.glare.streak_attenuation; }, 0, 0.999}},
      {"glare.streak_dispersion", "",
       "Colours of the streaks: 0 none, 1 as long as each colour's wavelength makes them, more exaggerates.",
       RealKind{[](Scene& s) -> double& { return s.glare.streak_dispersion; }, 0, 5}},
      {"glare.streak_rotation_deg", "deg", "Direction of the first arm.",
       RealKind{[](Scene& s) -> double& { return s.glare.streak_rotation_deg; }, -360, 360}},
      {"glare.streak_width", "",
       "Width of a streak across, its standard deviation in shares of the frame's height; below 0.006 drawn at twice the "
       "resolution.",
       RealKind{[](Scene& s) -> double& { return s.glare.streak_width; }, 0.002, 0.1}},
      {"glare.emitter_strength", "", "Glare of what the object's own materials emit, as a factor on that of its reflections.",
       RealKind{[](Scene& s) -> double& { return s.glare.emitter_strength; }, 0, 100}},
      {"glare.emitter_directions", "", "Number of arms of what the object's own materials emit; 0: as its reflections.",
       IntegerKind{[](Scene& s) -> int& { return s.glare.emitter_directions; }, 0, 16}},
      {"glare.streak_passes", "",
       "Passes of four samples that a streak is drawn in, which reach 4 to that power texels; 0: as many as can be seen.",
       IntegerKind{[](Scene& s) -> int& { return s.glare.streak_passes; }, 0, 6}},
      {"glare.grid_rows", "",
       "Resolution that glare is computed at, in rows of the whole frame; its texels are never below a pixel.",
       IntegerKind{[](Scene& s) -> int& { return s.glare.grid_rows; }, 60, 2160}},

      {"glare.method", "",
       "\"fast\": bloom and streaks. \"fft\": by FFT at full resolution, what glare.aperture diffracts; seconds a frame.",
       ChoiceKind{[](Scene& s) -> std::string& { return s.glare.method; }, {"fast", "fft"}}},
      {"glare.aperture", "",
       "With \"fft\": what stands in the light's way, drawn, or a square picture, white where light passes; \"none\": the bloom "
       "and "
       "streaks of \"fast\", convolved.",
       PathKind{[](Scene& s) -> std::string& { return s.glare.aperture; }, {"none", "blades:6", "eyelashes", "dust", "circle"}}},
      {"glare.aperture_mm", "mm", "Width of that picture: half of it makes the glare twice as wide.",
       RealKind{[](Scene& s) -> double& { return s.glare.aperture_mm; }, 0.05, 100}},
      {"glare.aperture_strength", "",
       "Share of what the aperture diffracts that is added, instead of bloom_strength and streak_strength; 1: all.",
       RealKind{[](Scene& s) -> double& { return s.glare.aperture_strength; }, 0, 1000}},

      {"lens.noise", "",
       "Gives the virtual layer the footage's grain, as measured on the tag; \"auto\": where it is more than rounding's own.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.noise; }}},
      {"lens.motion_blur", "",
       "Blurs the virtual layer along the tag's motion; \"auto\": where the tag's own edges are blurred along it.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.motion_blur; }}},
      {"lens.defocus", "", "Blurs the virtual layer as the tag's edges are blurred, apart from motion; \"auto\": where they are.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.defocus; }}},
      {"lens.distortion", "", "Bends the virtual layer as the camera file says; \"auto\" is on.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.distortion; }}},

      {"lens.shutter", "", "Share of the frame's interval that the shutter is open, for motion blur; 0: measured on the tag.",
       RealKind{[](Scene& s) -> double& { return s.lens.shutter; }, 0, 1}},
      {"lens.vignetting", "",
       "Darkens the virtual layer towards the corners as the camera file's `vignetting` says; \"auto\" is on.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.vignetting; }}},
      {"lens.chroma_subsampling", "",
       "Gives the virtual layer the footage's own resolution of colour; false: all that the output can hold.",
       SwitchKind{[](Scene& s) -> Switch& { return s.lens.chroma_subsampling; }}},

      {"quality.tolerance", "",
       "The visible error allowed, as a share of white; `quality.rays` is chosen from it where left out.",
       RealKind{[](Scene& s) -> double& { return s.quality.tolerance; }, 0.0001, 0.5}},
      {"quality.bands", "", "Bands of spherical harmonics that carry the diffuse light.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.bands; }, 1, render::kMaxShBands}},
      {"quality.rays", "", "Rays per vertex in the transfer bake.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.rays; }, 16, 65536}},
      {"quality.bounces", "",
       "Most interreflections within the object, and between it and the receiver; they end where they stop mattering.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.bounces; }, 0, 16}},
      {"quality.light_samples", "",
       "Most shadow maps for the lights that are split off the probe, a sample of a light each; 0: none is split off.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.light_samples; }, 0, render::kMaxLightSamples}},
      {"quality.samples", "", "Samples per pixel on the object's edges.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.samples; }, 1, 16}},
      {"quality.reflection_rays", "",
       "Rays over what a rough surface mirrors, which find the object itself and the receiver in its true place; 0: everything "
       "mirrored "
       "is as far away as the probe.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.reflection_rays; }, 0, 256}},
      {"quality.receiver_points", "", "Points along each side of the grid that holds the shadow.",
       IntegerKind{[](Scene& s) -> int& { return s.quality.receiver_points; }, 2, 1024}},
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
