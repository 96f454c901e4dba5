#include "app/tools/probe_merge/merge.hpp"
#include "app/tools/probe_merge/orientation.hpp"
#include "app/tools/probe_merge/photographs.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "render/image/image_io.hpp"
#include "tests/support/ball_photograph.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::BallScene;

constexpr double kPi = glm::pi<double>();
const std::vector<double> kTimes{4, 1, 0.25, 1.0 / 16, 1.0 / 64, 1.0 / 256};

double luminance(const glm::dvec3& rgb) {
  return glm::dot(kLuminanceWeights, rgb);
}

render::Probe probe_of(const tests::Environment& environment, int width = 256) {
  render::Probe probe{Image(width, width / 2), render::ProbeLayout::latlong};
  for (int y = 0; y < probe.image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 value = environment(*render::direction_from_texel(probe.layout, width, width / 2, x, y));
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = static_cast<float>(value[c]);
    }
  return probe;
}

/// RMS of the coefficients' differences over the RMS of the truth's, after the best common factor (a probe's scale is free).
double sh_error(const render::Probe& found, const render::Probe& truth, int bands) {
  const render::ShRgb a = render::project_to_sh(found, bands), b = render::project_to_sh(truth, bands);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += glm::dot(glm::dvec3(a[i]), glm::dvec3(b[i]));
    aa += glm::dot(glm::dvec3(a[i]), glm::dvec3(a[i]));
    bb += glm::dot(glm::dvec3(b[i]), glm::dvec3(b[i]));
  }
  return std::sqrt(std::max(0.0, 1 - ab * ab / (aa * bb)));
}

