#include "tracking/track_file.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace catchlight::tracking {
namespace {

using catchlight::tests::message_of;
using catchlight::tests::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kPoseHeader = "frame,r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz\n";
constexpr const char* kIdentity = ",1,0,0,0,1,0,0,0,1,0,0,1\n";

std::vector<TrackRow> read(const std::string& text) {
  const TemporaryFolder folder;
  return read_track_file(folder.write("track.csv", text)).rows;
}

/// What follows the file's name.
std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.write("track.csv", text);
  const std::string message = message_of<Error>([&] { read_track_file(path); });
  EXPECT_THAT(message, StartsWith(path + ':'));
  return message.substr(std::min(message.size(), path.size() + 1));
}

TrackRow random_row(std::mt19937_64& random, std::int64_t frame) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  TrackRow row;
  row.frame = frame;
  row.time_s = static_cast<double>(frame) / 29.97;
  row.found = true;
  row.state = frame % 2 ? TrackState::coasting : TrackState::tracking;
  row.camera_from_tag.rotation = glm::dmat3(glm::rotate(glm::dmat4(1.0), 3 * uniform(random), glm::normalize(vector())));
  row.camera_from_tag.translation_m = vector();
  row.exposure = vector();
  row.black = vector() * 1e-9;
  row.corner_sigma_px = uniform(random);
  row.blur_px2 = {uniform(random), uniform(random), uniform(random)};
  row.noise_codes = uniform(random);
  row.ambiguity = uniform(random);
  row.noise = {vector(), vector(), vector()};
  row.blur = {{vector(), vector()}, uniform(random), uniform(random), {uniform(random), uniform(random)}};
  PoseCovariance& covariance = row.pose_covariance.emplace();
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j) covariance[6 * i + j] = covariance[6 * j + i] = 1e-7 * uniform(random);
  return row;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const glm::dvec3& a, const glm::dvec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

void expect_same(const TrackRow& a, const TrackRow& b) {
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.found, b.found);
  EXPECT_EQ(a.state, b.state);
  EXPECT_TRUE(same_bits(a.time_s, b.time_s));
  for (int column = 0; column < 3; ++column)
    EXPECT_TRUE(same_bits(a.camera_from_tag.rotation[column], b.camera_from_tag.rotation[column]))
        << "rotation's column " << column;
  EXPECT_TRUE(same_bits(a.camera_from_tag.translation_m, b.camera_from_tag.translation_m));
  EXPECT_TRUE(same_bits(a.exposure, b.exposure));
  EXPECT_TRUE(same_bits(a.black, b.black));
  EXPECT_TRUE(same_bits(a.corner_sigma_px, b.corner_sigma_px));
  EXPECT_TRUE(same_bits(a.blur_px2.xx, b.blur_px2.xx));
  EXPECT_TRUE(same_bits(a.blur_px2.xy, b.blur_px2.xy));
  EXPECT_TRUE(same_bits(a.blur_px2.yy, b.blur_px2.yy));
  EXPECT_TRUE(same_bits(a.noise_codes, b.noise_codes));
  EXPECT_TRUE(same_bits(a.ambiguity, b.ambiguity));
  EXPECT_TRUE(same_bits(a.noise.slope, b.noise.slope));
  EXPECT_TRUE(same_bits(a.noise.floor, b.noise.floor));
  EXPECT_TRUE(same_bits(a.noise.correlation, b.noise.correlation));
  EXPECT_TRUE(same_bits(a.blur.motion.turn_rad, b.blur.motion.turn_rad));
  EXPECT_TRUE(same_bits(a.blur.motion.shift_m, b.blur.motion.shift_m));
  EXPECT_TRUE(same_bits(a.blur.shutter, b.blur.shutter));
  EXPECT_TRUE(same_bits(a.blur.focus_px2, b.blur.focus_px2));
  EXPECT_TRUE(same_bits(a.blur.shake_rad.x, b.blur.shake_rad.x));
  EXPECT_TRUE(same_bits(a.blur.shake_rad.y, b.blur.shake_rad.y));
  EXPECT_EQ(a.pose_covariance, b.pose_covariance);
}

/// The chunks of one recording are the same bytes as one run only if this holds.
TEST(TrackFile, EveryBitSurvives) {
  const TemporaryFolder folder;
  std::mt19937_64 random(3);
  std::vector<TrackRow> rows;
  for (int i = 0; i < 200; ++i) rows.push_back(random_row(random, 5 + 3 * i));
  const std::vector<TrackRow> back = read_track_file(folder.write("track.csv", track_file_text(rows))).rows;
  ASSERT_EQ(back.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) expect_same(back[i], rows[i]);
}

