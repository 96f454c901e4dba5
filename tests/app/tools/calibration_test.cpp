// Cameras recovered from corners that an independent projection places, and refusals of views that hold too little.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "app/tools/calibration/report.hpp"
#include "app/tools/calibration/solve.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;

/// OpenCV's documented camera, written out: x' = x (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6) + 2 p1 xy + p2 (r2 +
/// 2 x2).
glm::dvec2 project(const CameraModel& camera, const glm::dvec3& p) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = (1 + k1 * r2 + k2 * r4 + k3 * r6) / (1 + k4 * r2 + k5 * r4 + k6 * r6);
  return {camera.cx_px + camera.fx_px * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)),
          camera.cy_px + camera.fy_px * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)};
}

/// A pose of the board: where its middle is and how it is tilted about the camera's x and y axes and turned about the line of
/// sight.
struct Placement {
  glm::dvec3 middle_m;
  glm::dvec3 turn_deg;
};

glm::dmat3 turned_about(int axis, double angle_deg) {
  const double angle = glm::radians(angle_deg);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  glm::dmat3 rotation(1);
  rotation[a][a] = rotation[b][b] = std::cos(angle);
  rotation[a][b] = std::sin(angle);
  rotation[b][a] = -std::sin(angle);
  return rotation;
}

/// A board of 9x6 corners, 25 mm apart, with Gaussian noise on each coordinate.
BoardView seen(const CameraModel& camera, const Placement& place, double noise_px, std::mt19937& random) {
  constexpr int kColumns = 9, kRows = 6;
  constexpr double kSquare_m = 0.025;
  std::normal_distribution<double> noise(0, 1);
  const glm::dmat3 turn =
      turned_about(0, place.turn_deg.x) * turned_about(1, place.turn_deg.y) * turned_about(2, place.turn_deg.z);
  BoardView view;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const glm::dvec2 point_m(kSquare_m * (i % kColumns), kSquare_m * (i / kColumns));
    const glm::dvec2 from_middle_m = point_m - kSquare_m * glm::dvec2(kColumns - 1, kRows - 1) / 2.0;
    const glm::dvec2 px = project(camera, turn * glm::dvec3(from_middle_m, 0) + place.middle_m);
    view.points_board_m.push_back(point_m);
    view.points_px.push_back(px + noise_px * glm::dvec2(noise(random), noise(random)));
  }
  return view;
}

std::vector<BoardView> seen_all(const CameraModel& camera, const std::vector<Placement>& places, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<BoardView> views;
  for (const Placement& place : places) {
    views.push_back(seen(camera, place, noise_px, random));
    views.back().frame = static_cast<std::int64_t>(views.size()) * 10;
  }
  return views;
}

/// Twelve views to several sides that fill a picture of 640x480 px at f = 520 px.
std::vector<Placement> good_places() {
  return {{{0, 0, 0.35}, {30, 0, 0}},          {{0, 0, 0.35}, {-30, 5, 20}},       {{0, 0, 0.3}, {0, 35, 0}},
          {{0, 0, 0.35}, {5, -35, 90}},        {{-0.1, -0.07, 0.35}, {20, 25, 0}}, {{0.1, -0.07, 0.35}, {20, -25, 10}},
          {{-0.1, 0.07, 0.35}, {-20, 25, 45}}, {{0.1, 0.07, 0.35}, {-20, -25, 0}}, {{0, 0, 0.6}, {40, 20, 0}},
          {{0.1, 0, 0.4}, {10, 45, 0}},        {{-0.1, 0, 0.4}, {-35, -15, 60}},   {{0, 0.05, 0.28}, {10, 10, 5}}};
}

CameraModel bare_camera() {
  return {640, 480, 520, 524, 331.2, 236.7, {}};
}

CameraModel barrel_camera() {
  return {640, 480, 520, 524, 331.2, 236.7, {-0.3, 0.12, 0.0015, -0.001}};
}

Calibration calibrated(const CameraModel& camera, double noise_px, LensModel most = LensModel::standard, unsigned seed = 1) {
  return solve_camera(seen_all(camera, good_places(), noise_px, seed), camera.width_px, camera.height_px, most);
}

