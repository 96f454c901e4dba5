// What --debug draws is looked for in the finished frame, by its colours, where OpenCV's own projection says.
#include "app/session/debug_drawing.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tests/support/media_fixture.hpp"

#include <cstring>
#include <opencv2/calib3d.hpp>
#include <random>

namespace catchlight::app {
namespace {

using testing::noise_frame;
using testing::samples_of;

constexpr double kTag_m = 0.1;

/// Barrel distortion, strong: 20 to 30 px on the tag of `tilted()`.
CameraModel distorting_camera(int width_px = 640, int height_px = 480) {
  const double scale = std::min(width_px, height_px) / 480.0;
  CameraModel camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = 500 * scale;
  camera.cx_px = width_px / 2.0;
  camera.cy_px = height_px / 2.0;
  camera.distortion[0] = -0.3;
  return camera;
}

/// Facing the tag, tilted and turned; it covers much of the picture's lower right.
RigidTransform tilted() {
  cv::Matx33d facing, turn;
  cv::Rodrigues(cv::Vec3d(CV_PI, 0, 0), facing);  // the tag's z comes towards the camera, its y goes up
  cv::Rodrigues(cv::Vec3d(-0.6, 0.4, 0.3), turn);
  const cv::Matx33d rotation = turn * facing;
  RigidTransform camera_from_tag;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) camera_from_tag.rotation[column][row] = rotation(row, column);
  camera_from_tag.translation_m = {0.03, 0.04, 0.3};
  return camera_from_tag;
}

TrackRow tracked(const RigidTransform& camera_from_tag) {
  TrackRow row;
  row.frame = 7;
  row.found = true;
  row.state = TrackState::tracking;
  row.camera_from_tag = camera_from_tag;
  row.corner_sigma_px = 0.123;
  row.ambiguity = 0.45;
  return row;
}

TrackRow lost(std::int64_t frame = 7) {
  TrackRow row;
  row.frame = frame;
  return row;
}

Frame frame_of(FramePtr picture) {
  return {std::shared_ptr<const AVFrame>(std::move(picture)), 7, 0.25};
}

Frame gray_frame(int width_px = 640, int height_px = 480) {
  FramePtr picture = noise_frame(AV_PIX_FMT_RGB24, width_px, height_px, 1);
  std::memset(picture->buf[0]->data, 90, picture->buf[0]->size);
  return frame_of(std::move(picture));
}

/// The finished frame, RGB.
cv::Mat drawn(const Frame& frame, const TrackRow& row, const CameraModel& camera, Composite composite = {}) {
  draw_debug(frame, row, camera, kTag_m, composite);
  const Frame finished = frame.with_composite(composite);
  Plate plate = finished.rgb({0, 0, frame.width_px(), frame.height_px()});
  return cv::Mat(frame.height_px(), frame.width_px(), CV_8UC3, plate.pixels.data()).clone();
}

std::vector<cv::Point2d> opencv_px(const CameraModel& camera, const RigidTransform& pose,
                                   const std::vector<cv::Point3d>& points_m) {
  cv::Matx33d rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation(row, column) = pose.rotation[column][row];
  cv::Vec3d rotation_vector;
  cv::Rodrigues(rotation, rotation_vector);
  std::vector<cv::Point2d> px;
  cv::projectPoints(points_m, rotation_vector, cv::Vec3d(pose.translation_m.x, pose.translation_m.y, pose.translation_m.z),
                    cv::Matx33d(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1),
                    cv::Mat(1, 8, CV_64F, const_cast<double*>(camera.distortion.data())), px);
  return px;
}

const std::vector<cv::Point3d> kCorners_m{
    {-kTag_m / 2, -kTag_m / 2, 0}, {kTag_m / 2, -kTag_m / 2, 0}, {kTag_m / 2, kTag_m / 2, 0}, {-kTag_m / 2, kTag_m / 2, 0}};

/// The rectangle around all that is not as gray_frame() was.
cv::Rect drawn_bounds(const cv::Mat& picture) {
  cv::Mat difference, sum;
  cv::absdiff(picture, cv::Scalar::all(90), difference);
  cv::transform(difference, sum, cv::Matx13f(1, 1, 1));
  cv::Rect bounds;
  for (int y = 0; y < sum.rows; ++y)
    for (int x = 0; x < sum.cols; ++x)
      if (sum.at<std::uint8_t>(y, x)) bounds |= cv::Rect(x, y, 1, 1);
  return bounds;
}

/// How much of a pixel is magenta, 0 to 1.
double magenta(const cv::Vec3b& rgb) {
  return std::max(0, std::min<int>(rgb[0], rgb[2]) - rgb[1]) / 255.0;
}

/// The centre of what is magenta within `radius_px`.
cv::Point2d magenta_centre(const cv::Mat& picture, const cv::Point2d& near_px, int radius_px) {
  cv::Point2d sum(0, 0);
  double weight = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (cv::norm(cv::Point2d(x, y) - near_px) > radius_px) continue;
      const double share = magenta(picture.at<cv::Vec3b>(y, x));
      sum += share * cv::Point2d(x, y);
      weight += share;
    }
  return weight > 0 ? sum / weight : cv::Point2d(-1, -1);
}

