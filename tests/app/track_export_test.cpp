// Every format is read back as the program it is for reads it, by code of our own here or by another library, and a point on the
// tag is projected through the camera it describes.
#include "app/track_export/track_export.hpp"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <random>
#include <sstream>

#include "render/gltf.hpp"
#include "tests/app/temporary_folder.hpp"
#include "tracking/lens.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;
using tests::TemporaryFolder;
using tracking::TrackState;

constexpr double kText_px = 1e-6;           // the formats of text keep every bit
constexpr double kSingle_rad = 1e-6;        // 4 components of half an ulp, 3e-8 each, twice, and as much again of the translation
const glm::dvec3 kCorner_m(0.03, 0.05, 0);  // on the tag, nowhere special
const glm::dvec3 kAbove_m(-0.02, 0.01, 0.07);

/// Square pixels, centred: what every one of these programs can have.
CameraModel centred_camera() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 600;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  return camera;
}

Shot shot(const char* up = "z") {
  Shot shot{centred_camera(), {}, false};
  shot.scene.probe.up = up;
  return shot;
}

TrackRow row_of(std::int64_t frame, const RigidTransform& camera_from_tag) {
  TrackRow row;
  row.frame = frame;
  row.time_s = static_cast<double>(frame) / 25;
  row.found = true;
  row.state = TrackState::tracking;
  row.camera_from_tag = camera_from_tag;
  row.has_exposure = true;
  return row;
}

/// A camera at `position_m` of the tag's frame looking at the tag's centre, `roll_deg` turned about its axis.
RigidTransform looking_at_tag(const glm::dvec3& position_m, double roll_deg) {
  const glm::dvec3 forward = glm::normalize(-position_m);
  const glm::dvec3 aside = std::abs(forward.z) > 0.99999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, aside));
  const glm::dmat3 upright(right, glm::cross(forward, right), forward);
  const glm::dmat3 roll(glm::rotate(glm::dmat4(1.0), glm::radians(roll_deg), glm::dvec3(0, 0, 1)));
  return inverse(RigidTransform{upright * roll, position_m});
}

/// Twice around the tag, rising until it is looked down on, rolling; frames 7, 20 and 21 are lost.
std::vector<TrackRow> orbit() {
  std::vector<TrackRow> rows;
  for (int frame = 0; frame < 60; ++frame) {
    const double around = frame * 4 * CV_PI / 60, height = frame * 1.57 / 60;
    const glm::dvec3 direction(std::cos(around) * std::cos(height), std::sin(around) * std::cos(height), std::sin(height));
    TrackRow row = row_of(frame, looking_at_tag(0.6 * direction, 6.0 * frame));
    if (frame == 7 || frame == 20 || frame == 21) {
      row.found = false;
      row.state = TrackState::lost;
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<TrackRow> found_rows(std::vector<TrackRow> rows) {
  std::erase_if(rows, [](const TrackRow& row) { return !row.found; });
  return rows;
}

std::string written(const std::string& name, const std::vector<TrackRow>& rows, const Shot& shot) {
  const TemporaryFolder folder;
  write_track(folder.path(name), rows, shot, false, [](const std::string& text) { ADD_FAILURE() << "warned: " << text; });
  EXPECT_THAT(folder.names(), ElementsAre(name));
  return tests::read_text(folder.path(name));
}

/// Lines of numbers; those that begin with # left out.
std::vector<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<std::vector<double>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    lines.emplace_back(std::istream_iterator<double>(fields), std::istream_iterator<double>());
    EXPECT_TRUE(fields.eof()) << line;
  }
  return lines;
}

glm::dvec2 seen_px(const TrackRow& row, const glm::dvec3& point_tag_m) {
  return tracking::project_px(centred_camera(), row.camera_from_tag * point_tag_m).value();
}

/// v turned by the quaternion: v + 2 w (u x v) + 2 u x (u x v), u = (x, y, z).
glm::dvec3 turned(const glm::dvec4& xyzw, const glm::dvec3& v) {
  const glm::dvec3 u(xyzw);
  return v + 2 * xyzw.w * glm::cross(u, v) + 2.0 * glm::cross(u, glm::cross(u, v));
}

glm::dvec3 turned_back(const glm::dvec4& xyzw, const glm::dvec3& v) {
  return turned({-glm::dvec3(xyzw), xyzw.w}, v);
}

/// Where a camera with y up, looking along -z, with this vertical field of view sees a point: from the picture's middle, in units
/// of the focal length.
glm::dvec2 pinhole(const glm::dvec3& point_camera) {
  return glm::dvec2(point_camera.x, -point_camera.y) / -point_camera.z;
}

glm::dvec2 pixels(const glm::dvec2& offset, double vertical_fov_rad) {
  return glm::dvec2(319.5, 239.5) + offset * (240 / std::tan(vertical_fov_rad / 2));
}

/// The tag's point in a world whose +y is up, tag on a table.
glm::dvec3 on_table(const glm::dvec3& tag) {
  return {tag.x, tag.z, -tag.y};
}

// --- TUM --------------------------------------------------------------------------------------------------------------

TEST(TumTrack, SeesTheTagWhereTheCameraSawIt) {
  const std::vector<TrackRow> found = found_rows(orbit());
  for (const char* name : {"path.tum", "path.txt"}) {
    const auto lines = numbers_of(written(name, orbit(), shot()));
    ASSERT_EQ(lines.size(), found.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::vector<double>& v = lines[i];
      ASSERT_EQ(v.size(), 8u);
      EXPECT_EQ(v[0], found[i].time_s);
      const glm::dvec3 camera_m = turned_back({v[4], v[5], v[6], v[7]}, kAbove_m - glm::dvec3(v[1], v[2], v[3]));
      const glm::dvec2 px = glm::dvec2(319.5, 239.5) + 600.0 * glm::dvec2(camera_m) / camera_m.z;
      EXPECT_LT(glm::distance(px, seen_px(found[i], kAbove_m)), kText_px) << "frame " << found[i].frame;
    }
  }
}

TEST(TumTrack, QuaternionsNeverJumpToTheirNegative) {
  const auto lines = numbers_of(written("path.tum", orbit(), shot()));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    double dot = 0;
    for (std::size_t k = 4; k < 8; ++k) dot += lines[i][k] * lines[i - 1][k];
    EXPECT_GT(dot, 0) << "line " << i;
  }
}

