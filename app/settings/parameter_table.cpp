#include "app/settings/parameters.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/test_objects.hpp"
#include "render/render_scene.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::app {
namespace {

std::vector<std::string> same_or_family() {
  std::vector<std::string> choices = tracking::tag_families();
  choices.insert(choices.begin(), "same");
  return choices;
}

std::vector<Parameter> tag_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"look", "", passes,
       "\"camera\" shows the picture as the footage's camera would. \"classic\" has the exposure, bloom and star of the first "
       "real-time HDR pictures: it sets those keys of `exposure` and `glare` that are left out.",
       ChoiceKind{[](auto& s) { return &s.look; }}},
      {"tag.family", "", track, "The printed tag belongs to this family.",
       WordKind{[](auto& s) { return &s.tag.family; }, tracking::tag_families()}},
      {"tag.id", "", track, "The tag has this number within its family.",
       IntegerKind{[](auto& s) { return &s.tag.id; }, 0, 1'000'000}},
      {"tag.size_m", "m", track,
       "The square whose corners detectors return has sides of this length; for tag36h11 it is the outer edge of the black "
       "border.",
       RealKind{[](auto& s) { return &s.tag.size_m; }, 0.001, 100, logarithmic}},
      {"tag.white_albedo", "", track, "The print's white reflects this share of the light; the exposure is matched by it.",
       RealKind{[](auto& s) { return &s.tag.white_albedo; }, 0.01, 1}},
      {"tag.black_albedo", "", track, "The print's black reflects this share of the light.",
       RealKind{[](auto& s) { return &s.tag.black_albedo; }, 0, 1}},
      {"tag.refinement", "", track,
       "After detection, \"direct\" fits the whole pattern (pose, blur and light at once), \"corners\" the four edges, \"none\" "
       "nothing. Each is cheaper and less exact than the one before.",
       ChoiceKind{[](auto& s) { return &s.tag.refinement; }}},
      {"tag.bundle.family", "", track, "A further tag of a board belongs to this family; \"same\" is the first tag's.",
       WordKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].family; }, same_or_family()}},
      {"tag.bundle.id", "", track, "The further tag has this number within its family.",
       IntegerKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].id; }, 0, 1'000'000}},
      {"tag.bundle.size_m", "m", track, "The further tag's square has sides of this length; 0 takes the first tag's.",
       RealKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].size_m; }, 0, 100, logarithmic, 0.001}},
      {"tag.bundle.tag_from_this.translation_m", "m", track,
       "The further tag's centre is at this place in the first tag's frame.",
       VectorKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].translation_m; }, -1000, 1000}},
      {"tag.bundle.tag_from_this.rotation_deg", "deg", track,
       "The further tag is turned by these angles in the first tag's frame: about x first, then y, then z.",
       VectorKind{[](auto& s, std::size_t i) { return &s.tag.bundle[i].rotation_deg; }, -360, 360, angle}},
  };
}

std::vector<Parameter> object_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"object.mesh", "", mesh,
       "The object is read from this file, in metres: glTF 2.0 (`.glb`, `.gltf`), OBJ or PLY; or it is a white shape that stands "
       "on the tag, such as `sphere` or `torus`, or `chrome-and-grey`, a mirror ball beside one of 18 % grey.",
       PathKind{[](auto& s, std::size_t i) { return &s.objects[i].mesh; },
                {render::kTestObjects.begin(), render::kTestObjects.end()}}},
      {"object.tag_from_object.translation_m", "m", mesh, "The object's origin is at this place in the tag's frame.",
       VectorKind{[](auto& s, std::size_t i) { return &s.objects[i].translation_m; }, -1000, 1000}},
      {"object.tag_from_object.rotation_deg", "deg", mesh,
       "The object is turned by these angles about the tag's axes: x first, then y, then z. `[90, 0, 0]` stands glTF's +y up on "
       "the tag.",
       VectorKind{[](auto& s, std::size_t i) { return &s.objects[i].rotation_deg; }, -360, 360, angle}},
      {"object.tag_from_object.scale", "", mesh, "The object is this many times as large as its file says.",
       RealKind{[](auto& s, std::size_t i) { return &s.objects[i].scale; }, 1e-6, 1e6, logarithmic}},
      {"object.shading", "", mesh,
       "The object is lit in this way: \"prt\" is precomputed radiance transfer, with mirror reflections.",
       ChoiceKind{[](auto& s, std::size_t i) { return &s.objects[i].shading; }}},
      {"receiver.plane", "", mesh,
       "The object's shadow falls on this real surface, which hides what lies below it: the tag's plane, or none.",
       ChoiceKind{[](auto& s) { return &s.receiver.plane; }}},
      {"receiver.albedo", "", bake,
       "The surface reflects this share of red, green and blue light (linear). It counts where the footage is clipped, and where "
       "no probe fixed to the tag shows the surface.",
       VectorKind{[](auto& s) { return &s.receiver.albedo; }, 0, 1, color}},
  };
}