double magenta_pixels(const cv::Mat& picture) {
  double sum = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) sum += magenta(picture.at<cv::Vec3b>(y, x));
  return sum;
}

/// The codes by which the strongest of the 3 x 3 pixels there has this channel above both others.
int dominance(const cv::Mat& picture, const cv::Point2d& px, int channel) {
  int best = -255;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const cv::Vec3b& rgb = picture.at<cv::Vec3b>(cvRound(px.y) + dy, cvRound(px.x) + dx);
      best = std::max(best, rgb[channel] - std::max(rgb[(channel + 1) % 3], rgb[(channel + 2) % 3]));
    }
  return best;
}

void expect_crosses_on_corners(const cv::Mat& picture, const CameraModel& camera) {
  const std::vector<cv::Point2d> corners_px = opencv_px(camera, tilted(), kCorners_m);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT(cv::norm(magenta_centre(picture, corners_px[i], 12) - corners_px[i]), 0.2) << "corner " << i;
}

TEST(DebugDrawing, CrossesAreOnTheCornersAsTheLensShowsThem) {
  const CameraModel camera = distorting_camera();
  expect_crosses_on_corners(drawn(gray_frame(), tracked(tilted()), camera), camera);
  CameraModel pinhole = camera;
  pinhole.distortion = {};
  const auto seen = opencv_px(camera, tilted(), kCorners_m), ideal = opencv_px(pinhole, tilted(), kCorners_m);
  EXPECT_GT(cv::norm(seen[0] - ideal[0]) + cv::norm(seen[1] - ideal[1]), 10) << "the lens matters here";
}

TEST(DebugDrawing, AxesAreRedGreenAndBlueFromTheMiddle) {
  const CameraModel camera = distorting_camera();
  const cv::Mat picture = drawn(gray_frame(), tracked(tilted()), camera);
  for (const double along_m : {0.4 * kTag_m, 0.25 * kTag_m, 0.48 * kTag_m}) {
    const auto px = opencv_px(camera, tilted(), {{along_m, 0, 0}, {0, along_m, 0}, {0, 0, along_m}});
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(dominance(picture, px[static_cast<std::size_t>(axis)], axis), 120);
  }
  const auto beyond = opencv_px(camera, tilted(), {{0.65 * kTag_m, 0, 0}, {0, 0.65 * kTag_m, 0}, {0, 0, 0.65 * kTag_m}});
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LE(dominance(picture, beyond[static_cast<std::size_t>(axis)], axis), 0) << "half a tag long";
}

/// Edges that the lens bends are drawn bent: a chord would miss the middle of the longest by several pixels.
TEST(DebugDrawing, OutlineFollowsTheBentEdges) {
  CameraModel camera = distorting_camera();
  camera.distortion[0] = -0.45;
  const cv::Mat picture = drawn(gray_frame(), tracked(tilted()), camera);
  const auto corners = opencv_px(camera, tilted(), kCorners_m);
  double bent_px = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const cv::Point2d middle_px = opencv_px(camera, tilted(), {(kCorners_m[i] + kCorners_m[(i + 1) % 4]) / 2.0})[0];
    bent_px = std::max(bent_px, cv::norm(middle_px - (corners[i] + corners[(i + 1) % 4]) / 2.0));
    int whitest = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const cv::Vec3b& rgb = picture.at<cv::Vec3b>(cvRound(middle_px.y) + dy, cvRound(middle_px.x) + dx);
        whitest = std::max<int>(whitest, std::min({rgb[0], rgb[1], rgb[2]}));
      }
    EXPECT_GT(whitest, 200) << "edge " << i;
  }
  EXPECT_GT(bent_px, 4) << "it is bent";
}

