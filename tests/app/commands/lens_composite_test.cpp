// The noise and the blur of what was drawn against the footage's own, measured on what the program wrote.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "catchlight/camera.hpp"
#include "catchlight/color.hpp"
#include "catchlight/image.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

constexpr double kTag_m = 0.08, kPxPerM = 1500, kTurn_deg = 6;  // edges cross pixels at every share
const glm::dvec2 kCenter_px(125, 150);

constexpr const char* kCamera = R"(%YAML:1.0
---
image_width: 400
image_height: 300
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 600., 0., 199.5, 0., 600., 149.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 0., 0., 0., 0., 0. ]
)";

/// A scene in light of 1 from everywhere: white paper of 0.8 is footage of 0.6.
constexpr const char* kScene = R"(
[tag]
family = "tag36h11"
id = 5
size_m = 0.08
white_albedo = 0.8
black_albedo = 0.04
[[object]]
mesh = "slab.obj"
[receiver]
plane = "none"
[probe]
image = "probe.exr"
layout = "latlong"
up = "z"
[exposure]
mode = "match"
)";

/// Beside the tag, its sides parallel to the tag's: dark on the left, light on the right.
constexpr const char* kSlab = R"(mtllib slab.mtl
v 0.06 -0.04 0.00001
v 0.09 -0.04 0.00001
v 0.13 -0.04 0.00001
v 0.06 0.04 0.00001
v 0.09 0.04 0.00001
v 0.13 0.04 0.00001
vn 0 0 1
usemtl dark
f 1//1 2//1 5//1 4//1
usemtl light
f 2//1 3//1 6//1 5//1
)";
constexpr const char* kMaterials = "newmtl dark\nKd 0.12 0.12 0.12\nKs 0 0 0\nnewmtl light\nKd 0.6 0.6 0.6\nKs 0 0 0\n";

/// A point of the tag's plane while the tag is `shift_px` from where it starts.
glm::dvec2 seen_px(const glm::dvec2& point_m, const glm::dvec2& shift_px) {
  const double c = std::cos(glm::radians(kTurn_deg)), s = std::sin(glm::radians(kTurn_deg));
  const glm::dvec2 p = kPxPerM * glm::dvec2(point_m.x, -point_m.y);
  return kCenter_px + shift_px + glm::dvec2(c * p.x - s * p.y, s * p.x + c * p.y);
}

/// The tag on a large sheet, drawn once at twice the frame's size; frames are cut out of it.
class Sheet {
 public:
  explicit Sheet(double blur_px) {
    const CameraModel fine{800, 600, 1200, 1200, 399.5, 299.5, {}};
    tracking::SyntheticScene scene{fine, {}};
    const glm::dvec2 center = 2.0 * kCenter_px + 0.5;
    scene.tags = {{{{"tag36h11", 5, kTag_m}, {}}, tracking::tag_pose(fine, center, 0.4, {0, 0, kTurn_deg})}};
    scene.white_linear = 0.6, scene.black_linear = 0.03, scene.paper_margin_cells = 4;
    scene.blur_px = 2 * blur_px;
    cv::Mat1f(600, 800, tracking::render(scene).linear.data()).copyTo(light_);
  }

  /// Light of a frame, the sheet `shift_px` from where it is drawn.
  cv::Mat1f at(const glm::dvec2& shift_px) const {
    const cv::Matx23d move(1, 0, 2 * shift_px.x, 0, 1, 2 * shift_px.y);
    cv::Mat1f moved, frame;
    cv::warpAffine(light_, moved, move, light_.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::resize(moved, frame, {400, 300}, 0, 0, cv::INTER_AREA);
    return frame;
  }

 private:
  cv::Mat1f light_;
};

/// 8-bit sRGB with noise of variance slope * light, in each channel by itself.
cv::Mat3b exposed(const cv::Mat1f& light, double slope, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  cv::Mat3b picture(light.size());
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        const double noisy = light(y, x) + std::sqrt(slope * light(y, x)) * normal(random);
        picture(y, x)[c] = cv::saturate_cast<std::uint8_t>(255 * srgb_from_linear(std::clamp(noisy, 0.0, 1.0)));
      }
  return picture;
}