std::vector<Parameter> probe_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"probe.image", "", light,
       "The light probe is read from this file: OpenEXR or Radiance HDR, scene-linear, Rec. 709; or it is made: `overcast`, "
       "`studio` (three softboxes) or `sky` (a clear one with its sun, by values after a colon; docs/probes.md).",
       PathKind{[](auto& s) { return &s.probe.image; }, {"overcast", "studio", "sky", "sky:sun_elevation_deg=35,turbidity=3"}}},
      {"probe.layout", "", light,
       "Directions lie in the probe's image in this way; \"auto\" goes by what the file says, else by the image's shape.",
       ChoiceKind{[](auto& s) { return &s.probe.layout; }}},
      {"probe.up", "", light, "This axis of the tag points up in the world: \"z\" for a tag on a table, \"y\" for one on a wall.",
       ChoiceKind{[](auto& s) { return &s.probe.up; }}},
      {"probe.yaw_deg", "deg", light, "The probe is turned by this angle about up, counter-clockwise as seen from above.",
       RealKind{[](auto& s) { return &s.probe.yaw_deg; }, -360, 360, angle}},
      {"probe.fixed_to", "", light,
       "The light stands still with the \"tag\" (the camera moves) or with the \"camera\" (which stands still, with the tag in "
       "the hand).",
       ChoiceKind{[](auto& s) { return &s.probe.fixed_to; }}},
      {"probe.ev", "EV", light,
       "The probe is brightened by this many stops. That shows where `exposure.mode` is \"fixed\": else the exposure is matched "
       "to "
       "the probe's light.",
       RealKind{[](auto& s) { return &s.probe.ev; }, -30, 30}},
  };
}

std::vector<Parameter> exposure_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"exposure.mode", "", passes,
       "\"match\" exposes the virtual layer as the footage was, by the tag's own white and black. \"fixed\" takes radiance as "
       "exposed. \"auto\" matches, then exposes the whole picture anew as an adapting eye does.",
       ChoiceKind{[](auto& s) { return &s.exposure.mode; }}},
      {"exposure.ev", "EV", view, "The virtual layer is brightened by this many stops on top of that.",
       RealKind{[](auto& s) { return &s.exposure.ev; }, -30, 30}},
      {"exposure.white_balance", "", view,
       "The virtual layer's red, green and blue light is multiplied by these on top of that: for a tag that is not white, or a "
       "probe in other light than the footage. `catchlight tune` sets them by a click on something white or grey.",
       VectorKind{[](auto& s) { return &s.exposure.white_balance; }, 0.05, 20}},
      {"exposure.key", "", passes, "With \"auto\", the log-average of the picture becomes this exposed value.",
       RealKind{[](auto& s) { return &s.exposure.key; }, 0.01, 2, logarithmic}},
      {"exposure.adapt_bright_s", "s", view,
       "With \"auto\", this is the time constant of adapting to bright light; 0 adapts with the next frame.",
       RealKind{[](auto& s) { return &s.exposure.adapt_bright_s; }, 0, 600, logarithmic, 0.01}},
      {"exposure.adapt_dark_s", "s", view, "With \"auto\", this is the time constant of adapting to the dark.",
       RealKind{[](auto& s) { return &s.exposure.adapt_dark_s; }, 0, 600, logarithmic, 0.01}},
      {"exposure.response", "", footage,
       "The camera's codes stand for light in this way. \"footage\" is what the stream says; else it is a formula, or a curve "
       "from OpenCV (`.yaml`, `.xml`), `.csv` or `.cube` (docs/exposure.md).",
       PathKind{[](auto& s) { return &s.exposure.response; }, {"footage", "srgb", "linear", "gamma:2.4"}}},
  };
}