/// Median of |log2(found / truth)| of luminance over the sphere's directions that `counts`, after the median factor.
template <class Counts>
double median_error_ev(const render::Probe& found, const tests::Environment& truth, Counts counts) {
  std::vector<double> ratios;
  for (int i = 0; i < 4000; ++i) {  // a spiral of even steps in height
    const double y = 1 - (2 * i + 1) / 4000.0, around = 2.399963 * i, across = std::sqrt(1 - y * y);
    const glm::dvec3 direction(across * std::cos(around), y, across * std::sin(around));
    if (counts(direction))
      ratios.push_back(std::log2(luminance(glm::dvec3(render::sample(found, direction))) / luminance(truth(direction))));
  }
  std::sort(ratios.begin(), ratios.end());
  const double middle = ratios[ratios.size() / 2];
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

struct ProbeMerge : testing::Test {
  tests::TemporaryFolder folder;
  Log log;

  ProbeMerge() { log.set_quiet(true); }

  std::string all_warnings() const {
    std::string text;
    for (const std::string& warning : log.warnings()) text += warning + "\n";
    return text;
  }

  std::string write_exr(const std::string& name, const Image& image) {
    render::write_exr(folder.path(name), {{"", &image, {"R", "G", "B"}, true}});
    return folder.path(name);
  }

  /// The file of a camera 1 m from the ball at that yaw.
  std::string write_view(const std::string& name, double yaw_deg, double photographer_rad = 0) {
    BallScene scene;
    scene.radius_m = 0.15;
    scene.probe_from_camera = probe_from_camera(yaw_deg, 0);
    scene.photographer_rad = photographer_rad;
    return write_exr(name, tests::photograph(scene));
  }

  /// With the ball's outline as the camera of write_view() sees it: half-angle asin 0.15.
  MergeRequest request(const std::vector<std::vector<std::string>>& views) const {
    MergeRequest request;
    request.views = views;
    request.fov_deg = 2 * glm::degrees(std::atan(400.0 / 1000));
    const double radius_px = 1000 * std::tan(std::asin(0.15));
    request.balls.assign(views.size(), {{399.5, 299.5}, radius_px});
    request.width_px = 256;
    return request;
  }
};

TEST_F(ProbeMerge, RecoversTheResponseOfAFilmItWasNotTold) {
  const Image radiance = tests::photograph(BallScene{});
  const auto files = tests::write_bracket(radiance, kTimes, 0.7, folder.path("p"));
  const auto bracket = std::get<Bracket>(read_view(files, kTimes));
  const LightOfCodes curves = recover_response(bracket);
  for (int c = 0; c < 3; ++c)
    for (int code = 16; code <= 240; code += 8) {
      const double truth = tests::film_light(code / 255.0) / tests::film_light(128 / 255.0);
      EXPECT_NEAR(std::log2(curves[c][code] / truth), 0, 0.08) << "code " << code << ", channel " << c;
    }
}

/// Every stop from 1/4 of the longest exposure's darkest usable code to the shortest's white, in one ramp.
TEST_F(ProbeMerge, RadianceIsRightOverFourteenStops) {
  Image ramp(1400, 40);
  for (int y = 0; y < ramp.height; ++y)
    for (int x = 0; x < ramp.width; ++x)
      for (int c = 0; c < 3; ++c) ramp.pixel(x, y)[c] = static_cast<float>(std::exp2(-6.5 + x / 100.0));
  const auto files = tests::write_bracket(ramp, kTimes, 0.7, folder.path("p"));
  const auto bracket = std::get<Bracket>(read_view(files, kTimes));
  const RadianceMap map = merge_bracket(bracket, recover_response(bracket));
  const double scale = map.image.pixel(650, 20)[1] / ramp.pixel(650, 20)[1];
  for (int stop = 0; stop < 14; ++stop) {
    double sum = 0;
    for (int y = 0; y < ramp.height; ++y)
      for (int x = 100 * stop; x < 100 * (stop + 1); ++x)
        sum += std::pow(map.image.pixel(x, y)[1] / (scale * ramp.pixel(x, y)[1]) - 1, 2);
    const double rms = std::sqrt(sum / (100 * ramp.height));
    EXPECT_LT(rms, 0.06) << stop - 6.5 << " EV";
    RecordProperty("rms_percent_stop_" + std::to_string(stop), std::to_string(100 * rms));
  }
  EXPECT_EQ(map.clipped_share, 0);
}

TEST_F(ProbeMerge, MarksWhatIsWhiteInTheShortestPhotographAndKeepsItsLowerBound) {
  Image picture(64, 64);
  std::fill(picture.data.begin(), picture.data.end(), 0.2f);
  for (int c = 0; c < 3; ++c) picture.pixel(10, 20)[c] = 5000;  // the shortest holds 4
  const std::vector<double> times{1, 0.25};
  const auto bracket = std::get<Bracket>(read_view(tests::write_bracket(picture, times, 0, folder.path("p")), times));
  const RadianceMap map = merge_bracket(bracket, known_response(TransferFunction::linear, 255));
  EXPECT_DOUBLE_EQ(map.clipped_share, 1.0 / (64 * 64));
  EXPECT_TRUE(map.clipped[20 * 64 + 10]);
  EXPECT_FLOAT_EQ(map.image.pixel(10, 20)[0], 4);
}

/// sight() is the inverse of what the test's own rays do.
TEST(BallViewTest, FindsWhereEachRayWasMirrored) {
  const CameraModel camera = tests::ball_camera();
  const glm::dvec3 centre(0.12, -0.08, 0.9);
  const double radius = 0.11, half_angle = std::asin(radius / glm::length(centre));
  std::vector<glm::dvec2> outline;
  const glm::dvec3 axis = glm::normalize(centre), side = glm::normalize(glm::cross(axis, glm::dvec3(0, 1, 0)));
  for (int i = 0; i < 40; ++i) {
    const double turn = 2 * kPi * i / 40;
    const glm::dvec3 across = std::cos(turn) * side + std::sin(turn) * glm::cross(axis, side);
    const glm::dvec3 ray = std::cos(half_angle) * axis + std::sin(half_angle) * across;
    outline.emplace_back(camera.fx_px * ray.x / ray.z + camera.cx_px, camera.fy_px * ray.y / ray.z + camera.cy_px);
  }
  const BallView ball = BallView::perspective(camera, outline);
  EXPECT_NEAR(ball.distance_radii(), glm::length(centre) / radius, 1e-9);
  int seen = 0;
  for (int y = 0; y < camera.height_px; y += 7)
    for (int x = 0; x < camera.width_px; x += 7) {
      const glm::dvec3 ray = glm::normalize(glm::dvec3((x - camera.cx_px) / 1000, (y - camera.cy_px) / 1000, 1));
      const double along = glm::dot(ray, centre), inside = along * along - glm::dot(centre, centre) + radius * radius;
      if (inside < 0) continue;
      const glm::dvec3 normal = ((along - std::sqrt(inside)) * ray - centre) / radius;
      const BallSight sight = ball.sight(ray - 2 * glm::dot(ray, normal) * normal);
      if (sight.is_behind) continue;
      EXPECT_NEAR(sight.px.x, x, 1e-6);
      EXPECT_NEAR(sight.px.y, y, 1e-6);
      ++seen;
    }
  EXPECT_GT(seen, 500);
}

/// The mirror-ball layout is a photograph from afar: both mappings agree.
TEST(BallViewTest, FromAfarIsTheMirrorBallLayout) {
  const BallView ball = BallView::orthographic(outline_of({{255.5, 255.5}, 256}));
  const glm::dmat3 camera_from_probe = glm::transpose(probe_from_camera(0, 0));
  for (int i = 0; i < 200; ++i) {
    const double y = 0.98 - 1.96 * i / 199.0, around = 2.4 * i, across = std::sqrt(1 - y * y);
    const glm::dvec3 direction(across * std::cos(around), y, across * std::sin(around));
    const BallSight sight = ball.sight(camera_from_probe * direction);
    if (sight.is_behind) continue;
    const glm::dvec2 there = render::texel_from_direction(render::ProbeLayout::mirror_ball, 512, 512, direction);
    EXPECT_NEAR(glm::distance(sight.px, there), 0, 1e-9);
  }
}

TEST(BallViewTest, FindsTheOutlineOfABallAwayFromTheMiddle) {
  BallScene scene;
  scene.centre_camera_m = {0.15, 0.08, 0.8};
  scene.radius_m = 0.1;
  const auto outline = find_ball_outline(tests::photograph(scene), scene.camera, "ball");
  const BallView ball = BallView::perspective(scene.camera, outline);
  // A tenth of a pixel of the radius of 125.
  EXPECT_NEAR(ball.distance_radii() / (glm::length(scene.centre_camera_m) / 0.1), 1, 0.004);
  const glm::dvec3 towards = -glm::normalize(scene.centre_camera_m);
  EXPECT_NEAR(ball.sight(towards).from_camera_rad, 0, 0.001);
}

TEST_F(ProbeMerge, OneViewGivesTheLightButForWhatTheBallHides) {
  const render::Probe probe = merge_probe(request({{write_view("a.exr", 0)}}), log);
  const glm::dvec3 hidden(0, 0, -1);
  const auto is_seen = [&](const glm::dvec3& d) { return glm::dot(d, hidden) < std::cos(glm::radians(25.0)); };
  EXPECT_LT(median_error_ev(probe, tests::room, is_seen), 0.02);
  EXPECT_LT(sh_error(probe, probe_of(tests::room), 3), 0.02);  // 2 % of the sphere is hidden
  EXPECT_THAT(all_warnings(), HasSubstr("a second view from 90 to 120 degrees"));
}

TEST_F(ProbeMerge, TwoViewsRemoveThePhotographer) {
  constexpr double kPersonRad = 0.3;
  const auto one = merge_probe(request({{write_view("a.exr", 0, kPersonRad)}}), log);
  MergeRequest both = request({{write_view("a.exr", 0, kPersonRad)}, {write_view("b.exr", 100, kPersonRad)}});
  both.view_yaw_deg = {0, 100};
  const render::Probe two = merge_probe(both, log);
  const auto magenta = [](const render::Probe& probe, const glm::dvec3& direction) {
    const glm::vec3 rgb = render::sample(probe, direction);
    return rgb.r / rgb.g;
  };
  for (const double yaw_deg : {0.0, 100.0}) {
    const glm::dvec3 towards_camera(std::sin(glm::radians(yaw_deg)), 0, std::cos(glm::radians(yaw_deg)));
    const glm::dvec3 truth = tests::room(towards_camera);
    EXPECT_NEAR(magenta(two, towards_camera) / (truth.r / truth.g), 1, 0.02) << yaw_deg;
  }
  EXPECT_GT(magenta(one, {0, 0, 1}), 100);
  EXPECT_LT(median_error_ev(two, tests::room, [](const glm::dvec3&) { return true; }), 0.02);
  EXPECT_LT(sh_error(two, probe_of(tests::room), 5), 0.01);
}

/// The second view's exposure was noted wrongly by 1.5 EV; what both see tells.
TEST_F(ProbeMerge, ViewsOfDifferentExposureAreMatched) {
  BallScene scene;
  scene.radius_m = 0.15;
  scene.probe_from_camera = probe_from_camera(100, 0);
  Image darker = tests::photograph(scene);
  for (float& value : darker.data) value *= static_cast<float>(std::exp2(-1.5));
  MergeRequest both = request({{write_view("a.exr", 0)}, {write_exr("b.exr", darker)}});
  both.view_yaw_deg = {0, 100};
  const render::Probe probe = merge_probe(both, log);
  EXPECT_LT(sh_error(probe, probe_of(tests::room), 5), 0.01);
  EXPECT_THAT(all_warnings(), HasSubstr("1.50 EV apart"));
}

/// From JPEG-like codes to a probe in the tag's frame, nothing known but the times, the lens and the tag's size.
struct BallBesideTag : ProbeMerge {
  TagTarget tag;
  std::vector<double> times{1, 0.25, 1.0 / 16, 1.0 / 64, 1.0 / 256};

  /// The tag lies flat on a table; the ball stands beside it; the camera looks down at both from `yaw_deg` about the tag's z.
  std::vector<std::string> write_photographs(double yaw_deg, const std::string& name) {
    BallScene scene;
    const double yaw = glm::radians(yaw_deg), down = glm::radians(35.0);
    const glm::dvec3 forward(-std::sin(yaw) * std::cos(down), std::cos(yaw) * std::cos(down),
                             -std::sin(down));  // in the tag frame
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    const glm::dmat3 camera_from_tag = glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
    const glm::dvec3 looked_at(0.0, 0.0, 0.04);
    scene.camera_from_tag = RigidTransform{camera_from_tag, -(camera_from_tag * (looked_at - 0.7 * forward))};
    scene.tag = tag;
    scene.radius_m = 0.075;
    scene.centre_camera_m = *scene.camera_from_tag * (0.16 * right + glm::dvec3(0, 0, 0.1));
    scene.probe_from_camera = glm::transpose(render::tag_from_probe(render::UpAxis::z, 0)) * glm::transpose(camera_from_tag);
    scene.photographer_rad = 0.2;
    return tests::write_bracket(tests::photograph(scene), times, 0.7, folder.path(name));
  }
};

TEST_F(BallBesideTag, GivesTheProbeInTheTagsFrame) {
  MergeRequest request;
  request.views = {write_photographs(0, "a"), write_photographs(110, "b")};
  request.times_s = times;
  request.fov_deg = 2 * glm::degrees(std::atan(400.0 / 1000));
  request.tag = tag;
  request.width_px = 256;
  const render::Probe probe = merge_probe(request, log);
  EXPECT_LT(sh_error(probe, probe_of(tests::room), 5), 0.03);
  EXPECT_LT(median_error_ev(probe, tests::room, [](const glm::dvec3&) { return true; }), 0.06);

  // Where the small lamp is, by its light's middle.
  glm::dvec3 sum(0), lamp = glm::normalize(glm::dvec3(-0.5, 1, 0.6));
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 256; ++x) {
      const glm::dvec3 direction = *render::direction_from_texel(probe.layout, 256, 128, x, y);
      const double value = luminance(glm::dvec3(render::sample(probe, direction)));
      if (glm::dot(direction, lamp) > std::cos(glm::radians(20.0)))
        sum += direction * value * value * render::texel_solid_angle(probe.layout, 256, 128, x, y);
    }
  const double error_deg = glm::degrees(std::acos(glm::dot(glm::normalize(sum), lamp)));
  RecordProperty("lamp_error_deg", std::to_string(error_deg));
  EXPECT_LT(error_deg, 1.0);
}