TEST(TrackFile, LostFrameHasEmptyPoseCells) {
  const TemporaryFolder folder;
  TrackRow lost;
  lost.frame = 4;
  lost.time_s = 0.5;
  EXPECT_EQ(
      track_file_text({lost}),
      "frame,time_s,found,r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz,state,exposure_r,exposure_g,exposure_b,black_r,black_g,"
      "black_b,corner_sigma_px,ambiguity,blur_xx_px2,blur_xy_px2,blur_yy_px2,noise_codes,"
      "noise_slope_r,noise_slope_g,noise_slope_b,noise_floor_r,noise_floor_g,noise_floor_b,noise_correlation_rg,"
      "noise_correlation_rb,noise_correlation_gb,turn_x,turn_y,turn_z,shift_x,shift_y,shift_z,shutter,focus_px2,shake_x,shake_y,"
      "cov_rx_rx,cov_rx_ry,cov_rx_rz,cov_rx_tx,cov_rx_ty,cov_rx_tz,cov_ry_ry,cov_ry_rz,cov_ry_tx,cov_ry_ty,cov_ry_tz,"
      "cov_rz_rz,cov_rz_tx,cov_rz_ty,cov_rz_tz,cov_tx_tx,cov_tx_ty,cov_tx_tz,cov_ty_ty,cov_ty_tz,cov_tz_tz\n"
      "4,0.5,0,,,,,,,,,,,,,lost,1,1,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,,,,,,,,,,,,,,,,,,,,,\n");
  const std::vector<TrackRow> back = read_track_file(folder.write("track.csv", track_file_text({lost}))).rows;
  ASSERT_EQ(back.size(), 1u);
  expect_same(back[0], lost);
}

TEST(TrackFile, CellsAreRowMajor) {
  const std::vector<TrackRow> rows = read(std::string(kPoseHeader) + "0,0,-1,0,1,0,0,0,0,1,7,8,9\n");  // a quarter turn about z
  ASSERT_EQ(rows.size(), 1u);
  const glm::dvec3 mapped = rows[0].camera_from_tag * glm::dvec3(1, 0, 0);
  EXPECT_EQ(mapped, glm::dvec3(7, 9, 9));
}

TEST(TrackFile, KnownPosesReadWithoutTheOtherColumns) {
  const std::vector<TrackRow> rows = read(std::string(kPoseHeader) + "3" + kIdentity);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].frame, 3);
  EXPECT_TRUE(rows[0].found);
  EXPECT_EQ(rows[0].state, TrackState::tracking);
  EXPECT_EQ(rows[0].exposure, glm::dvec3(1));
  EXPECT_EQ(rows[0].black, glm::dvec3(0));
}