std::vector<Parameter> bloom_and_streak_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"glare.enabled", "", passes, "What exceeds the sensor's white spills as bloom and streaks.",
       FlagKind{[](auto& s) { return &s.glare.enabled; }}},
      {"glare.threshold", "", passes,
       "A highlight glares where it is brighter than this exposed linear value (1 is the sensor's white), and with all of its "
       "light where it is brighter than one and a half times the value.",
       RealKind{[](auto& s) { return &s.glare.threshold; }, 0, 1000, logarithmic, 0.01}},
      {"glare.brightest", "", passes,
       "A highlight's glare tends to that of this exposed linear value, however bright the highlight is.",
       RealKind{[](auto& s) { return &s.glare.brightest; }, 1, 1e6, logarithmic}},
      {"glare.bloom_strength", "", passes, "This share of the excess becomes bloom.",
       RealKind{[](auto& s) { return &s.glare.bloom_strength; }, 0, 10, logarithmic, 0.001}},
      {"glare.streak_strength", "", passes, "This share of the excess becomes streaks.",
       RealKind{[](auto& s) { return &s.glare.streak_strength; }, 0, 10, logarithmic, 0.001}},
      {"glare.streak_directions", "", passes, "A star has this many arms.",
       IntegerKind{[](auto& s) { return &s.glare.streak_directions; }, 1, 16}},
      {"glare.streak_attenuation", "", passes, "This share of a streak is left a pixel further on, at a frame height of 480 px.",
       RealKind{[](auto& s) { return &s.glare.streak_attenuation; }, 0, 0.999}},
      {"glare.streak_dispersion", "", passes,
       "At 0 all colours of a streak are equally long, at 1 each is as long as its wavelength makes it, and above 1 the "
       "difference is exaggerated.",
       RealKind{[](auto& s) { return &s.glare.streak_dispersion; }, 0, 5}},
      {"glare.streak_rotation_deg", "deg", passes, "The first arm points in this direction.",
       RealKind{[](auto& s) { return &s.glare.streak_rotation_deg; }, -360, 360, angle}},
      {"glare.streak_width", "", passes,
       "A streak is this wide across: the standard deviation, as a share of the frame's height. Below 0.006 it is drawn at twice "
       "the resolution.",
       RealKind{[](auto& s) { return &s.glare.streak_width; }, 0.002, 0.1, logarithmic}},
  };
}

std::vector<Parameter> emission_and_aperture_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"glare.emitter_strength", "", passes,
       "The glare of what the object's own materials emit is this many times that of reflections as bright.",
       RealKind{[](auto& s) { return &s.glare.emitter_strength; }, 0, 100, logarithmic, 0.01}},
      {"glare.emitter_directions", "", passes,
       "What the object's own materials emit has a star of this many arms; 0 takes that of its reflections.",
       IntegerKind{[](auto& s) { return &s.glare.emitter_directions; }, 0, 16}},
      {"glare.streak_passes", "", passes,
       "Streaks are drawn in this many passes. Each one more lets them reach four times as far; 0 takes as many as can be seen.",
       IntegerKind{[](auto& s) { return &s.glare.streak_passes; }, 0, 6}},
      {"glare.grid_rows", "", passes,
       "Glare is computed on a grid of this many rows over the whole frame; its texels are never smaller than a pixel.",
       IntegerKind{[](auto& s) { return &s.glare.grid_rows; }, 60, 2160}},
      {"glare.method", "", passes,
       "\"fast\" draws bloom and streaks. \"fft\" computes at full resolution what `glare.aperture` diffracts, which takes "
       "seconds a frame.",
       ChoiceKind{[](auto& s) { return &s.glare.method; }}},
      {"glare.aperture", "", passes,
       "With \"fft\", this stands in the light's way: drawn by the program, or a square picture that is white where light "
       "passes. \"none\" convolves the bloom and streaks of \"fast\".",
       PathKind{[](auto& s) { return &s.glare.aperture; }, {"none", "blades:6", "eyelashes", "dust", "circle"}}},
      {"glare.aperture_mm", "mm", passes, "The aperture's picture is this wide; half of it makes the glare twice as wide.",
       RealKind{[](auto& s) { return &s.glare.aperture_mm; }, 0.05, 100, logarithmic}},
      {"glare.aperture_strength", "", passes,
       "This share of what the aperture diffracts is added, instead of `bloom_strength` and `streak_strength`; 1 is all of it.",
       RealKind{[](auto& s) { return &s.glare.aperture_strength; }, 0, 1000, logarithmic, 0.001}},
  };
}