TEST(TumTrack, HeaderNamesFramesAndColumns) {
  const std::string text = written("path.tum", orbit(), shot());
  EXPECT_THAT(text, HasSubstr("# World: the tag"));
  EXPECT_THAT(text, HasSubstr("\n# timestamp tx ty tz qx qy qz qw\n0 "));
}

// --- Nuke -------------------------------------------------------------------------------------------------------------

/// Nuke's ZXY: about z first, then x, then y.
glm::dmat4 nuke_rotation(double x_deg, double y_deg, double z_deg) {
  const glm::dmat4 about_y = glm::rotate(glm::dmat4(1.0), glm::radians(y_deg), glm::dvec3(0, 1, 0));
  const glm::dmat4 about_yx = glm::rotate(about_y, glm::radians(x_deg), glm::dvec3(1, 0, 0));
  return glm::rotate(about_yx, glm::radians(z_deg), glm::dvec3(0, 0, 1));
}

glm::dvec2 nuke_px(const std::vector<double>& v, const glm::dvec3& world_m) {
  const glm::dmat4 world_from_camera = glm::translate(glm::dmat4(1.0), {v[1], v[2], v[3]}) * nuke_rotation(v[4], v[5], v[6]);
  const glm::dvec3 camera_m(glm::inverse(world_from_camera) * glm::dvec4(world_m, 1));
  return pixels(pinhole(camera_m), glm::radians(v[7]));
}

TEST(ChanTrack, SeesTheTagWhereTheCameraSawIt) {
  const std::vector<TrackRow> found = found_rows(orbit());
  const auto lines = numbers_of(written("path.chan", orbit(), shot()));
  ASSERT_EQ(lines.size(), found.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].size(), 8u);
    for (const glm::dvec3& point_m : {kCorner_m, kAbove_m})
      EXPECT_LT(glm::distance(nuke_px(lines[i], on_table(point_m)), seen_px(found[i], point_m)), kText_px)
          << "frame " << found[i].frame;
  }
}

TEST(ChanTrack, OnAWallTheTagsAxesAreTheWorlds) {
  const std::vector<TrackRow> rows{row_of(0, looking_at_tag({0.1, 0.2, 0.5}, 20))};
  const auto lines = numbers_of(written("path.chan", rows, shot("y")));
  EXPECT_LT(glm::distance(nuke_px(lines.at(0), kAbove_m), seen_px(rows[0], kAbove_m)), kText_px);
}