TEST(DebugDrawing, PortraitFootage) {
  const CameraModel camera = distorting_camera(480, 640);
  expect_crosses_on_corners(drawn(gray_frame(480, 640), tracked(tilted()), camera), camera);
}

/// 720 and 2160 lines: there, widths are hardly rounded.
TEST(DebugDrawing, IsAsLargeBesideThePictureAtEveryResolution) {
  double cross[2], text_height[2], text_width[2];
  for (int i = 0; i < 2; ++i) {
    const int width_px = i ? 2880 : 960, height_px = width_px * 3 / 4;
    const CameraModel camera = distorting_camera(width_px, height_px);
    const cv::Mat picture = drawn(gray_frame(width_px, height_px), tracked(tilted()), camera);
    const cv::Point2d corner = opencv_px(camera, tilted(), kCorners_m)[0];
    cross[i] = 0;
    for (int x = 0; x < width_px; ++x) cross[i] += magenta(picture.at<cv::Vec3b>(cvRound(corner.y), x)) / width_px;
    const cv::Rect text = drawn_bounds(drawn(gray_frame(width_px, height_px), lost(), camera));
    text_height[i] = static_cast<double>(text.height) / height_px;
    text_width[i] = static_cast<double>(text.width) / width_px;
  }
  EXPECT_NEAR(cross[1] / cross[0], 1, 0.1);
  EXPECT_NEAR(text_height[1] / text_height[0], 1, 0.1);
  EXPECT_NEAR(text_width[1] / text_width[0], 1, 0.1);
}

/// Where the drawing is not, every sample of every plane is the decoder's own.
TEST(DebugDrawing, UntouchedPixelsKeepTheDecodersSamples) {
  for (const AVPixelFormat format : {AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV444P10LE, AV_PIX_FMT_GBRP}) {
    const Frame frame = frame_of(noise_frame(format, 640, 480, 5));
    Composite composite;
    draw_debug(frame, tracked(tilted()), distorting_camera(), kTag_m, composite);
    const Frame finished = frame.with_composite(composite);
    const auto before = samples_of(frame.picture()), after = samples_of(finished.picture());
    ASSERT_EQ(before.size(), after.size());
    const std::size_t bytes = before.size() / (3 * 640 * 480);
    std::size_t touched = 0, changed = 0;
    for (std::size_t i = 0; i < before.size() / bytes; ++i) {
      const int x = static_cast<int>(i % 640), y = static_cast<int>(i / 640 % 480);
      const bool is_touched =
          !intersect(composite.rect, {x, y, 1, 1}).empty() &&
          composite
                  .rgba[4 * static_cast<std::size_t>((y - composite.rect.y) * composite.rect.width + x - composite.rect.x) + 3] ==
              1.0f;
      const bool is_changed = std::memcmp(&before[i * bytes], &after[i * bytes], bytes) != 0;
      touched += is_touched;
      changed += is_changed;
      EXPECT_TRUE(is_touched || !is_changed) << "at " << x << ' ' << y;
    }
    EXPECT_GT(changed, 3000u);
    EXPECT_LT(touched, before.size() / bytes / 12) << "lines and text, not their rectangle";
  }
}

TEST(DebugDrawing, LostFrameShowsItsTextAndNothingElse) {
  const cv::Mat picture = drawn(gray_frame(), lost(), distorting_camera());
  int changed = 0, reddish = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& rgb = picture.at<cv::Vec3b>(y, x);
      if (rgb == cv::Vec3b(90, 90, 90)) continue;
      ++changed;
      reddish += rgb[0] > rgb[1] + 50 && rgb[0] > rgb[2] + 50;
      EXPECT_TRUE(x < 200 && y < 40) << x << ' ' << y;
    }
  EXPECT_GT(changed, 300);
  EXPECT_GT(reddish, 100);
  EXPECT_EQ(magenta_pixels(picture), 0);
}

TEST(DebugDrawing, TextTellsFrameStateResidualAndAmbiguity) {
  const Frame frame = gray_frame();
  const auto text = [&](const TrackRow& row) { return drawn(frame, row, distorting_camera())(cv::Rect(0, 0, 600, 60)).clone(); };
  const TrackRow row = tracked(tilted());
  TrackRow other_frame = row, coasting = row, other_residual = row, other_ambiguity = row;
  other_frame.frame = 8;
  coasting.state = TrackState::coasting;
  other_residual.corner_sigma_px = 0.124;
  other_ambiguity.ambiguity = 0.46;
  EXPECT_EQ(cv::norm(text(row), text(row), cv::NORM_INF), 0);
  for (const TrackRow& other : {other_frame, coasting, other_residual, other_ambiguity, lost()})
    EXPECT_GT(cv::norm(text(row), text(other), cv::NORM_INF), 100);
}