cv::Mat3d linear(const cv::Mat3b& codes) {
  cv::Mat3d light(codes.size());
  for (int y = 0; y < codes.rows; ++y)
    for (int x = 0; x < codes.cols; ++x)
      for (int c = 0; c < 3; ++c) light(y, x)[c] = linear_from_srgb(codes(y, x)[c] / 255.0);
  return light;
}

/// Sums over tiles of 8 x 8 pixels, each less its mean.
struct Grain {
  cv::Vec4d squares;  ///< sums of squares of blue, green, red and luma
  double light = 0, neighbours = 0;

  void add(const cv::Mat3d& tile) {
    const cv::Scalar mean = cv::mean(tile);
    cv::Mat1d luma(tile.size());
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const cv::Vec3d off = tile(y, x) - cv::Vec3d(mean[0], mean[1], mean[2]);
        luma(y, x) = off.dot({0.0722, 0.7152, 0.2126});
        squares += cv::Vec4d(off[0] * off[0], off[1] * off[1], off[2] * off[2], luma(y, x) * luma(y, x));
      }
    neighbours += cv::sum(luma.colRange(1, 8).mul(luma.colRange(0, 7)))[0] * 8 / 7;
    light += 63 * mean[1];
  }

  /// Variance over light.
  double slope(int channel) const { return squares[channel] / light; }
  double correlation() const { return neighbours / squares[3]; }
};

/// Standard deviation (pixels) of the line that a straight edge's light is the integral of. The edge runs through `middle` along
/// `along`; light `from` on the left of it becomes `to`. By the spread's own moments: with S the light's share,
/// variance = 2 * integral of t (step(t) - S(t)).
double edge_width_px(const std::vector<cv::Mat3d>& frames,
                     const std::function<std::pair<glm::dvec2, glm::dvec2>(std::size_t)>& edge, double reach_px) {
  constexpr int kPerPixel = 4;
  const int half = static_cast<int>(reach_px * kPerPixel), bins = 2 * half;
  std::vector<double> sum(static_cast<std::size_t>(bins)), count(sum);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto [first, last] = edge(i);
    const glm::dvec2 along = glm::normalize(last - first), across(-along.y, along.x);
    for (int y = 0; y < frames[i].rows; ++y)
      for (int x = 0; x < frames[i].cols; ++x) {
        const glm::dvec2 off = glm::dvec2(x, y) - first;
        const double t = glm::dot(off, along), d = glm::dot(off, across) * kPerPixel + half;
        if (t < 0 || t > glm::distance(first, last) || d < 0 || d >= bins) continue;
        sum[static_cast<std::size_t>(d)] += frames[i](y, x)[1], ++count[static_cast<std::size_t>(d)];
      }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= count[k];
  double from = 0, to = 0, area = 0, moment = 0;
  constexpr std::size_t kEnds = kPerPixel;
  for (std::size_t k = 0; k < kEnds; ++k) from += sum[k] / kEnds, to += sum[sum.size() - 1 - k] / kEnds;
  const auto t_of = [&](std::size_t k) { return (static_cast<double>(k) + 0.5 - half) / kPerPixel; };
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const double missing = (t_of(k) > 0 ? 1.0 : 0.0) - (sum[k] - from) / (to - from);
    area += missing / kPerPixel, moment += 2 * t_of(k) * missing / kPerPixel;
  }
  return std::sqrt(moment - area * area);  // area: where the edge really is
}

class LensOnTheResult : public ::testing::Test {
 protected:
  LensOnTheResult() {
    for (const char* folder : {"shot/plate", "out"}) std::filesystem::create_directories(folder_.path(folder));
    folder_.write("shot/camera.yaml", kCamera);
    folder_.write("shot/scene.toml", kScene);
    folder_.write("shot/slab.obj", kSlab);
    folder_.write("shot/slab.mtl", kMaterials);
    render::Probe probe;
    probe.image = Image(64, 32);
    std::ranges::fill(probe.image.data, 1.0f);
    render::save_probe(folder_.path("shot/probe.exr"), probe);
  }