TEST(ChanTrack, AMoviesFramesAreNumberedFromOneAndASequencesAsItsFiles) {
  const std::vector<TrackRow> rows{row_of(0, looking_at_tag({0.1, 0.2, 0.5}, 0)), row_of(5, looking_at_tag({0.1, 0.2, 0.5}, 0))};
  Shot movie = shot(), sequence = shot();
  sequence.is_sequence = true;
  const auto in_movie = numbers_of(written("path.chan", rows, movie)),
             in_sequence = numbers_of(written("path.chan", rows, sequence));
  EXPECT_EQ(in_movie[0][0], 1);
  EXPECT_EQ(in_movie[1][0], 6);
  EXPECT_EQ(in_sequence[0][0], 0);
  EXPECT_EQ(in_sequence[1][0], 5);
}

/// The orbit turns twice: 720 degrees about y, and no frame jumps to the same angle a turn away.
TEST(ChanTrack, AnglesAreContinuousOverWholeTurns) {
  const auto lines = numbers_of(written("path.chan", orbit(), shot()));
  for (std::size_t i = 1; i < lines.size(); ++i)
    for (std::size_t k = 4; k < 7; ++k) EXPECT_LT(std::abs(lines[i][k] - lines[i - 1][k]), 90) << "line " << i << " column " << k;
  EXPECT_NEAR(std::abs(lines.back()[5] - lines.front()[5]), 59 * 12, 1);
}

/// A tag on a table seen from right above: x is -90 degrees and only the sum of y and z is determined.
TEST(ChanTrack, LookingStraightDownIsOrdinary) {
  std::vector<TrackRow> rows;
  for (int frame = 0; frame < 20; ++frame) rows.push_back(row_of(frame, looking_at_tag({0, 0, 0.5}, 17.0 * frame)));
  const auto lines = numbers_of(written("path.chan", rows, shot()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_NEAR(lines[i][4], -90, 1e-6);
    EXPECT_EQ(lines[i][5], lines[0][5]) << "y stays";
    EXPECT_LT(glm::distance(nuke_px(lines[i], on_table(kAbove_m)), seen_px(rows[i], kAbove_m)), kText_px);
  }
  EXPECT_NEAR(std::abs(lines.back()[6] - lines.front()[6]), 19 * 17, 1e-6) << "z turns on without a jump";
}

/// Over the top: x passes -90 degrees and goes on, where the angles nearest to 0 would throw y and z around by half a turn.
TEST(ChanTrack, PassingOverTheTagDoesNotThrowTheAnglesAround) {
  std::vector<TrackRow> rows;
  for (int frame = -10; frame <= 10; ++frame) {
    const double tilt = glm::radians(2.0 * frame);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), CV_PI + tilt, glm::dvec3(1, 0, 0)));  // facing the tag, tilted about its x
    rows.push_back(row_of(frame + 10, {turn, {0, 0, 0.5}}));
  }
  const auto lines = numbers_of(written("path.chan", rows, shot()));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_NEAR(std::abs(lines[i][4] - lines[i - 1][4]), 2, 1e-6);
    EXPECT_NEAR(lines[i][5], lines[0][5], 1e-6);
    EXPECT_NEAR(lines[i][6], lines[0][6], 1e-6);
  }
}

// --- glTF -------------------------------------------------------------------------------------------------------------

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

// --- JSON lines -------------------------------------------------------------------------------------------------------

TEST(JsonLinesTrack, HasEveryFrameAndSeesTheTagWhereTheCameraSawIt) {
  const std::vector<TrackRow> rows = orbit();
  std::istringstream text(written("path.jsonl", rows, shot()));
  std::string line;
  for (const TrackRow& row : rows) {
    ASSERT_TRUE(std::getline(text, line));
    const nlohmann::json object = nlohmann::json::parse(line);
    EXPECT_EQ(object.at("frame"), row.frame);
    EXPECT_EQ(object.at("time_s"), row.time_s);
    EXPECT_EQ(object.at("state"), row.found ? "tracking" : "lost");
    const nlohmann::json& matrix = object.at("camera_from_tag");
    EXPECT_EQ(matrix.is_null(), !row.found);
    if (!row.found) continue;
    const cv::Matx44d camera_from_tag([&] {
      cv::Matx44d m;
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) m(r, c) = matrix.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
      return m;
    }());
    const cv::Vec4d camera_m = camera_from_tag * cv::Vec4d(kAbove_m.x, kAbove_m.y, kAbove_m.z, 1);
    EXPECT_EQ(camera_m[3], 1);
    const glm::dvec2 px(319.5 + 600 * camera_m[0] / camera_m[2], 239.5 + 600 * camera_m[1] / camera_m[2]);
    EXPECT_LT(glm::distance(px, seen_px(row, kAbove_m)), kText_px) << "frame " << row.frame;
  }
  EXPECT_FALSE(std::getline(text, line));
}