TEST(Calibration, ExactCornersGiveTheExactCamera) {
  const CameraModel truth = barrel_camera();
  const Calibration result = calibrated(truth, 0);
  // OpenCV takes corners as 32-bit floats: 3e-5 px.
  EXPECT_NEAR(result.camera.fx_px, truth.fx_px, 1e-3);
  EXPECT_NEAR(result.camera.fy_px, truth.fy_px, 1e-3);
  EXPECT_NEAR(result.camera.cx_px, truth.cx_px, 1e-3);
  EXPECT_NEAR(result.camera.cy_px, truth.cy_px, 1e-3);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(result.camera.distortion[i], truth.distortion[i], 1e-4) << i;
  EXPECT_LT(result.rms_px, 1e-3);
  EXPECT_THAT(result.rejected, IsEmpty());
}

TEST(Calibration, NoiseMovesParametersByNoMoreThanIsStated) {
  const CameraModel truth = barrel_camera();
  constexpr double kNoisePx = 0.2, kDeviations = 4;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Calibration result = calibrated(truth, kNoisePx, LensModel::standard, seed);
    const CameraModel &found = result.camera, &deviation = result.deviation;
    EXPECT_NEAR(found.fx_px, truth.fx_px, kDeviations * deviation.fx_px);
    EXPECT_NEAR(found.fy_px, truth.fy_px, kDeviations * deviation.fy_px);
    EXPECT_NEAR(found.cx_px, truth.cx_px, kDeviations * deviation.cx_px);
    EXPECT_NEAR(found.cy_px, truth.cy_px, kDeviations * deviation.cy_px);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.distortion[i], truth.distortion[i], kDeviations * deviation.distortion[i]) << i;
    EXPECT_LT(deviation.fx_px, 1);                                // or the test would hold for anything
    EXPECT_NEAR(result.rms_px, kNoisePx * std::sqrt(2.0), 0.02);  // both coordinates
  }
}

TEST(Calibration, StatedDeviationsAreWhatRepeatedNoiseGives) {
  constexpr int kRepeats = 40;
  double sum = 0, sum_of_squares = 0, stated = 0;
  for (unsigned seed = 0; seed < kRepeats; ++seed) {
    const Calibration result = calibrated(bare_camera(), 0.2, LensModel::plain, seed);
    const double error = result.camera.fx_px - bare_camera().fx_px;
    sum += error;
    sum_of_squares += error * error;
    stated += result.deviation.fx_px / kRepeats;
  }
  const double scatter = std::sqrt((sum_of_squares - sum * sum / kRepeats) / (kRepeats - 1));
  // The scatter of 40 is itself known to 11 per cent; three times that.
  EXPECT_NEAR(scatter / stated, 1, 0.34);
  EXPECT_NEAR(sum / kRepeats, 0, 3 * stated / std::sqrt(kRepeats));
}

TEST(Calibration, CoefficientsThatTheViewsDoNotDetermineStayZero) {
  const Calibration bare = calibrated(bare_camera(), 0.2);
  EXPECT_EQ(bare.lens, LensModel::plain);
  EXPECT_FALSE(bare.camera.has_distortion());

  const Calibration barrel = calibrated(barrel_camera(), 0.2);
  EXPECT_EQ(barrel.lens, LensModel::four);
  EXPECT_EQ(barrel.camera.distortion[4], 0);
  EXPECT_EQ(barrel.deviation.distortion[4], 0);
  EXPECT_THAT(calibration_hints(barrel, LensModel::standard), Contains(HasSubstr("do not determine k3; what is left out is 0")));
}

TEST(Calibration, NoMoreThanTheModelAskedForIsFitted) {
  EXPECT_FALSE(calibrated(barrel_camera(), 0.1, LensModel::plain).camera.has_distortion());
  EXPECT_GT(calibrated(barrel_camera(), 0.1, LensModel::plain).rms_px, 0.5);
}

TEST(Calibration, RationalLensIsFoundWhereItIsAskedFor) {
  // A wide lens, r / (1 + r2/2), that no polynomial of three terms follows.
  const CameraModel truth{640, 480, 300, 300, 322, 239, {0, 0, 0.0005, -0.0004, 0, 0.5, 0, 0}};
  std::vector<Placement> places = good_places();
  for (Placement& place : places) place.middle_m.z *= 0.5;  // wide angle: closer
  const std::vector<BoardView> views = seen_all(truth, places, 0.05, 1);
  const Calibration polynomial = solve_camera(views, 640, 480, LensModel::standard);
  const Calibration rational = solve_camera(views, 640, 480, LensModel::rational);
  ASSERT_EQ(rational.lens, LensModel::rational);
  EXPECT_LT(rational.rms_px, 0.05 * std::sqrt(2.0) * 1.1);
  EXPECT_LT(rational.rms_px, polynomial.rms_px);
  // Its coefficients trade against each other; what they do to the picture does not.
  for (const double x : {-0.5, 0.0, 0.5})
    for (const double y : {-0.35, 0.0, 0.35})
      EXPECT_LT(glm::distance(project(rational.camera, {x, y, 1}), project(truth, {x, y, 1})), 0.3) << x << ", " << y;
}

