// Every format is read back as the program it is for reads it, by code of our own here or by another library, and a point on the
// tag is projected through the camera it describes.
#include "app/track_export/track_export.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"
#include "tests/support/orbit_track.hpp"
#include "tracking/track_file.hpp"

#include <gmock/gmock.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sstream>

namespace catchlight::app {
namespace {

using namespace orbit_test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;
using tests::TemporaryFolder;

constexpr double kText_px = 1e-6;  // the formats of text keep every bit

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

glm::dvec2 pixels(const glm::dvec2& offset, double vertical_fov_rad) {
  return glm::dvec2(319.5, 239.5) + offset * (240 / std::tan(vertical_fov_rad / 2));
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
  const auto lines = numbers_of(written("path.chan", rows, shot(render::UpAxis::y)));
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
  measured.corner_sigma_px = 0.1 + 0.2;
  measured.ambiguity = 0.7;
  measured.pose_covariance.emplace()[6 * 1 + 5] = 2e-7;
  bare.has_exposure = false;
  std::istringstream text(written("path.jsonl", {measured, bare}, shot()));
  std::string line;
  std::getline(text, line);
  const nlohmann::json first = nlohmann::json::parse(line);
  EXPECT_EQ(first.at("exposure"), nlohmann::json({1.0 / 3, 0.2, 0.1}));
  EXPECT_EQ(first.at("black"), nlohmann::json({1e-17, 0.0, 2.0 / 3}));
  EXPECT_EQ(first.at("corner_sigma_px"), 0.1 + 0.2);
  EXPECT_EQ(first.at("ambiguity"), 0.7);
  EXPECT_EQ(first.at("pose_covariance").at(1).at(5), 2e-7) << "the turn about y with the way along z";
  std::getline(text, line);
  EXPECT_TRUE(nlohmann::json::parse(line).at("exposure").is_null());
  EXPECT_TRUE(nlohmann::json::parse(line).at("black").is_null());
  EXPECT_TRUE(nlohmann::json::parse(line).at("pose_covariance").is_null());
}

// --- all of them ------------------------------------------------------------------------------------------------------

TEST(TrackExport, CsvIsTheTrackFile) {
  EXPECT_EQ(written("track.csv", orbit(), shot()),
            tracking::track_file_text(orbit(), tracking::TrackSubject{shot().camera, shot().scene.tag.target()}));
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
                                      "right of and 3 px above the middle")));
  for (const char* name : {"a.csv", "a.jsonl", "a.tum"}) EXPECT_THAT(warnings(name), IsEmpty());
}

/// The number behind a word of a message.
double number_after(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  EXPECT_NE(at, std::string::npos) << word << " in " << text;
  return at == std::string::npos ? 0 : std::stod(text.substr(at + word.size()));
}

/// Blender's importer sets Sensor Fit to horizontal, and the focal length from the field of view by the sensor's *height*: pixels
/// come out square only where the sensor has the picture's aspect.
TEST(TrackExport, SensorThatIsPrintedGivesBlenderTheCameraOfAChan) {
  for (const auto& [width_px, height_px] : {std::pair{640, 480}, {1920, 1080}, {1080, 1920}, {960, 544}}) {
    CameraModel camera = shot().camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    const std::string text = importer_settings("track.chan", camera);
    EXPECT_THAT(text, HasSubstr("rotation order ZXY"));
    const double sensor_width = number_after(text, "sensor width "), sensor_height = number_after(text, "sensor height "),
                 fov_rad = glm::radians(number_after(text, "field of view is "));
    const double lens = sensor_height / (2 * std::tan(fov_rad / 2));
    EXPECT_NEAR(lens / sensor_width * width_px / camera.fy_px, 1, 5e-4) << text;
  }
  for (const char* name : {"a.csv", "a.jsonl", "a.tum", "a.glb", "a.gltf"}) EXPECT_EQ(importer_settings(name, shot().camera), "");
}

/// A shift of 1 moves the picture by the side that Sensor Fit names: the height for an imported glTF camera, the width for a
/// .chan.
TEST(TrackExport, ShiftsThatAreWarnedOfPutThePrincipalPointWhereItIs) {
  const TemporaryFolder folder;
  Shot odd = shot();
  odd.camera.cx_px += 31;
  odd.camera.cy_px -= 17;
  const double middle_x_px = (odd.camera.width_px - 1) / 2.0, middle_y_px = (odd.camera.height_px - 1) / 2.0;
  for (const char* name : {"a.chan", "a.gltf", "a.glb"}) {
    std::string warning;
    write_track(folder.path(name), orbit(), odd, true, [&](const std::string& text) { warning = text; });
    const double fit_px = std::string(name) == "a.chan" ? odd.camera.width_px : odd.camera.height_px;
    EXPECT_NEAR(middle_x_px - fit_px * number_after(warning, "Shift X "), odd.camera.cx_px, 0.05) << name;
    EXPECT_NEAR(middle_y_px + fit_px * number_after(warning, "Shift Y "), odd.camera.cy_px, 0.05) << name;
  }
}

}  // namespace
}  // namespace catchlight::app
