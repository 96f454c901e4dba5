#include "tracking/camera/focal_length.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "catchlight/projection.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/refinement/corner_refinement.hpp"

namespace catchlight::tracking {
namespace {

constexpr std::size_t kMaxLooks = 20, kMinLooks = 5;
constexpr double kFirstStep = 0.15;
constexpr double kMinSidePx = 30;          ///< smaller tags have corners that are off by more than their perspective
constexpr double kMinCornerSigmaPx = 0.1;  ///< corners are off by that much in ways that residuals do not show
constexpr double kSearchMargin = 0.4;      ///< around the tag, as a share of its side
constexpr double kOutlierRatio = 3;
constexpr double kWorstDeviation = 0.05;  ///< over the focal length

double side_px(const Quad& corners_px) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += glm::distance(corners_px[i], corners_px[(i + 1) % 4]);
  return sum / 4;
}

double mean_step_px(const Quad& a, const Quad& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += glm::distance(a[i], b[i]);
  return sum / 4;
}

/// What a view of a square says of the focal length f: a / f^2 + b is 0 in both components, but for noise. They are the products
/// of the square's two directions, as the homography has them (Zhang 2000): one with the other, and each with itself.
struct SquareView {
  glm::dvec2 a{0.0}, b{0.0};
  std::array<glm::dvec2, 8> a_by_px{}, b_by_px{};  ///< derivatives by the corners' coordinates
};

/// `corners_px` from the principal point, pixels square. The homography is that of Heckbert (1989).
void set_products(const Quad& corners_px, glm::dvec2& a, glm::dvec2& b) {
  const auto& [p0, p1, p2, p3] = corners_px;
  const glm::dvec2 d1 = p1 - p2, d2 = p3 - p2, sum = p0 - p1 + p2 - p3;
  const double determinant = d1.x * d2.y - d2.x * d1.y;
  const double g = (sum.x * d2.y - d2.x * sum.y) / determinant, h = (d1.x * sum.y - sum.x * d1.y) / determinant;
  const glm::dvec2 along = p1 - p0 + g * p1, across = p3 - p0 + h * p3;
  a = {glm::dot(along, across), glm::dot(along, along) - glm::dot(across, across)};
  b = {g * h, g * g - h * h};
}

SquareView view_of(Quad corners_px) {
  constexpr double kStepPx = 0.01;
  SquareView view;
  set_products(corners_px, view.a, view.b);
  for (std::size_t i = 0; i < 8; ++i) {
    double& coordinate = corners_px[i / 2][static_cast<int>(i % 2)];
    const double kept = coordinate;
    std::array<glm::dvec2, 2> a, b;
    for (const int side : {0, 1}) {
      coordinate = kept + (side == 0 ? -kStepPx : kStepPx);
      set_products(corners_px, a[static_cast<std::size_t>(side)], b[static_cast<std::size_t>(side)]);
    }
    coordinate = kept;
    view.a_by_px[i] = (a[1] - a[0]) / (2 * kStepPx);
    view.b_by_px[i] = (b[1] - b[0]) / (2 * kStepPx);
  }
  return view;
}

/// The looks that the camera's lens lets through; its focal length matters only to the distortion.
std::vector<SquareView> views_of(const CameraModel& camera, const std::vector<Quad>& looks) {
  std::vector<SquareView> views;
  for (Quad look : looks) {
    for (glm::dvec2& corner : look) {
      corner = undistort_px(camera, corner).value_or(corner) - glm::dvec2(camera.cx_px, camera.cy_px);
      corner.y *= camera.fx_px / camera.fy_px;
    }
    views.push_back(view_of(look));
  }
  return views;
}

/// Squared distance of the corners from the nearest that are a square's, to first order: px².
double misfit_px2(const SquareView& view, double fx_px) {
  const double w = 1 / (fx_px * fx_px);
  const glm::dvec2 off = w * view.a + view.b;
  glm::dmat2 spread(0.0);
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec2 by_px = w * view.a_by_px[i] + view.b_by_px[i];
    spread += glm::outerProduct(by_px, by_px);
  }
  return glm::dot(off, glm::inverse(spread) * off);
}

double misfit_px2(const std::vector<SquareView>& views, double fx_px) {
  double sum = 0;
  for (const SquareView& view : views) sum += misfit_px2(view, fx_px);
  return sum;
}

/// The focal length of least misfit between two, tried in steps of that ratio.
double least_between(const std::vector<SquareView>& views, double low_px, double high_px, double ratio) {
  double best_px = low_px, least = std::numeric_limits<double>::infinity();
  for (double fx_px = low_px; fx_px <= high_px; fx_px *= ratio)
    if (const double misfit = misfit_px2(views, fx_px); misfit < least) {
      least = misfit;
      best_px = fx_px;
    }
  return best_px;
}

/// That of all focal lengths that lenses have; empty where it lies at the end.
std::optional<double> best_focal_px(const std::vector<SquareView>& views, int width_px) {
  constexpr double kWidest = 0.3, kLongest = 8;  // over the picture's width
  constexpr double kCoarse = 1.01, kFine = 1.0003;
  const double low_px = kWidest * width_px, high_px = kLongest * width_px;
  const double coarse_px = least_between(views, low_px, high_px, kCoarse);
  if (coarse_px < low_px * kCoarse || coarse_px * kCoarse * kCoarse > high_px) return {};
  return least_between(views, coarse_px / kCoarse, coarse_px * kCoarse, kFine);
}

