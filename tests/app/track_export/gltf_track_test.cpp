// The animated glTF camera, read by tinygltf.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "catchlight/track.hpp"
#include "render/mesh_file/gltf.hpp"
#include "tests/support/orbit_track.hpp"

namespace catchlight::app {
namespace {

using namespace orbit_test;
using ::testing::ElementsAre;

constexpr double kSingle_rad = 1e-6;  // 4 components of half an ulp, 3e-8 each, twice, and as much again of the translation

struct GltfTrack {
  tinygltf::Model model;
  std::vector<double> times_s;
  std::vector<glm::dvec3> translations_m;
  std::vector<glm::dvec4> rotations_xyzw;
};

std::vector<float> floats_of(const tinygltf::Model& model, int accessor_index) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(accessor_index));
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  std::vector<float> floats(accessor.count * static_cast<std::size_t>(tinygltf::GetNumComponentsInType(accessor.type)));
  EXPECT_EQ(view.byteLength, 4 * floats.size());
  std::memcpy(floats.data(), model.buffers.at(0).data.data() + view.byteOffset + accessor.byteOffset, 4 * floats.size());
  return floats;
}

GltfTrack read_gltf(const std::string& name, const std::vector<TrackRow>& rows, const Shot& shot) {
  const std::string bytes = written(name, rows, shot);
  const auto size = static_cast<unsigned>(bytes.size());
  GltfTrack track;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  EXPECT_TRUE(name.ends_with(".glb") ? loader.LoadBinaryFromMemory(&track.model, &error, &warning,
                                                                   reinterpret_cast<const unsigned char*>(bytes.data()), size)
                                     : loader.LoadASCIIFromString(&track.model, &error, &warning, bytes.data(), size, ""));
  EXPECT_EQ(error + warning, "");
  const tinygltf::Animation& animation = track.model.animations.at(0);
  for (const tinygltf::AnimationChannel& channel : animation.channels) {
    EXPECT_EQ(channel.target_node, 0);
    const tinygltf::AnimationSampler& sampler = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
    EXPECT_EQ(sampler.interpolation, "LINEAR");
    const std::vector<float> times = floats_of(track.model, sampler.input), values = floats_of(track.model, sampler.output);
    track.times_s.assign(times.begin(), times.end());
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (channel.target_path == "translation")
        track.translations_m.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      else
        track.rotations_xyzw.emplace_back(values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]);
    }
  }
  return track;
}

class GltfFile : public ::testing::TestWithParam<const char*> {};

TEST_P(GltfFile, SeesTheTagWhereTheCameraSawIt) {
  const std::vector<TrackRow> found = found_rows(orbit());
  const GltfTrack track = read_gltf(GetParam(), orbit(), shot());
  ASSERT_EQ(track.times_s.size(), found.size());
  ASSERT_EQ(track.translations_m.size(), found.size());
  ASSERT_EQ(track.rotations_xyzw.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(track.times_s[i], static_cast<float>(found[i].time_s));
    const glm::dvec3 camera_m = turned_back(track.rotations_xyzw[i], on_table(kAbove_m) - track.translations_m[i]);
    const glm::dvec2 expected = (seen_px(found[i], kAbove_m) - glm::dvec2(319.5, 239.5)) / 600.0;
    EXPECT_LT(glm::distance(pinhole(camera_m), expected), kSingle_rad) << "frame " << found[i].frame;
  }
}

TEST_P(GltfFile, LensIsThatOfTheCamera) {
  Shot wide = shot();
  wide.camera.fx_px = 500;
  const tinygltf::Model model = read_gltf(GetParam(), orbit(), wide).model;
  ASSERT_EQ(model.nodes.at(0).camera, 0);
  const tinygltf::PerspectiveCamera& lens = model.cameras.at(0).perspective;
  EXPECT_NEAR(240 / std::tan(lens.yfov / 2), 600, 1e-9);
  EXPECT_NEAR(320 / (std::tan(lens.yfov / 2) * lens.aspectRatio), 500, 1e-9);
  EXPECT_GT(lens.znear, 0);
  EXPECT_EQ(model.cameras[0].extras.Get("fx_px").GetNumberAsDouble(), 500);
}

/// glTF wants it of every animation; a program that does not find it may refuse the file.
TEST_P(GltfFile, TimesHaveTheirBounds) {
  const tinygltf::Model model = read_gltf(GetParam(), orbit(), shot()).model;
  const tinygltf::Accessor& times = model.accessors.at(0);
  EXPECT_THAT(times.minValues, ElementsAre(0.0));
  EXPECT_THAT(times.maxValues, ElementsAre(static_cast<double>(static_cast<float>(59 / 25.0))));
}

TEST_P(GltfFile, QuaternionsNeverJumpToTheirNegative) {
  const GltfTrack track = read_gltf(GetParam(), orbit(), shot());
  for (std::size_t i = 1; i < track.rotations_xyzw.size(); ++i)
    EXPECT_GT(glm::dot(track.rotations_xyzw[i], track.rotations_xyzw[i - 1]), 0) << i;
}

INSTANTIATE_TEST_SUITE_P(Containers, GltfFile, ::testing::Values("path.gltf", "path.glb"),
                         [](const auto& test) { return std::string(test.param).substr(5); });

/// A +y-up model stood on a tag that lies flat, imported beside the camera as it is: its place in the world is upright at the
/// origin.
TEST(GltfScene, ObjectsPlacesAreUprightInTheWorld) {
  Shot one = shot();
  one.scene.objects.resize(1);
  one.scene.objects[0].mesh = "models/robot.glb";
  one.scene.objects[0].rotation_deg = {90, 0, 0};
  one.scene.objects[0].translation_m = {0.1, 0.2, 0.3};
  const tinygltf::Model model = read_gltf("path.glb", orbit(), one).model;
  EXPECT_THAT(model.scenes.at(0).nodes, ElementsAre(0, 1));
  const tinygltf::Node& tag = model.nodes.at(1);
  EXPECT_EQ(tag.name, "tag");
  ASSERT_THAT(tag.children, ElementsAre(2));
  const tinygltf::Node& place = model.nodes.at(2);
  EXPECT_EQ(place.name, "place of robot.glb");
  const std::vector<double>& m = place.matrix;
  ASSERT_EQ(m.size(), 16u);
  const glm::dvec4 tag_xyzw(tag.rotation.at(0), tag.rotation.at(1), tag.rotation.at(2), tag.rotation.at(3));
  const auto in_world = [&](const glm::dvec3& v) { return turned(tag_xyzw, v); };
  EXPECT_LT(glm::distance(in_world({m[0], m[1], m[2]}), {1, 0, 0}), 1e-12);
  EXPECT_LT(glm::distance(in_world({m[4], m[5], m[6]}), {0, 1, 0}), 1e-12);
  EXPECT_LT(glm::distance(in_world({m[8], m[9], m[10]}), {0, 0, 1}), 1e-12);
  EXPECT_LT(glm::distance(in_world({m[12], m[13], m[14]}), {0.1, 0.3, -0.2}), 1e-12);
}

TEST(GltfScene, FramesOfTheSameTimeKeepTheFirst) {
  std::vector<TrackRow> rows = orbit();
  rows[3].time_s = rows[2].time_s;
  const GltfTrack track = read_gltf("path.glb", rows, shot());
  EXPECT_EQ(track.times_s.size(), found_rows(rows).size() - 1);
  EXPECT_TRUE(std::is_sorted(track.times_s.begin(), track.times_s.end(), std::less_equal<>()));
}

}  // namespace
}  // namespace catchlight::app