TEST(Calibration, AnOutlierIsRejectedAndNamed) {
  std::vector<BoardView> views = seen_all(barrel_camera(), good_places(), 0.1, 1);
  std::mt19937 random(2);
  std::normal_distribution<double> blunder(0, 3);
  for (glm::dvec2& p : views[4].points_px) p += glm::dvec2(blunder(random), blunder(random));
  const Calibration result = solve_camera(views, 640, 480, LensModel::standard);
  ASSERT_EQ(result.rejected.size(), 1u);
  EXPECT_EQ(result.rejected[0].frame, 50);
  EXPECT_GT(result.rejected[0].rms_px, 1);
  EXPECT_EQ(result.views.size(), 11u);
  EXPECT_NEAR(result.camera.fx_px, 520, 4 * result.deviation.fx_px);
  EXPECT_THAT(calibration_text(result), ::testing::ContainsRegex(" 50 +- +[0-9.]+  rejected"));
}

TEST(Calibration, TiltIsTheAngleOfTheBoardsNormal) {
  const Calibration result = calibrated(bare_camera(), 0.05);
  EXPECT_NEAR(result.views[0].tilt_deg, 30, 0.2);
  EXPECT_NEAR(result.views[2].tilt_deg, 35, 0.2);
  // cos = cos 10 cos 45 for turns about x, then y.
  EXPECT_NEAR(result.views[9].tilt_deg, glm::degrees(std::acos(std::cos(glm::radians(10.0)) * std::cos(glm::radians(45.0)))),
              0.2);
}

// --- views that hold too little -------------------------------------------------------------------------------------------

std::string refusal(const std::vector<Placement>& places, const CameraModel& camera = barrel_camera(), unsigned seed = 1) {
  return message_of<Error>([&] { solve_camera(seen_all(camera, places, 0.1, seed), 640, 480, LensModel::standard); });
}

TEST(CalibrationRefusal, FewerThanFourViews) {
  std::vector<Placement> places = good_places();
  places.resize(3);
  EXPECT_THAT(refusal(places), HasSubstr("only 3 usable views"));
  EXPECT_THAT(refusal({}), HasSubstr("only 0 usable views"));
}

TEST(CalibrationRefusal, FewerThanFourViewsAfterOutliers) {
  std::vector<Placement> places = good_places();
  places.resize(4);
  std::vector<BoardView> views = seen_all(barrel_camera(), places, 0.05, 1);
  for (std::size_t i = 0; i < views[3].points_px.size(); i += 2) views[3].points_px[i] += glm::dvec2(8, -5);
  EXPECT_THAT(message_of<Error>([&] { solve_camera(views, 640, 480, LensModel::standard); }),
              HasSubstr("only 3 usable views of the board are left, 1 having been rejected"));
}

TEST(CalibrationRefusal, AllViewsFrontal) {
  std::vector<Placement> places;
  for (const double depth_m : {0.3, 0.35, 0.4, 0.5, 0.6, 0.7})
    for (const double turn_deg : {0.0, 45.0}) places.push_back({{depth_m / 10 - 0.04, 0.01, depth_m}, {0, 0, turn_deg}});
  for (const unsigned seed : {1u, 2u, 3u}) {
    EXPECT_THAT(refusal(places, bare_camera(), seed), HasSubstr("do not determine the focal length"));
    // The lens bends frontal boards so that they look tilted.
    EXPECT_THAT(refusal(places, barrel_camera(), seed), HasSubstr("do not determine the focal length"));
  }
}

TEST(CalibrationRefusal, TheSameViewOverAndOver) {
  EXPECT_THAT(refusal(std::vector<Placement>(12, {{0, 0, 0.35}, {25, 0, 0}})), HasSubstr("do not determine the focal length"));
}

// --- what the user is told ------------------------------------------------------------------------------------------------

TEST(CalibrationHints, NoneForGoodViewsOfTheRightModel) {
  EXPECT_THAT(calibration_hints(calibrated(barrel_camera(), 0.1, LensModel::four), LensModel::four), IsEmpty());
}