TEST(JsonLinesTrack, NumbersSurviveAndWhatWasNotMeasuredIsNull) {
  TrackRow measured = row_of(0, looking_at_tag({0.1, 0.2, 0.5}, 0)), bare = row_of(1, measured.camera_from_tag);
  measured.exposure = {1.0 / 3, 0.2, 0.1};
  measured.black = {1e-17, 0, 2.0 / 3};
  measured.corner_rms_px = 0.1 + 0.2;
  measured.ambiguity = 0.7;
  bare.has_exposure = false;
  std::istringstream text(written("path.jsonl", {measured, bare}, shot()));
  std::string line;
  std::getline(text, line);
  const nlohmann::json first = nlohmann::json::parse(line);
  EXPECT_EQ(first.at("exposure"), nlohmann::json({1.0 / 3, 0.2, 0.1}));
  EXPECT_EQ(first.at("black"), nlohmann::json({1e-17, 0.0, 2.0 / 3}));
  EXPECT_EQ(first.at("corner_rms_px"), 0.1 + 0.2);
  EXPECT_EQ(first.at("ambiguity"), 0.7);
  std::getline(text, line);
  EXPECT_TRUE(nlohmann::json::parse(line).at("exposure").is_null());
  EXPECT_TRUE(nlohmann::json::parse(line).at("black").is_null());
}

// --- all of them ------------------------------------------------------------------------------------------------------

TEST(TrackExport, CsvIsTheTrackFile) {
  EXPECT_EQ(written("track.csv", orbit(), shot()), track_file_text(orbit()));
}

TEST(TrackExport, UnknownExtensionNamesThoseThereAre) {
  for (const char* path : {"out.fbx", "out", "out.CSV"}) {
    const std::string message = message_of<UsageError>([&] { check_track_format(path); });
    EXPECT_THAT(message, HasSubstr(path));
    for (const char* known : {".csv", ".jsonl", ".tum", ".txt", ".chan", ".gltf", ".glb"}) EXPECT_THAT(message, HasSubstr(known));
  }
}

TEST(TrackExport, ExistingFileIsKept) {
  const TemporaryFolder folder;
  for (const char* name : {"a.csv", "a.jsonl", "a.tum", "a.chan", "a.gltf", "a.glb"}) {
    const std::string path = folder.write(name, "mine");
    EXPECT_THROW(write_track(path, orbit(), shot(), false, {}), UsageError);
    EXPECT_EQ(tests::read_text(path), "mine");
    write_track(path, orbit(), shot(), true, {});
    EXPECT_NE(tests::read_text(path), "mine");
  }
}

TEST(TrackExport, ATrackWithoutAPoseIsNoPath) {
  const TemporaryFolder folder;
  const std::vector<TrackRow> lost(3);
  for (const char* name : {"a.tum", "a.txt", "a.chan", "a.gltf", "a.glb"})
    EXPECT_THAT(message_of<Error>([&] { write_track(folder.path(name), lost, shot(), false, {}); }),
                HasSubstr(std::string(name) + ": no frame has a pose"));
  EXPECT_THAT(folder.names(), IsEmpty());
  for (const char* name : {"a.csv", "a.jsonl"}) write_track(folder.path(name), lost, shot(), false, {});
  EXPECT_EQ(folder.names().size(), 2u);
}

TEST(TrackExport, WhatAFieldOfViewDoesNotSayIsWarnedOf) {
  const TemporaryFolder folder;
  Shot odd = shot();
  odd.camera.cx_px += 12.25;
  odd.camera.cy_px -= 3;
  odd.camera.distortion[0] = -0.3;
  const auto warnings = [&](const char* name) {
    std::vector<std::string> texts;
    write_track(folder.path(name), orbit(), odd, true, [&](const std::string& text) { texts.push_back(text); });
    return texts;
  };
  for (const char* name : {"a.chan", "a.gltf", "a.glb"})
    EXPECT_THAT(warnings(name),
                ElementsAre(HasSubstr(std::string(name) +
                                      " does not hold the lens distortion and the principal point, which lies 12.25 px "
                                      "right of and -3 px below the middle")));
  for (const char* name : {"a.csv", "a.jsonl", "a.tum"}) EXPECT_THAT(warnings(name), IsEmpty());
}

}  // namespace
}  // namespace catchlight::app
