#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "app/tools/replay/baseline.hpp"
#include "app/tools/replay/expected.hpp"
#include "app/tools/replay/pose_comparison.hpp"
#include "app/tools/replay/replay.hpp"
#include "app/tools/replay/replay_report.hpp"
#include "app/tools/replay/sheet.hpp"
#include "app/tools/replay/truth_comparison.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/track.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;

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

// --- a kept run -------------------------------------------------------------------------------------------------------

TEST(KeptPicture, ComparesWhereEitherChangesThePlateAndNowhereElse) {
  const Pictures p;
  const KeptDifference same = compare_with_kept(p.truth, p.truth, p.plate);
  EXPECT_EQ(same.mean, 0);
  EXPECT_EQ(same.p99, 0);
  // 2400 pixels are changed, the object's 1600 of them by 6 more in one channel: 6 x 1600 / 2400.
  cv::Mat ours = p.truth.clone();
  ours(cv::Rect(40, 40, 40, 40)) += cv::Scalar(0, 6, 2);
  EXPECT_NEAR(compare_with_kept(ours, p.truth, p.plate).mean, 4, 1e-9);
  EXPECT_EQ(compare_with_kept(ours, p.truth, p.plate).p99, 6);
  EXPECT_EQ(compare_with_kept(p.truth, ours, p.plate).mean, 4) << "either way";
  // A shadow that is gone counts where it was.
  ours = p.truth.clone();
  ours(cv::Rect(40, 84, 40, 20)) = cv::Scalar(128, 128, 128);
  EXPECT_NEAR(compare_with_kept(ours, p.truth, p.plate).mean, 38.0 / 3, 1e-9);
  EXPECT_EQ(compare_with_kept(p.plate, p.plate, p.plate).mean, 0) << "nothing is drawn";
}

std::vector<TrackRow> rows_found(const std::vector<bool>& found) {
  std::vector<TrackRow> rows(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    rows[i].frame = static_cast<std::int64_t>(i);
    rows[i].found = found[i];
    rows[i].state = found[i] ? TrackState::tracking : TrackState::lost;
  }
  return rows;
}

TEST(Baseline, KeepsTheTrackAndChoosesFramesThatShowTheTag) {
  const tests::TemporaryFolder folder;
  const Baseline baseline(folder.path());
  EXPECT_FALSE(baseline.is_kept());
  EXPECT_THAT(baseline.keep(rows_found({false, true, true, true, false, true, false})), ElementsAre(1, 3, 5));
  EXPECT_TRUE(baseline.is_kept());
  EXPECT_EQ(tracking::read_track_file(baseline.track_file()).rows.size(), 7u);
  EXPECT_THAT(baseline.keep(rows_found({false, true})), ElementsAre(1)) << "a frame is kept once";
  EXPECT_THAT(message_of<Error>([&] { baseline.keep(rows_found({false, false})); }), HasSubstr("found in no frame"));
}

TEST(Baseline, KeepsTheFramesThatUsersChose) {
  const tests::TemporaryFolder folder;
  folder.write("baseline/0002.png", "");
  folder.write("baseline/0009.png", "");  // not of this footage
  EXPECT_THAT(Baseline(folder.path()).keep(rows_found({true, true, false, true})), ElementsAre(2));
}

TEST(CheckComparable, SaysWhatWouldMakeARecordingComparable) {
  const tests::TemporaryFolder folder;
  EXPECT_THAT(message_of<Error>([&] { check_comparable(folder.path(), false); }),
              AllOf(HasSubstr("truth/"), HasSubstr("--bless")));
  EXPECT_NO_THROW(check_comparable(folder.path(), true));
  Baseline(folder.path()).keep(rows_found({true}));
  EXPECT_NO_THROW(check_comparable(folder.path(), false));
  EXPECT_FALSE(knows_truth(folder.path()));
  folder.write("poses.csv", "");
  EXPECT_TRUE(knows_truth(folder.path()));
}

TEST(ReplayReport, HasEveryFigureWithWhatWasExpectedOfIt) {
  Replayed replayed;
  replayed.folder = "shots/a", replayed.sheet = "out/a.png";
  replayed.result.name = "a";
  replayed.result.kept.emplace();
  replayed.result.figures = {{"picture.mean", 0.5, 0.2}, {"picture.p99", 1, 2}};
  replayed.expected = {{"picture.mean", 0}};
  replayed.drifted = {"picture.mean = 0.5, expected 0 +- 0.2"};
  const auto json = nlohmann::json::parse(replay_json({replayed}));
  EXPECT_EQ(json["as_expected"], false);
  const auto& a = json["recordings"][0];
  EXPECT_EQ(a["name"], "a");
  EXPECT_EQ(a["folder"], "shots/a");
  EXPECT_EQ(a["verdict"], "drifted");
  EXPECT_EQ(a["against"], "baseline");
  EXPECT_TRUE(a["sheet"].is_null()) << "there were no pictures";
  EXPECT_EQ(a["figures"]["picture.mean"], (nlohmann::json{{"value", 0.5}, {"expected", 0.0}, {"tolerance", 0.2}}));
  EXPECT_TRUE(a["figures"]["picture.p99"]["expected"].is_null());
  EXPECT_EQ(a["messages"], nlohmann::json(replayed.drifted));
  replayed.drifted.clear();
  EXPECT_EQ(nlohmann::json::parse(replay_json({replayed}))["as_expected"], true);
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