TEST_F(BallBesideTag, NamesThePhotographWithoutATag) {
  MergeRequest request;
  request.views = {write_photographs(0, "a")};
  request.times_s = times;
  request.fov_deg = 40;
  request.tag = tag;
  request.tag->id = 7;
  EXPECT_THAT(tests::message_of<Error>([&] { merge_probe(request, log); }),
              testing::AllOf(HasSubstr("a0.png"), HasSubstr("tag36h11, id 7"), HasSubstr("was not found")));
}

// --- bad input -----------------------------------------------------------------------------------------------------------

struct BadPhotographs : ProbeMerge {
  std::string png(const std::string& name, int width, int depth = CV_8U) {
    cv::imwrite(folder.path(name), cv::Mat(64, width, CV_MAKETYPE(depth, 3), cv::Scalar::all(90)));
    return folder.path(name);
  }
  std::string error_of(const std::vector<std::string>& files, const std::vector<double>& times_s) {
    return tests::message_of<Error>([&] { read_view(files, times_s); });
  }
};

TEST_F(BadPhotographs, AreNamed) {
  const std::string a = png("a.png", 64), small = png("small.png", 32), deep = png("deep.png", 64, CV_16U);
  EXPECT_THAT(error_of({"/nowhere/a.jpg"}, {}), HasSubstr("/nowhere/a.jpg"));
  EXPECT_THAT(error_of({folder.path()}, {}), HasSubstr(folder.path()));
  EXPECT_THAT(error_of({folder.write("text.jpg", "no picture")}, {}), HasSubstr("text.jpg: cannot be read"));
  EXPECT_THAT(error_of({a, small}, {1, 0.25}), testing::AllOf(HasSubstr("small.png: is 32 x 64"), HasSubstr("64 x 64")));
  EXPECT_THAT(error_of({a, deep}, {1, 0.25}), HasSubstr("16 bits"));
  EXPECT_THAT(error_of({a, a}, {1, 1}), HasSubstr("same exposure"));
  EXPECT_THAT(error_of({a, a}, {}), testing::AllOf(HasSubstr("a.png"), HasSubstr("--times")));
  const std::string linear = write_exr("linear.exr", Image(8, 8));
  EXPECT_THAT(error_of({a, linear}, {1, 0.25}), HasSubstr("linear.exr: is scene-linear already"));
}