std::vector<Parameter> lens_parameters() {
  using enum ChangeCost;
  return {
      {"lens.noise", "", view,
       "Object and shadow get the footage's grain, as measured on the tag; \"auto\" adds it where it is more than the rounding "
       "of codes makes.",
       SwitchKind{[](auto& s) { return &s.lens.noise; }}},
      {"lens.motion_blur", "", view,
       "Object and shadow are blurred along their motion while the shutter is open; \"auto\" does so where the tag's edges are "
       "softer along its motion than across.",
       SwitchKind{[](auto& s) { return &s.lens.motion_blur; }}},
      {"lens.defocus", "", view,
       "Object and shadow are as much out of focus as the tag; \"auto\" does so where the tag's edges are softer than a pixel "
       "makes them.",
       SwitchKind{[](auto& s) { return &s.lens.defocus; }}},
      {"lens.distortion", "", view, "Object and shadow are bent by the lens as the camera file says; \"auto\" is on.",
       SwitchKind{[](auto& s) { return &s.lens.distortion; }}},
      {"lens.shutter", "", view,
       "The shutter is open for this share of the time from frame to frame, which sets the length of the motion blur (0.5 is 180 "
       "degrees); 0 measures it on the tag.",
       RealKind{[](auto& s) { return &s.lens.shutter; }, 0, 1}},
      {"lens.vignetting", "", view,
       "The object is darker towards the picture's corners, as the camera file's `vignetting` says; \"auto\" is on.",
       SwitchKind{[](auto& s) { return &s.lens.vignetting; }}},
      {"lens.chroma_subsampling", "", view,
       "Object and shadow get the footage's resolution of colour (as in 4:2:0); false gives them all that the output can hold, "
       "and \"auto\" is on.",
       SwitchKind{[](auto& s) { return &s.lens.chroma_subsampling; }}},
  };
}

std::vector<Parameter> quality_parameters() {
  using enum ChangeCost;
  using enum Scale;
  return {
      {"quality.tolerance", "", bake,
       "This visible error is allowed, as a share of white; `quality.rays` is chosen from it where left out.",
       RealKind{[](auto& s) { return &s.quality.tolerance; }, 0.0001, 0.5, logarithmic}},
      {"quality.bands", "", bake, "The diffuse light is carried by this many bands of spherical harmonics.",
       IntegerKind{[](auto& s) { return &s.quality.bands; }, 1, render::kMaxShBands}},
      {"quality.rays", "", bake, "The transfer bake sends this many rays from each vertex.",
       IntegerKind{[](auto& s) { return &s.quality.rays; }, 16, 65536, logarithmic}},
      {"quality.bounces", "", bake,
       "Light is followed over at most this many interreflections within the object, and between it and the receiver; fewer "
       "where more stop mattering.",
       IntegerKind{[](auto& s) { return &s.quality.bounces; }, 0, 16}},
      {"quality.light_samples", "", light,
       "The lights that are split off the probe have at most this many samples, each with its shadow; 0 splits none off.",
       IntegerKind{[](auto& s) { return &s.quality.light_samples; }, 0, render::kMaxLightSamples}},
      {"quality.samples", "", passes, "The object's edges are drawn with this many samples a pixel.",
       IntegerKind{[](auto& s) { return &s.quality.samples; }, 1, 16}},
      {"quality.reflection_rays", "", passes,
       "What a rough surface mirrors is found by this many rays, which meet the object itself and the receiver in its true "
       "place; at 0 everything mirrored is as far away as the probe.",
       IntegerKind{[](auto& s) { return &s.quality.reflection_rays; }, 0, 256}},
      {"quality.receiver_points", "", bake, "The grid that holds the shadow has this many points along each side.",
       IntegerKind{[](auto& s) { return &s.quality.receiver_points; }, 2, 1024, logarithmic}},
  };
}

/// The parts in the order of the documentation.
std::vector<Parameter> make_table() {
  std::vector<Parameter> table;
  for (const auto part : {tag_parameters, object_parameters, probe_parameters, exposure_parameters, bloom_and_streak_parameters,
                          emission_and_aperture_parameters, lens_parameters, quality_parameters})
    for (Parameter& parameter : part()) table.push_back(std::move(parameter));
  return table;
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
