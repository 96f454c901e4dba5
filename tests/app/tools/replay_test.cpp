#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "app/tools/replay/expected.hpp"
#include "app/tools/replay/pose_comparison.hpp"
#include "app/tools/replay/sheet.hpp"
#include "app/tools/replay/truth_comparison.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// --- pictures ---------------------------------------------------------------------------------------------------------

/// A grey plate, an object of 40 x 40 in the middle, and below it a strip that it darkens.
struct Pictures {
  cv::Mat plate{120, 120, CV_8UC3, cv::Scalar(128, 128, 128)};
  cv::Mat truth = plate.clone();
  cv::Mat mask{120, 120, CV_8U, cv::Scalar(0)};
  Pictures() {
    const cv::Rect object(40, 40, 40, 40), shadow(40, 84, 40, 20);
    truth(object) = cv::Scalar(40, 80, 200);
    truth(shadow) = cv::Scalar(90, 90, 90);
    mask(object) = 255;
  }
};

TEST(TruthComparison, TheTruthItselfHasNoError) {
  const Pictures p;
  const TruthComparison result = compare_with_truth(p.truth, p.truth, p.plate, p.plate, p.mask);
  EXPECT_EQ(result.mask.mean, 0);
  EXPECT_EQ(result.shadow.mean, 0);
  EXPECT_EQ(result.elsewhere.mean, 0);
  EXPECT_NEAR(result.mask.ssim, 1.0, 1e-6);
  EXPECT_GT(result.mask.pixels, 1000);
  EXPECT_GT(result.shadow.pixels, 500);
}

TEST(TruthComparison, EachRegionSeesOnlyItsOwnError) {
  const Pictures p;
  cv::Mat ours = p.truth.clone();
  ours(cv::Rect(40, 40, 40, 40)) += cv::Scalar(10, 10, 10);
  const TruthComparison object_off = compare_with_truth(ours, p.truth, p.plate, p.plate, p.mask);
  EXPECT_NEAR(object_off.mask.mean, 10, 0.01);
  EXPECT_NEAR(object_off.mask.p95, 10, 0.01);
  EXPECT_NEAR(object_off.mask.psnr_db, 20 * std::log10(255.0 / 10), 0.01);
  EXPECT_NEAR(object_off.shadow.mean, 0, 0.5);  // the 5 x 5 box reaches a little over the border

  ours = p.truth.clone();
  ours(cv::Rect(0, 0, 20, 120)) += cv::Scalar(6, 0, 0);
  const TruthComparison elsewhere_off = compare_with_truth(ours, p.truth, p.plate, p.plate, p.mask);
  EXPECT_EQ(elsewhere_off.mask.mean, 0);
  EXPECT_GT(elsewhere_off.elsewhere.mean, 0.5);
  EXPECT_GT(elsewhere_off.elsewhere_changed_mean, 0.5);
}

TEST(TruthComparison, GlareIsWhereTheTruthIsBrighterThanThePlateAwayFromTheObject) {
  Pictures p;
  p.truth(cv::Rect(85, 85, 30, 30)) += cv::Scalar(0, 30, 50);
  const TruthComparison nothing_done = compare_with_truth(p.plate, p.truth, p.plate, p.plate, p.mask);
  EXPECT_GE(nothing_done.glare.pixels, 30 * 30);
  EXPECT_LE(nothing_done.glare.pixels, 38 * 38) << "the box's reach around it, but not the bright object's own rim";
  EXPECT_NEAR(nothing_done.glare.p95, 50, 1e-3);
  EXPECT_DOUBLE_EQ(nothing_done.glare.mean, nothing_done.glare_untouched_mean);
  EXPECT_EQ(compare_with_truth(p.truth, p.truth, p.plate, p.plate, p.mask).glare.mean, 0);
  const Pictures shadow_only;
  EXPECT_EQ(compare_with_truth(shadow_only.truth, shadow_only.truth, p.plate, p.plate, p.mask).glare.pixels, 0);
}

TEST(TruthComparison, DoingNothingIsMeasuredToo) {
  const Pictures p;
  const TruthComparison result = compare_with_truth(p.plate, p.truth, p.plate, p.plate, p.mask);
  EXPECT_DOUBLE_EQ(result.shadow.mean, result.shadow_untouched_mean);
  EXPECT_GT(result.shadow.mean, 10);
  EXPECT_EQ(result.elsewhere_changed_mean, 0);
}

TEST(TruthComparison, NoObjectInSightCountsNowhere) {
  Pictures p;
  p.mask = cv::Scalar(0);
  const TruthComparison none = compare_with_truth(p.plate, p.plate, p.plate, p.plate, p.mask);
  EXPECT_EQ(none.mask.pixels, 0);
  const Pictures q;
  const TruthComparison some = compare_with_truth(q.plate, q.truth, q.plate, q.plate, q.mask);
  EXPECT_DOUBLE_EQ(mean_of({none, some}).mask.mean, some.mask.mean);
}