  std::string file(const std::string& folder, std::size_t frame) const {
    return folder_.path(folder + "/" + (frame < 10 ? "000" : "00") + std::to_string(frame) + ".png");
  }

  void add_frame(const cv::Mat1f& light, double slope, const glm::dvec2& shift_px) {
    cv::imwrite(file("shot/plate", shifts_.size()), exposed(light, slope, static_cast<unsigned>(shifts_.size() + 1)));
    shifts_.push_back(shift_px);
  }

  void encode(const std::string& options) {
    const std::string plate = folder_.path("shot/plate");
    const std::string command = "ffmpeg -v error -nostdin -framerate 24 -i " + plate + "/%04d.png " + options + " " +
                                folder_.path("shot/video.mkv") + " && rm -r " + plate;
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  void overlay(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"overlay",  folder_.path("shot"),       "-o", folder_.path("out/%04d.png"),
                                          "--report", folder_.path("report.json")};
    for (const char* option : {"--quality.rays=64", "--quality.bands=2", "--quality.bounces=0", "--quality.receiver_points=16",
                               "--quality.reflection_rays=0", "--glare.enabled=false"})
      arguments.push_back(option);
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_catchlight(arguments, {{"XDG_CACHE_HOME", folder_.path("cache")}});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    for (std::size_t i = 0; i < shifts_.size(); ++i) result_.push_back(linear(cv::imread(file("out", i))));
  }

  /// The grain of tiles around a point of the tag's plane.
  Grain grain(const glm::dvec2& middle_m, const cv::Size& tiles) const {
    Grain grain;
    for (std::size_t i = 0; i < result_.size(); ++i) {
      const glm::ivec2 middle(glm::round(seen_px(middle_m, shifts_[i % shifts_.size()])));
      for (int y = 0; y < tiles.height; ++y)
        for (int x = 0; x < tiles.width; ++x)
          grain.add(result_[i](cv::Rect(middle.x + 8 * x - 4 * tiles.width, middle.y + 8 * y - 4 * tiles.height, 8, 8)));
    }
    return grain;
  }

  /// The width of an upright side of tag or slab, over the frames from `first` on.
  double width_px(double x_m, std::size_t first = 0) const {
    const std::vector<cv::Mat3d> frames(result_.begin() + static_cast<std::ptrdiff_t>(first), result_.end());
    const auto edge = [&](std::size_t i) {
      return std::pair(seen_px({x_m, -0.035}, shifts_[first + i]), seen_px({x_m, 0.035}, shifts_[first + i]));
    };
    return edge_width_px(frames, edge, 8);
  }

  void expect_the_sheets_grain() const {
    const Grain sheet = grain({0.02, -0.066}, {14, 3}), light = grain({0.11, 0}, {5, 11}), dark = grain({0.075, 0}, {3, 11});
    for (int c = 0; c < 4; ++c)
      std::cout << "noise, channel " << c << ": sheet " << sheet.slope(c) << ", light slab "
                << std::sqrt(light.slope(c) / sheet.slope(c)) << ", dark slab " << std::sqrt(dark.slope(c) / sheet.slope(c))
                << " of its standard deviation\n";
    std::cout << "correlation of neighbours: " << sheet.correlation() << ", " << light.correlation() << '\n';
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(std::sqrt(light.slope(c) / sheet.slope(c)), 1, 0.1) << c;
  }

  TemporaryFolder folder_;
  std::vector<glm::dvec2> shifts_;
  std::vector<cv::Mat3d> result_;
};

constexpr double kNoise = 2.3e-4;

