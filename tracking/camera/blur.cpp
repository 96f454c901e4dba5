#include "tracking/camera/blur.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/projection.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/statistics.hpp"

namespace catchlight::tracking {
namespace {

constexpr std::size_t kFocusFrames = 3;  ///< on either side
constexpr std::size_t kRemembered = 120;
constexpr double kSignificant = 4;      ///< standard errors
constexpr double kCertain = 5;          ///< deviations of what frames are off as a rule
constexpr double kMinError_px2 = 0.02;  ///< the blur of a frame is never more certain

bool is_measured(const TrackRow& row) {
  return row.state == TrackState::tracking && row.noise_codes > 0 && row.blur_px2.xx + row.blur_px2.yy > 0;
}

/// rotation_vector() of a small turn, straight from the matrix: to the last digit what track files have.
glm::dvec3 small_turn(const glm::dmat3& r) {
  const glm::dvec3 twice_sine(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
  const double sine = glm::length(twice_sine) / 2, cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
  return sine < 1e-12 ? twice_sine / 2.0 : twice_sine * (std::atan2(sine, cosine) / (2 * sine));
}

/// A frame's share of the motion between two rows, as seen in the middle between them.
TagMotion motion_between(const TrackRow& before, const TrackRow& after) {
  const double share = 1.0 / static_cast<double>(after.frame - before.frame);
  const RigidTransform moved = after.camera_from_tag * inverse(before.camera_from_tag);
  const glm::dvec3 turn = small_turn(moved.rotation);
  return {turn * share, (moved.translation_m - 0.5 * glm::cross(turn, moved.translation_m)) * share};
}

bool follows(const TrackRow& row, const TrackRow& next) {
  return row.found && next.found && next.frame == row.frame + 1;
}

/// One equation of the shutter: blur's part = shutter^2 * motion's.
struct Directed {
  double motion, blur;
};

double shutter_of(const std::vector<Directed>& parts) {
  if (parts.size() < 8) return 0;
  double squared = 0, error = 0, scale = 1e9;
  for (int iteration = 0; iteration < 10; ++iteration) {
    double mm = 0, mb = 0, rr = 0, weights = 0;
    for (const Directed& part : parts) {
      const double off = std::abs(part.blur - squared * part.motion), weight = off <= 1.5 * scale ? 1 : 1.5 * scale / off;
      mm += weight * part.motion * part.motion, mb += weight * part.motion * part.blur;
      rr += weight * off * off, weights += weight;
    }
    if (!(mm > 0)) return 0;
    error = std::sqrt(rr / weights / mm);
    squared = mb / mm;
    std::vector<double> offs;
    for (const Directed& part : parts) offs.push_back(std::abs(part.blur - squared * part.motion));
    scale = std::max(1.4826 * median(std::move(offs)), 1e-6);
  }
  return squared > kSignificant * error ? std::min(std::sqrt(squared), 1.0) : 0;
}

double shutter_of(const std::vector<TrackRow>& rows, const std::vector<Covariance2>& motions) {
  std::vector<Directed> parts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_measured(rows[i])) continue;
    const Covariance2 &motion = motions[i], &blur = rows[i].blur_px2;
    parts.push_back({motion.xx - motion.yy, blur.xx - blur.yy});
    parts.push_back({2 * motion.xy, 2 * blur.xy});
  }
  return shutter_of(parts);
}

BlurExcess excess_of(const TrackRow& row, const Covariance2& motion) {
  const double s2 = row.blur.shutter * row.blur.shutter;
  const Covariance2 left{row.blur_px2.xx - s2 * motion.xx - row.blur.focus_px2, row.blur_px2.xy - s2 * motion.xy,
                         row.blur_px2.yy - s2 * motion.yy - row.blur.focus_px2};
  return {(left.xx + left.yy) / 2, {(left.xx - left.yy) / 2, left.xy}};
}

/// How far frames are off as a rule.
struct ExcessScale {
  double even, directed;
};

ExcessScale scale_of(const std::vector<BlurExcess>& all) {
  std::vector<double> even, directed;
  for (const BlurExcess& each : all) {
    even.push_back(std::abs(each.even));
    directed.insert(directed.end(), {std::abs(each.directed.x), std::abs(each.directed.y)});
  }
  const auto deviation = [](std::vector<double> offs) {
    return std::max(offs.empty() ? 0.0 : 1.4826 * median(std::move(offs)), kMinError_px2);
  };
  return {deviation(std::move(even)), deviation(std::move(directed))};
}

/// The share of an excess to believe: 0 up to kCertain deviations, then rising to 1.
double certain_share(const BlurExcess& excess, const ExcessScale& scale) {
  const double even = excess.even / scale.even, directed = glm::length(excess.directed) / scale.directed;
  return std::max(0.0, 1 - kCertain * kCertain / std::max(even * even + directed * directed, 1e-9));
}

/// The way (pixels) of the tag's middle in a motion.
std::optional<glm::dvec2> way_px(const CameraModel& camera, const glm::dvec3& middle_m, const TagMotion& motion) {
  const glm::dvec3 half = 0.5 * (glm::cross(motion.turn_rad, middle_m) + motion.shift_m);
  const auto from = project_px(camera, middle_m - half), to = project_px(camera, middle_m + half);
  return from && to ? std::optional(*to - *from) : std::nullopt;
}

/// The turn about the camera's x and y axes that moves the tag's middle by `way`.
std::optional<glm::dvec2> turn_for(const CameraModel& camera, const glm::dvec3& middle_m, const glm::dvec2& way) {
  constexpr double kStep_rad = 1e-4;
  const auto x = way_px(camera, middle_m, {{kStep_rad, 0, 0}, {}}), y = way_px(camera, middle_m, {{0, kStep_rad, 0}, {}});
  if (!x || !y) return std::nullopt;
  const glm::dmat2 px_from_turn(*x / kStep_rad, *y / kStep_rad);
  return std::abs(glm::determinant(px_from_turn)) > 0 ? std::optional(glm::inverse(px_from_turn) * way) : std::nullopt;
}

/// Gives the row a blur of its own: focus, motion and shutter with `excess` added to what they make of the tag.
void add_excess(TrackRow& row, const Covariance2& motion, const BlurExcess& excess, const CameraModel& camera) {
  const double s = row.blur.shutter;
  const double even = row.blur.focus_px2 + s * s * (motion.xx + motion.yy) / 2 + excess.even;
  const glm::dvec2 directed = s * s * glm::dvec2((motion.xx - motion.yy) / 2, motion.xy) + excess.directed;
  // Along a line lies the blur that the sharpest direction has not: its variance is a twelfth of its length squared.
  const double half = glm::length(directed), length_px = std::sqrt(24 * half), angle = std::atan2(directed.y, directed.x) / 2;
  glm::dvec2 wanted = length_px * glm::dvec2(std::cos(angle), std::sin(angle));
  const glm::dvec3 middle_m = row.camera_from_tag.translation_m;
  const auto moved = way_px(camera, middle_m, {row.blur.motion.turn_rad * s, row.blur.motion.shift_m * s});
  if (!moved) return;
  if (glm::dot(wanted, *moved) < 0) wanted = -wanted;
  const auto turn = turn_for(camera, middle_m, wanted - *moved);
  if (!turn) return;
  row.blur.shake_rad = *turn;
  row.blur.focus_px2 = std::max(even - half, kMinError_px2);
}

/// The frame's own blur, where it is certain that it has one.
void set_own_blur(TrackRow& row, const Covariance2& motion, const BlurExcess& excess, const ExcessScale& scale,
                  const CameraModel& camera) {
  const double share = certain_share(excess, scale);
  if (share > 0) add_excess(row, motion, {share * excess.even, share * excess.directed}, camera);
}

double focus_of(const TrackRow& row, const Covariance2& motion, double shutter) {
  const double blur = (row.blur_px2.xx + row.blur_px2.yy) / 2, of_motion = shutter * shutter * (motion.xx + motion.yy) / 2;
  return std::max(blur - of_motion, 0.0);
}

/// The median of the rows from `first` to before `end`; 0 where none of them is measured.
double focus_of(const std::vector<TrackRow>& rows, const std::vector<Covariance2>& motions, std::size_t first, std::size_t end,
                double shutter) {
  std::vector<double> values;
  for (std::size_t i = first; i < end; ++i)
    if (is_measured(rows[i])) values.push_back(focus_of(rows[i], motions[i], shutter));
  return values.empty() ? 0 : median(std::move(values));
}

/// Half the way from the row before to the row after, or all of it from one of them; none where neither follows on.
TagMotion motion_at(const std::vector<TrackRow>& rows, std::size_t i) {
  const bool has_before = i > 0 && follows(rows[i - 1], rows[i]),
             has_after = i + 1 < rows.size() && follows(rows[i], rows[i + 1]);
  if (!has_before && !has_after) return {};
  return motion_between(rows[has_before ? i - 1 : i], rows[has_after ? i + 1 : i]);
}

Covariance2 seen_motion(const CameraModel& camera, const TrackRow& row, double tag_size_m) {
  return row.found ? motion_covariance(camera, row.camera_from_tag, row.blur.motion, tag_size_m) : Covariance2{};
}

}  // namespace

