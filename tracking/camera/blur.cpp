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
constexpr double kSignificant = 4;  ///< standard errors

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
}

void BlurMeter::add(TrackRow& row) {
  last_.push_back(row);
  last_.back().blur.motion = motion_at(last_, last_.size() - 1);
  motions_.push_back(seen_motion(camera_, last_.back(), tag_size_m_));
  if (last_.size() > kRemembered) {
    last_.erase(last_.begin());
    motions_.erase(motions_.begin());
  }
  BlurModel& blur = last_.back().blur;
  blur.shutter = shutter_of(last_, motions_);
  const std::size_t end = last_.size(), first = end - std::min(end, 2 * kFocusFrames + 1);
  blur.focus_px2 = focus_of(last_, motions_, first, end, blur.shutter);
  row.blur = blur;
}

}  // namespace catchlight::tracking