/// What the compositor changed stays to the bit, where nothing is drawn on it.
TEST(DebugDrawing, TheCompositeUnderItStays) {
  std::mt19937 random(3);
  Composite composite;
  composite.rect = {300, 200, 101, 57};
  for (int i = 0; i < 101 * 57 * 4; ++i)
    composite.rgba.push_back(i % 4 == 3 ? static_cast<float>(random() % 2) : 0.001f * (random() % 1000));
  Composite over = composite;
  draw_debug(gray_frame(), lost(), distorting_camera(), kTag_m, over);
  EXPECT_EQ(unite(over.rect, composite.rect), over.rect);
  for (int y = 0; y < 57; ++y)
    EXPECT_EQ(
        std::memcmp(&composite.rgba[static_cast<std::size_t>(4 * 101 * y)],
                    &over.rgba[static_cast<std::size_t>(4 * ((200 - over.rect.y + y) * over.rect.width + 300 - over.rect.x))],
                    4 * 101 * sizeof(float)),
        0)
        << "row " << y;
}

/// k1 alone turns back at 1/sqrt(-3 k1) = 1.05: a point beyond would appear well inside the picture.
TEST(DebugDrawing, PointsBeyondTheLensModelDoNotFoldBackIntoThePicture) {
  CameraModel camera = distorting_camera();
  camera.fx_px = camera.fy_px = 300;
  RigidTransform aside;
  aside.translation_m = {0.8, 0, 0.5};
  const auto folded = opencv_px(camera, aside, kCorners_m);
  ASSERT_TRUE(folded[0].x > 0 && folded[0].x < 640 && folded[0].y > 0 && folded[0].y < 480) << folded[0];
  EXPECT_EQ(magenta_pixels(drawn(gray_frame(), tracked(aside), camera)), 0);
}

TEST(DebugDrawing, TagsBehindAroundAndAcrossTheEdgeOfThePicture) {
  for (const glm::dvec3& position_m : {glm::dvec3(0, 0, -0.5), glm::dvec3(0, 0, 0.001), glm::dvec3(0.2, 0, 0.3),
                                       glm::dvec3(-3, 2, 1e-9), glm::dvec3(0, 0, 1e6)}) {
    RigidTransform pose = tilted();
    pose.translation_m = position_m;
    CameraModel pinhole = distorting_camera();
    pinhole.distortion = {};
    for (const CameraModel& camera : {distorting_camera(), pinhole}) {
      const cv::Mat picture = drawn(gray_frame(), tracked(pose), camera);
      EXPECT_TRUE(drawn_bounds(picture).contains({10, 12})) << "the text is there";
    }
  }
}

TEST(DebugDrawing, TinyFrames) {
  for (const int size_px : {8, 33, 64}) {
    const cv::Mat picture = drawn(gray_frame(size_px, size_px), lost(123456), distorting_camera(size_px, size_px));
    EXPECT_FALSE(drawn_bounds(picture).empty()) << size_px;
  }
}

class DeepFormat : public ::testing::TestWithParam<AVPixelFormat> {};

TEST_P(DeepFormat, IsDrawnInItsOwnCodes) {
  const Frame frame = frame_of(noise_frame(GetParam(), 640, 480, 9));
  Composite composite;
  draw_debug(frame, tracked(tilted()), distorting_camera(), kTag_m, composite);
  const cv::Point2d corner = opencv_px(distorting_camera(), tilted(), kCorners_m)[0];
  const auto at = 4 * static_cast<std::size_t>((cvRound(corner.y) - composite.rect.y) * composite.rect.width + cvRound(corner.x) -
                                               composite.rect.x);
  EXPECT_EQ(composite.rgba[at + 3], 1);
  EXPECT_GT(composite.rgba[at], composite.rgba[at + 1] + 0.5f);
  EXPECT_NE(samples_of(frame.with_composite(composite).picture()), samples_of(frame.picture()));
}

INSTANTIATE_TEST_SUITE_P(DebugDrawing, DeepFormat,
                         ::testing::Values(AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10LE, AV_PIX_FMT_RGB48LE, AV_PIX_FMT_GBRPF32LE,
                                           AV_PIX_FMT_GRAY8));

}  // namespace
}  // namespace catchlight::app