TEST(Sheet, PutsFourPicturesSideBySideAndAmplifiesTheDifference) {
  const Pictures p;
  cv::Mat ours = p.truth.clone();
  ours += cv::Scalar(2, 2, 2);
  const cv::Mat row = sheet_row(p.plate, ours, p.truth);
  EXPECT_EQ(row.cols, 4 * 120);
  EXPECT_EQ(row.at<cv::Vec3b>(60, 3 * 120 + 60), cv::Vec3b(16, 16, 16));
}

// --- poses ------------------------------------------------------------------------------------------------------------

CameraModel camera_600() {
  CameraModel camera;
  camera.width_px = 640, camera.height_px = 480;
  camera.fx_px = camera.fy_px = 600, camera.cx_px = 319.5, camera.cy_px = 239.5;
  return camera;
}

TrackRow row_at(std::int64_t frame, const glm::dvec3& translation_m) {
  TrackRow row;
  row.frame = frame;
  row.found = true;
  row.state = TrackState::tracking;
  row.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);  // facing the camera
  row.camera_from_tag.translation_m = translation_m;
  return row;
}

TEST(PoseComparison, OneMillimetreSidewaysIsItsProjectionInPixels) {
  const std::vector<TrackRow> truth = {row_at(0, {0, 0, 0.6})}, ours = {row_at(0, {0.001, 0, 0.6})};
  const PoseComparison result = compare_poses(ours, truth, camera_600(), 0.08);
  EXPECT_NEAR(result.corner_rms_px, 1.0, 1e-9);
  EXPECT_NEAR(result.translation_median_mm, 1.0, 1e-9);
  EXPECT_EQ(result.rotation_max_deg, 0);
  EXPECT_EQ(result.flips, 0);
}

TEST(PoseComparison, TheOtherPlanarPoseIsAFlip) {
  std::vector<TrackRow> truth = {row_at(0, {0, 0, 0.6})}, ours = truth;
  const double c = std::cos(0.35), s = std::sin(0.35);
  ours[0].camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, c, s, 0, -s, c) * ours[0].camera_from_tag.rotation;
  const PoseComparison result = compare_poses(ours, truth, camera_600(), 0.08);
  EXPECT_EQ(result.flips, 1);
  EXPECT_NEAR(result.rotation_max_deg, glm::degrees(0.35), 1e-6);
}

TEST(PoseComparison, LostFramesAreCountedNotForgiven) {
  std::vector<TrackRow> truth = {row_at(0, {0, 0, 0.6}), row_at(1, {0, 0, 0.6})}, ours = truth;
  ours[1].found = false;
  const PoseComparison result = compare_poses(ours, truth, camera_600(), 0.08);
  EXPECT_EQ(result.frames, 2);
  EXPECT_EQ(result.tracked, 1);
}

// --- expected.toml ----------------------------------------------------------------------------------------------------

class ExpectedTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& text) {
    const std::string path = (folder_ / "expected.toml").string();
    std::ofstream(path) << text;
    return path;
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("catchlight_expected_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

const std::vector<Figure> kFigures = {{"mask.mean", 3.25, 0.1}, {"mask.ssim", 0.98, 0.002}, {"pose.flips", 0, 0}};

TEST_F(ExpectedTest, WhatWasBlessedDoesNotDrift) {
  const std::string path = (folder_ / "expected.toml").string();
  write_expected(path, kFigures);
  EXPECT_THAT(drift(kFigures, read_expected(path)), IsEmpty());
}

TEST_F(ExpectedTest, DriftEitherWayIsReported) {
  for (const double off : {-0.2, 0.2}) {
    std::vector<Figure> figures = kFigures;
    figures[0].value += off;
    const auto lines = drift(figures, {{"mask.mean", 3.25}, {"mask.ssim", 0.98}, {"pose.flips", 0}});
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_THAT(lines[0], HasSubstr("mask.mean"));
    EXPECT_THAT(lines[0], HasSubstr("expected 3.25"));
  }
}

TEST_F(ExpectedTest, NotANumberIsDrift) {
  std::vector<Figure> figures = kFigures;
  figures[0].value = std::nan("");
  EXPECT_EQ(drift(figures, {{"mask.mean", 3.25}, {"mask.ssim", 0.98}, {"pose.flips", 0}}).size(), 1u);
}

TEST_F(ExpectedTest, MissingOnEitherSideIsDrift) {
  EXPECT_EQ(drift(kFigures, {{"mask.mean", 3.25}, {"mask.ssim", 0.98}, {"pose.flips", 0}, {"shadow.mean", 1}}).size(), 1u);
  EXPECT_EQ(drift(kFigures, {{"mask.mean", 3.25}, {"mask.ssim", 0.98}}).size(), 1u);
}

TEST_F(ExpectedTest, BadFilesNameTheLine) {
  for (const char* text : {"[mask]\nmean = \"x\"\n", "[mask]\nmean = = 3\n"}) {
    const std::string path = write(text);
    try {
      read_expected(path);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path + ":2"));
    }
  }
}

}  // namespace
}  // namespace catchlight::app