std::vector<Quad> without_outliers(const std::vector<Quad>& looks, const std::vector<SquareView>& views, double fx_px) {
  std::vector<double> misfits_px2;
  for (const SquareView& view : views) misfits_px2.push_back(misfit_px2(view, fx_px));
  const double usual_px2 = std::max(median(misfits_px2), 2 * kMinCornerSigmaPx * kMinCornerSigmaPx);
  std::vector<Quad> kept;
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (misfits_px2[i] <= kOutlierRatio * kOutlierRatio * usual_px2) kept.push_back(looks[i]);
  return kept;
}

/// Variance of the focal length by the corners' noise: from how quickly the misfit rises on both sides.
double noise_variance_px2(const std::vector<SquareView>& views, double fx_px) {
  constexpr double kStep = 0.02;
  const double step_px = kStep * fx_px, least = misfit_px2(views, fx_px);
  const double rise = (misfit_px2(views, fx_px + step_px) + misfit_px2(views, fx_px - step_px) - 2 * least) / (step_px * step_px);
  // Each look has eight coordinates and a pose of six.
  const double freedom = 2.0 * static_cast<double>(views.size()) - 1;
  const double variance_px2 = std::max(least / freedom, kMinCornerSigmaPx * kMinCornerSigmaPx);
  return rise > 0 ? 2 * variance_px2 / rise : std::numeric_limits<double>::infinity();
}

/// Cameras that may be the true one as well: another principal point, another distortion. A camera without distortion is a guess.
std::array<CameraModel, 3> doubts(CameraModel camera, double fx_px) {
  const bool is_guess = !camera.has_distortion();
  const double off_px = (is_guess ? 0.02 : 0.005) * camera.width_px, bend = is_guess ? 0.05 : 0.01;
  if (is_guess) {
    camera.fy_px *= fx_px / camera.fx_px;
    camera.fx_px = fx_px;
  }
  std::array<CameraModel, 3> others{camera, camera, camera};
  others[0].cx_px += off_px;
  others[1].cy_px += off_px;
  others[2].distortion[0] += bend;
  return others;
}

}  // namespace

FocalMeter::FocalMeter(const CameraModel& camera, const PrintedTag& tag)
    : camera_(camera), id_(tag.id), layout_(tag_layout(tag.family, tag.id)), detector_(tag.family, {}), min_step_(kFirstStep) {}

void FocalMeter::add(const LumaView& luma, const Quad& corners_px) {
  if (side_px(corners_px) < kMinSidePx || !is_new(corners_px)) return;
  const auto seen_px = detected(luma, corners_px);
  if (!seen_px || !is_new(*seen_px)) return;
  const RefinedCorners refined = refine_corners(luma, camera_, *seen_px, layout_);
  if (!std::ranges::all_of(refined.edge_refined, [](bool edge) { return edge; })) return;
  looks_.push_back(refined.corners_px);
  while (looks_.size() > kMaxLooks) thin_out();
}

std::optional<Quad> FocalMeter::detected(const LumaView& luma, const Quad& corners_px) {
  const double margin_px = kSearchMargin * side_px(corners_px);
  glm::dvec2 low(luma.width_px, luma.height_px), high(0.0);
  for (const glm::dvec2& corner : corners_px) {
    low = glm::min(low, corner - margin_px);
    high = glm::max(high, corner + margin_px);
  }
  const glm::ivec2 first = glm::max(glm::ivec2(low), 0);
  const glm::ivec2 size = glm::min(glm::ivec2(high), {luma.width_px, luma.height_px}) - first;
  if (size.x < kMinSidePx || size.y < kMinSidePx) return {};
  LumaView part = luma;
  part.data += static_cast<std::ptrdiff_t>(first.y) * luma.stride + first.x;
  part.width_px = size.x;
  part.height_px = size.y;
  for (const Detection& detection : detector_.detect(part)) {
    if (detection.id != id_) continue;
    Quad quad_px = detection.corners_px;
    for (glm::dvec2& corner : quad_px) corner += first;
    return quad_px;
  }
  return {};
}

bool FocalMeter::is_new(const Quad& corners_px) const {
  const double step_px = min_step_ * side_px(corners_px);
  return std::ranges::all_of(looks_, [&](const Quad& look) { return mean_step_px(look, corners_px) > step_px; });
}

void FocalMeter::thin_out() {
  min_step_ *= std::sqrt(2.0);
  for (const Quad& look : std::exchange(looks_, {}))
    if (is_new(look)) looks_.push_back(look);
}

std::optional<FocalEstimate> FocalMeter::estimate() const {
  if (looks_.size() < kMinLooks) return {};
  const std::vector<SquareView> all = views_of(camera_, looks_);
  const auto first_px = best_focal_px(all, camera_.width_px);
  if (!first_px) return {};
  const std::vector<Quad> looks = without_outliers(looks_, all, *first_px);
  const std::vector<SquareView> views = views_of(camera_, looks);
  const auto fx_px = looks.size() < kMinLooks ? std::nullopt : best_focal_px(views, camera_.width_px);
  if (!fx_px) return {};
  double variance_px2 = noise_variance_px2(views, *fx_px);
  for (const CameraModel& other : doubts(camera_, *fx_px)) {
    const auto other_px = best_focal_px(views_of(other, looks), camera_.width_px);
    if (!other_px) return {};
    variance_px2 += std::pow(*other_px - *fx_px, 2);
  }
  if (!(std::sqrt(variance_px2) < kWorstDeviation * *fx_px)) return {};
  return FocalEstimate{*fx_px, std::sqrt(variance_px2), static_cast<int>(looks.size())};
}

}  // namespace catchlight::tracking