Covariance2 motion_covariance(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagMotion& motion,
                              double tag_size_m) {
  Covariance2 sum;
  constexpr int kPoints = 4;
  for (const glm::dvec3& corner : tag_corners_m(tag_size_m)) {
    const glm::dvec3 point = camera_from_tag * corner, way = 0.5 * (glm::cross(motion.turn_rad, point) + motion.shift_m);
    const auto from = project_px(camera, point - way), to = project_px(camera, point + way);
    if (!from || !to) return {};
    const glm::dvec2 v = *to - *from;
    sum.xx += v.x * v.x / 12 / kPoints, sum.xy += v.x * v.y / 12 / kPoints, sum.yy += v.y * v.y / 12 / kPoints;
  }
  return sum;
}

void measure_blur(std::vector<TrackRow>& rows, const CameraModel& camera, double tag_size_m) {
  std::vector<Covariance2> motions;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].blur.motion = motion_at(rows, i);
    motions.push_back(seen_motion(camera, rows[i], tag_size_m));
  }
  const double shutter = shutter_of(rows, motions);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t first = i - std::min(i, kFocusFrames), end = std::min(rows.size(), i + kFocusFrames + 1);
    rows[i].blur.shutter = shutter;
    rows[i].blur.focus_px2 = focus_of(rows, motions, first, end, shutter);
  }
  std::vector<BlurExcess> excesses(rows.size()), known;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_measured(rows[i])) known.push_back(excesses[i] = excess_of(rows[i], motions[i]));
  const ExcessScale scale = scale_of(known);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (is_measured(rows[i])) set_own_blur(rows[i], motions[i], excesses[i], scale, camera);
}

void BlurMeter::add(TrackRow& row) {
  last_.push_back(row);
  last_.back().blur.motion = motion_at(last_, last_.size() - 1);
  motions_.push_back(seen_motion(camera_, last_.back(), tag_size_m_));
  if (last_.size() > kRemembered) {
    last_.erase(last_.begin());
    motions_.erase(motions_.begin());
  }
  TrackRow& last = last_.back();
  last.blur.shutter = shutter_of(last_, motions_);
  const std::size_t end = last_.size(), first = end - std::min(end, 2 * kFocusFrames + 1);
  last.blur.focus_px2 = focus_of(last_, motions_, first, end, last.blur.shutter);
  if (is_measured(last)) {
    if (excesses_.size() == kRemembered) excesses_.erase(excesses_.begin());
    excesses_.push_back(excess_of(last, motions_.back()));
    set_own_blur(last, motions_.back(), excesses_.back(), scale_of(excesses_), camera_);
  }
  row.blur = last.blur;
}

}  // namespace catchlight::tracking