TEST(TrackFile, OneOfTheFirstReleasesHasItsExposureAndNoNoiseOrBlur) {
  const std::vector<TrackRow> rows = read(
      "frame,time_s,found,r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz,state,exposure_r,exposure_g,exposure_b,black_r,"
      "black_g,black_b\n3,0.125,1,1,0,0,0,1,0,0,0,1,0,0,1,tracking,0.5,0.6,0.7,0.01,0.02,0.03\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].has_exposure);
  EXPECT_EQ(rows[0].exposure, glm::dvec3(0.5, 0.6, 0.7));
  EXPECT_EQ(rows[0].black, glm::dvec3(0.01, 0.02, 0.03));
  EXPECT_EQ(rows[0].noise_codes, 0);
  EXPECT_EQ(rows[0].noise.slope, glm::dvec3(0));
  EXPECT_EQ(rows[0].blur.shutter, 0);
}

/// Which camera and which tag: the same bits, in every row.
TEST(TrackFile, SaysWhatItIsATrackOf) {
  const TemporaryFolder folder;
  CameraModel camera{640, 480, 600.1, 600.2, 319.3, 239.7, {-0.1, 0.02, 1.0 / 3, 0, 0, 0, 0, 1e-9}};
  const PrintedTag tag{"tag25h9", 7, 0.14};
  std::vector<TrackRow> rows(2);
  rows[1].frame = 1;
  const std::string text = track_file_text(rows, TrackSubject{camera, tag});
  const TrackFile file = read_track_file(folder.write("track.csv", text));
  ASSERT_TRUE(file.subject);
  EXPECT_EQ(file.subject->camera, camera);
  EXPECT_EQ(file.subject->tag, tag);
  EXPECT_EQ(file.rows.size(), 2u);
  EXPECT_FALSE(read_track_file(folder.write("bare.csv", std::string(kPoseHeader) + "3" + kIdentity)).subject);
  EXPECT_FALSE(read_track_file(folder.path("bare.csv")).has_times);
}

/// Spreadsheets mark the bytes' order and write semicolons, where the language has decimal commas.
TEST(TrackFile, WhatSpreadsheetsWriteIsRead) {
  std::string text = "\xEF\xBB\xBF" + std::string(kPoseHeader) + "3" + kIdentity;
  EXPECT_EQ(read(text).at(0).frame, 3);
  std::replace(text.begin(), text.end(), ',', ';');
  text.replace(text.rfind(";1\n"), 3, ";0,75\n");
  EXPECT_EQ(read(text).at(0).camera_from_tag.translation_m.z, 0.75);
}

TEST(TrackFile, ColumnsAreFoundByNameAndUnknownOnesLeftAlone) {
  const std::vector<TrackRow> rows =
      read("tz,ty,tx,note,r22,r21,r20,r12,r11,r10,r02,r01,r00,frame\n3,2,1,hello,1,0,0,0,1,0,0,0,1,6\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].frame, 6);
  EXPECT_EQ(rows[0].camera_from_tag.translation_m, glm::dvec3(1, 2, 3));
}

TEST(TrackFile, LineEndsOfOtherSystemsAndAnEmptyLastLineAreFine) {
  EXPECT_EQ(read("frame,found,state\r\n0,0,lost\r\n1,0,lost\r\n\r\n").size(), 2u);
}

TEST(TrackFile, ShippedPosesAreRotations) {
  for (const char* name : {"matte", "gloss", "mirror"})
    EXPECT_EQ(read_track_file(std::string(CATCHLIGHT_SOURCE_DIR "/recordings/") + name + "/poses.csv").rows.size(), 36u) << name;
}

struct Damage {
  const char* name;
  std::string text, message;
};

class DamagedTrackFile : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedTrackFile, IsRefusedWithItsLine) {
  EXPECT_EQ(refusal(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    TrackFile, DamagedTrackFile,
    ::testing::Values(
        Damage{"Empty", "", "1: no column 'frame'; expected a track file, whose first line begins frame,time_s,found,r00"},
        Damage{"NoHeader", "0,0,1\n", "1: column '0' is named twice"},
        Damage{"ColumnTwice", "frame,tx,tx\n", "1: column 'tx' is named twice"},
        Damage{"CutLine", std::string(kPoseHeader) + "0,1,0,0\n", "2: has 4 fields; the first line names 13"},
        Damage{"PoseColumnMissing", "frame,r00\n0,1\n", "2: no column 'r01', which a frame with a pose needs"},
        Damage{"FrameNotWhole", "frame,found\n0.5,0\n", "2: column 'frame' is \"0.5\"; expected a whole number from 0"},
        Damage{"FrameNegative", "frame,found\n-1,0\n", "2: column 'frame' is \"-1\"; expected a whole number from 0"},
        Damage{"FoundNeither", "frame,found\n0,yes\n", "2: column 'found' is \"yes\"; expected 0 or 1"},
        Damage{"StateUnknown", "frame,found,state\n0,0,seen\n", "2: column 'state' is \"seen\"; expected lost, as found is 0"},
        Damage{"StateAgainstFound", std::string("state,") + kPoseHeader + "lost,0" + kIdentity,
               "2: column 'state' is \"lost\"; expected tracking or coasting, as found is 1"},
        Damage{"NotANumber", std::string(kPoseHeader) + "0,nan,0,0,0,1,0,0,0,1,0,0,1\n",
               "2: column 'r00' is \"nan\"; expected a finite number"},
        Damage{"Infinite", std::string(kPoseHeader) + "0,1,0,0,0,1,0,0,0,1,0,0,inf\n",
               "2: column 'tz' is \"inf\"; expected a finite number"},
        Damage{"EmptyCell", std::string(kPoseHeader) + "0,,0,0,0,1,0,0,0,1,0,0,1\n",
               "2: column 'r00' is \"\"; expected a finite number"},
        Damage{"Mirrored", std::string(kPoseHeader) + "0,1,0,0,0,1,0,0,0,-1,0,0,1\n",
               "2: r00 .. r22 are not a rotation: expected orthonormal rows within 0.001 and determinant 1"},
        Damage{"Scaled", std::string(kPoseHeader) + "0,1.002,0,0,0,1,0,0,0,1,0,0,1\n",
               "2: r00 .. r22 are not a rotation: expected orthonormal rows within 0.001 and determinant 1"},
        Damage{"Sheared", std::string(kPoseHeader) + "0,1,0.002,0,0,1,0,0,0,1,0,0,1\n",
               "2: r00 .. r22 are not a rotation: expected orthonormal rows within 0.001 and determinant 1"},
        Damage{"SameFrameTwice", std::string(kPoseHeader) + "4" + kIdentity + "4" + kIdentity,
               "3: frame 4 after frame 4; expected rising order"},
        Damage{"FramesOutOfOrder", std::string(kPoseHeader) + "4" + kIdentity + "3" + kIdentity,
               "3: frame 3 after frame 4; expected rising order"}),
    [](const auto& test) { return test.param.name; });

TEST(TrackFile, RoundedRotationsAreAccepted) {
  // Six digits, as poses of other programs have; far within the tolerance.
  EXPECT_EQ(read(std::string(kPoseHeader) + "0,0.866025,-0.5,0,0.5,0.866025,0,0,0,1,0,0,1\n").size(), 1u);
}

TEST(TrackFile, MissingFileIsNamed) {
  EXPECT_THAT(message_of<Error>([] { read_track_file("/nowhere/track.csv"); }),
              HasSubstr("/nowhere/track.csv: cannot open the track file"));
}

}  // namespace
}  // namespace catchlight::tracking