TEST_F(BadPhotographs, TruncatedPngIsNamed) {
  const std::string whole = tests::read_text(png("a.png", 64));
  EXPECT_THAT(error_of({folder.write("half.png", whole.substr(0, 20))}, {}), HasSubstr("half.png"));
}

TEST_F(BadPhotographs, TimesAreReadAsPhotographersWriteThem) {
  EXPECT_THAT(exposure_times_from_text("1/1000,0.5,2"), testing::ElementsAre(0.001, 0.5, 2));
  for (const char* text : {"", "1/0", "0", "-1", "1/2/3", "fast", "1,,2", "inf"})
    EXPECT_THAT(tests::message_of<UsageError>([&] { exposure_times_from_text(text); }), HasSubstr("--times")) << text;
}

/// The times are in the wrong order: no response explains the codes.
TEST_F(BadPhotographs, TimesThatCannotBeAreNoticed) {
  const auto files = tests::write_bracket(tests::photograph(BallScene{}), {1, 0.25, 1.0 / 16}, 0.7, folder.path("p"));
  const auto bracket = std::get<Bracket>(read_view(files, {1.0 / 16, 0.25, 1}));
  EXPECT_THAT(tests::message_of<Error>([&] { recover_response(bracket); }), HasSubstr("exposure times right"));
}

