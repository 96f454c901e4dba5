// What every row of the parameter table is for: there is a scene in which turning it changes the picture.
#include "app/settings/parameters.hpp"
#include "render/probe/probe_layouts.hpp"
#include "tests/app/window/driven_window.hpp"

#include <gmock/gmock.h>

#include <map>

namespace catchlight::app::testing {
namespace {

/// `set` lines that make a picture, and the value that makes another of it.
struct Effect {
  std::string value, under;
};

const std::string kGetsDarker = "set exposure.mode auto\nset exposure.ev 2\n";
const std::string kGetsBrighter = "set exposure.mode auto\nset exposure.ev 5\nset object.tag_from_object.scale 4\n";
const std::string kAperture = "set glare.method fft\nset glare.aperture blades:6\nset glare.aperture_strength 1\n";
const std::string kFurtherTagThere = "set tag.id 7\nset tag.bundle.tag_from_this.translation_m 0,0,0\n";
const std::string kFurtherTagSeen = "set tag.bundle.id 42\n" + kFurtherTagThere;

std::map<std::string, Effect> effects(const std::string& folder) {
  return {
      {"look", {"classic", ""}},
      {"tag.id", {"7", ""}},
      {"tag.size_m", {"0.1", ""}},
      {"tag.white_albedo", {"0.4", ""}},
      {"tag.black_albedo", {"0.2", ""}},
      {"tag.refinement", {"none", ""}},
      {"tag.bundle.family", {"tag36h11", "set tag.family tag25h9\n" + kFurtherTagSeen}},
      {"tag.bundle.id", {"42", kFurtherTagThere}},
      {"tag.bundle.size_m", {"0.1", kFurtherTagSeen}},
      {"tag.bundle.tag_from_this.translation_m", {"0.03,0,0", kFurtherTagSeen}},
      {"tag.bundle.tag_from_this.rotation_deg", {"0,0,40", kFurtherTagSeen}},
      {"object.mesh", {"sphere", ""}},
      {"object.tag_from_object.translation_m", {"0.01,0,0", ""}},
      {"object.tag_from_object.rotation_deg", {"0,0,40", ""}},
      {"object.tag_from_object.scale", {"1.5", ""}},
      {"receiver.plane", {"none", ""}},
      {"receiver.albedo", {"0.9,0.1,0.1", "set probe.fixed_to camera\n"}},
      {"probe.image", {folder + "other.exr", ""}},
      {"probe.layout", {"angular", "set probe.image " + folder + "ball.exr\n"}},
      {"probe.up", {"y", ""}},
      {"probe.yaw_deg", {"90", ""}},
      {"probe.fixed_to", {"camera", ""}},
      {"probe.ev", {"1", "set exposure.mode fixed\n"}},
      {"exposure.mode", {"fixed", ""}},
      {"exposure.ev", {"1", ""}},
      {"exposure.white_balance", {"1.2,1,0.9", ""}},
      {"exposure.key", {"0.5", "set exposure.mode auto\n"}},
      {"exposure.adapt_bright_s", {"40", kGetsDarker}},
      {"exposure.adapt_dark_s", {"0", kGetsBrighter}},
      {"exposure.response", {"linear", ""}},
      {"glare.enabled", {"false", ""}},
      {"glare.threshold", {"100", ""}},
      {"glare.brightest", {"2", ""}},
      {"glare.bloom_strength", {"1", ""}},
      {"glare.streak_strength", {"1", ""}},
      {"glare.streak_directions", {"3", ""}},
      {"glare.streak_attenuation", {"0.8", ""}},
      {"glare.streak_dispersion", {"3", ""}},
      {"glare.streak_rotation_deg", {"20", ""}},
      {"glare.streak_width", {"0.05", ""}},
      {"glare.emitter_strength", {"8", ""}},
      {"glare.emitter_directions", {"3", ""}},
      {"glare.streak_passes", {"1", ""}},
      {"glare.grid_rows", {"60", ""}},
      {"glare.method", {"fft", ""}},
      {"glare.aperture", {"none", kAperture}},
      {"glare.aperture_mm", {"1", kAperture}},
      {"glare.aperture_strength", {"9", kAperture}},
      {"lens.noise", {"false", ""}},
      {"lens.motion_blur", {"true", "set lens.motion_blur false\nset lens.shutter 1\n"}},
      {"lens.defocus", {"true", "set lens.defocus false\n"}},
      {"lens.distortion", {"false", ""}},
      {"lens.shutter", {"1", "set lens.motion_blur true\nset lens.shutter 0.1\n"}},
      {"lens.vignetting", {"false", ""}},
      {"lens.chroma_subsampling", {"false", ""}},
      {"quality.tolerance", {"0.3", ""}},
      {"quality.bands", {"2", ""}},
      {"quality.rays", {"64", ""}},
      {"quality.bounces", {"0", ""}},
      {"quality.light_samples", {"0", ""}},
      {"quality.samples", {"1", ""}},
      {"quality.reflection_rays", {"0", ""}},
      {"quality.receiver_points", {"24", ""}},
  };
}

using WindowEffects = WindowTest;

TEST_F(WindowEffects, EveryParameterChangesThePictureOfSomeScene) {
  const render::Probe probe = render::load_probe(path("probe.exr"), {}, {});
  render::save_probe(path("ball.exr"), render::convert(probe, render::ProbeLayout::mirror_ball, 64));
  render::save_probe(path("other.exr"),
                     render::convert(render::load_probe(CATCHLIGHT_SOURCE_DIR "/recordings/gloss/probe.exr", {}, {}),
                                     render::ProbeLayout::latlong, 64));
  const std::map<std::string, Effect> known = effects(path(""));
  DrivenWindow driven(path(""));
  driven.run("wait\nseek 3\nwait\n");
  for (const Parameter& parameter : parameters()) {
    if (parameter.key == "object.shading" || parameter.key == "tag.family") continue;  // has one value; below
    ASSERT_TRUE(known.contains(parameter.key)) << parameter.key << ": say here what it changes in the picture";
    const auto& [value, under] = known.at(parameter.key);
    driven.run("click keep A\n" + under);
    const std::vector<unsigned char> before = driven.picture();
    driven.run("set " + parameter.key + ' ' + value + '\n');
    EXPECT_TRUE(driven.picture() != before) << parameter.key << " = " << value;
    driven.run("click A\n");
  }
}

/// Under a family that is not in the footage there is nothing to draw.
TEST_F(WindowEffects, TheTagsFamilyLetsItBeFound) {
  RecordingOverrides of_another_family;
  of_another_family.parameters = {{"tag.family", "tag25h9"}};
  DrivenWindow driven(path(""), of_another_family);
  const std::vector<unsigned char> unknown = driven.picture();
  EXPECT_TRUE(unknown == driven.window().shown()->plate.rgb);
  driven.run("set tag.family tag36h11\nwait\n");
  EXPECT_TRUE(driven.picture() != driven.window().shown()->plate.rgb);
}

}  // namespace
}  // namespace catchlight::app::testing