TEST_F(LensOnTheResult, NoiseOfPngFootageIsTheSheetsAndTheKnownOne) {
  const Sheet sheet(0.6);
  for (int i = 0; i < 6; ++i) add_frame(sheet.at({3 * i, i}), kNoise, {3 * i, i});
  overlay();
  expect_the_sheets_grain();
  for (const glm::dvec2 slab_m : {glm::dvec2(0.075, 0), {0.11, 0}})
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::sqrt(grain(slab_m, {3, 11}).slope(c) / kNoise), 1, 0.1) << c;
}

TEST_F(LensOnTheResult, NoiseOfCodedVideoIsTheSheets) {
  const Sheet sheet(0.6);
  for (int i = 0; i < 8; ++i) add_frame(sheet.at({3 * i, i}), kNoise, {3 * i, i});
  encode("-vf scale=out_color_matrix=bt709:out_range=tv -colorspace bt709 -color_range tv -pix_fmt yuv420p -c:v libx264 -crf 14");
  // Codes of limited range lie 1.16 codes of the picture apart: at other exposures the slab's light falls between other ones,
  // which makes 3 % of its noise.
  for (const char* ev : {"0", "0.007", "0.014"}) overlay({"-y", "--exposure.ev", ev});
  expect_the_sheets_grain();
}

TEST_F(LensOnTheResult, DefocusIsTheTags) {
  for (const double blur_px : {1.0, 2.0}) {
    const Sheet sheet(blur_px);
    shifts_.clear(), result_.clear();
    for (int i = 0; i < 3; ++i) add_frame(sheet.at({0, 0}), 1e-5, {0, 0});
    overlay({"-y"});
    const double truth = std::sqrt(blur_px * blur_px + 1.0 / 12), tag = width_px(0.04), slab = width_px(0.06);
    std::cout << "edges, " << blur_px << " px: truth " << truth << ", tag " << tag << ", slab " << slab << '\n';
    EXPECT_NEAR(slab / tag, 1, 0.1) << blur_px;
    EXPECT_NEAR(slab / truth, 1, 0.1) << blur_px;
  }
}

/// Nothing is added; less than 0.02 px^2, which the program itself takes for no blur, may be missing (a pixel's own square is
/// what the footage has, four samples a pixel what the slab has).
TEST_F(LensOnTheResult, ASharpPlateAddsNoBlur) {
  const Sheet sheet(0);
  for (int i = 0; i < 3; ++i) add_frame(sheet.at({0, 0}), 1e-5, {0, 0});
  overlay();
  EXPECT_THAT(read_text(folder_.path("report.json")), ::testing::HasSubstr("no more than a pixel's own"));
  const double slab = width_px(0.06);
  std::cout << "edges, sharp: tag " << width_px(0.04) << ", slab " << slab << '\n';
  EXPECT_LT(slab * slab, 1.0 / 12 + 0.005) << "with a quarter of a pixel's bins";
  EXPECT_GT(slab * slab, 1.0 / 12 - 0.02) << "as sharp as a pixel and its samples";
}

TEST_F(LensOnTheResult, MotionBlurIsTheTags) {
  const Sheet sheet(0.6);
  constexpr double kShutter = 0.5;
  constexpr int kSteps = 12;
  const auto shift = [](double t) { return glm::dvec2(22 + 20 * std::sin(0.6 * t), 3 * std::cos(0.4 * t)); };
  for (int i = 0; i < 12; ++i) {
    cv::Mat1f light(300, 400, 0.0f);
    for (int k = 0; k < kSteps; ++k) light += sheet.at(shift(i + kShutter * ((k + 0.5) / kSteps - 0.5))) / kSteps;
    add_frame(light, 1e-5, shift(i));
  }
  overlay();
  const double tag = width_px(0.04), slab = width_px(0.06);
  std::cout << "edges, moving: tag " << tag << ", slab " << slab << '\n';
  EXPECT_GT(tag, 1.3) << "as sharp as a still one";
  EXPECT_NEAR(slab / tag, 1, 0.1);
}

}  // namespace
}  // namespace catchlight::tests