TEST(CalibrationHints, PartsOfThePictureWithoutABoardAreNamed) {
  std::vector<Placement> places = good_places();
  for (Placement& place : places) place.middle_m = {0.08, 0.05, 0.5};  // right of and below the middle
  const auto hints =
      calibration_hints(solve_camera(seen_all(bare_camera(), places, 0.1, 1), 640, 480, LensModel::plain), LensModel::plain);
  EXPECT_THAT(hints, Contains(HasSubstr("hardly seen in the picture's upper left, ")));
  for (const std::string& hint : hints) EXPECT_EQ(hint.find("lower right"), std::string::npos) << hint;
}

TEST(CalibrationHints, FlatAndFewViewsAreTold) {
  std::vector<Placement> places = good_places();
  places.resize(6);
  for (Placement& place : places) place.turn_deg *= 0.5;
  const auto hints =
      calibration_hints(solve_camera(seen_all(bare_camera(), places, 0.1, 1), 640, 480, LensModel::plain), LensModel::plain);
  EXPECT_THAT(hints, Contains(HasSubstr("only 6 frames are used")));
  EXPECT_THAT(hints, Contains(HasSubstr("never tilted more than 18 degrees")));
}

TEST(CalibrationHints, PixelsFarFromSquareAreDoubted) {
  CameraModel anamorphic = bare_camera();
  anamorphic.fy_px = 1.1 * anamorphic.fx_px;
  EXPECT_THAT(calibration_hints(calibrated(anamorphic, 0.1, LensModel::plain), LensModel::plain),
              Contains(HasSubstr("fx and fy differ by 9 %")));
}

TEST(CalibrationHints, ABoardThatIsNotAsDescribedIsSuspected) {
  std::vector<BoardView> views = seen_all(bare_camera(), good_places(), 0.1, 1);
  for (BoardView& view : views)
    for (glm::dvec2& p : view.points_board_m) p.x *= p.x > 0.1 ? 1.05 : 1;  // its right half is wider
  EXPECT_THAT(calibration_hints(solve_camera(views, 640, 480, LensModel::standard), LensModel::standard),
              Contains(HasSubstr("is the board flat, and are its sizes and spacing as printed?")));
}

TEST(CalibrationFile, IsReadBackToTheBit) {
  const tests::TemporaryFolder folder;
  for (const LensModel most : {LensModel::plain, LensModel::standard, LensModel::rational}) {
    const Calibration result = calibrated(barrel_camera(), 0.1, most);
    const CameraModel read = tracking::read_camera_file(folder.write("camera.yaml", camera_text(result, "camera.yaml")));
    EXPECT_EQ(read.width_px, 640);
    EXPECT_EQ(read.height_px, 480);
    EXPECT_EQ(read.fx_px, result.camera.fx_px);
    EXPECT_EQ(read.fy_px, result.camera.fy_px);
    EXPECT_EQ(read.cx_px, result.camera.cx_px);
    EXPECT_EQ(read.cy_px, result.camera.cy_px);
    EXPECT_EQ(read.distortion, result.camera.distortion);
    EXPECT_THAT(camera_text(result, "camera.yaml"), HasSubstr("avg_reprojection_error: "));
    for (const char* name : {"camera.json", "camera.xml"})
      EXPECT_EQ(tracking::read_camera_file(folder.write(name, camera_text(result, name))), result.camera) << name;
  }
}

TEST(CalibrationPicture, ShowsResidualsWhereTheyAreAndOutliersRed) {
  std::vector<BoardView> views = seen_all(barrel_camera(), good_places(), 0.1, 1);
  for (std::size_t i = 0; i < views[4].points_px.size(); i += 2) views[4].points_px[i] += glm::dvec2(8, -5);
  const Calibration result = solve_camera(views, 640, 480, LensModel::standard);
  const cv::Mat picture = calibration_picture(result);
  ASSERT_EQ(picture.cols, 1280);
  ASSERT_GT(picture.rows, 960);
  const glm::dvec2 corner = 2.0 * (result.views[0].view.points_px[0] + 0.5);  // twice as large as the frame
  EXPECT_NE(picture.at<cv::Vec3b>(cvRound(corner.y), cvRound(corner.x)), cv::Vec3b(255, 255, 255));
  int red = 0, blue = 0;
  for (int y = 970; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b p = picture.at<cv::Vec3b>(y, x);
      red += p[2] > 200 && p[1] < 100;
      blue += p[0] > 170 && p[2] < 120;
    }
  EXPECT_GT(red, 1000);
  EXPECT_GT(blue, 11 * 1000);
}

}  // namespace
}  // namespace catchlight::app