TEST_F(BadPhotographs, PictureWithoutABallAsksForIt) {
  MergeRequest plain;
  plain.views = {{png("a.png", 64)}};
  EXPECT_THAT(tests::message_of<Error>([&] { merge_probe(plain, log); }),
              testing::AllOf(HasSubstr("a.png"), HasSubstr("--ball")));
  plain.balls = {{{32, 32}, 60}};
  EXPECT_THAT(tests::message_of<UsageError>([&] { merge_probe(plain, log); }), HasSubstr("does not lie in the picture"));
}

TEST_F(BadPhotographs, RequestsThatContradictThemselvesAreRefused) {
  const std::string a = png("a.png", 64);
  const auto refused = [&](const MergeRequest& request) {
    return tests::message_of<UsageError>([&] { merge_probe(request, log); });
  };
  EXPECT_THAT(refused({}), HasSubstr("no photographs"));
  MergeRequest views;
  views.views = {{a}, {a}};
  EXPECT_THAT(refused(views), HasSubstr("--view-yaw for each"));
  views.view_yaw_deg = {0};
  EXPECT_THAT(refused(views), HasSubstr("--view-yaw is given for 1 views, but there are 2"));
  MergeRequest tag;
  tag.views = {{a}};
  tag.tag = TagTarget{};
  EXPECT_THAT(refused(tag), HasSubstr("--camera FILE or --fov"));
  tag.view_yaw_deg = {0};
  EXPECT_THAT(refused(tag), HasSubstr("stand for a tag"));
}

/// A black picture of a ball is a black probe, not a crash.
TEST_F(BadPhotographs, BlackPictureGivesABlackProbe) {
  const Image black(64, 64);
  MergeRequest request;
  request.views = {{write_exr("black.exr", black)}};
  request.balls = {{{31.5, 31.5}, 30}};
  for (const float value : merge_probe(request, log).image.data) ASSERT_EQ(value, 0.0f);
}

}  // namespace
}  // namespace catchlight::app
