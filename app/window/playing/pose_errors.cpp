#include "app/window/playing/pose_errors.hpp"

#include <map>

#include "app/tools/replay/pose_comparison.hpp"

namespace catchlight::app {

std::vector<PoseError> pose_errors(const std::vector<TrackRow>& rows, const std::vector<TrackRow>& truth,
                                   const CameraModel& camera, double tag_size_m) {
  std::map<std::int64_t, const TrackRow*> known;
  for (const TrackRow& row : truth) known[row.frame] = &row;
  std::vector<PoseError> errors;
  errors.reserve(rows.size());
  for (const TrackRow& row : rows) {
    PoseError& error = errors.emplace_back(PoseError{row.frame, row.state, row.found ? row.corner_sigma_px : 0, {}, {}, {}});
    const auto at = known.find(row.frame);
    if (at == known.end()) continue;
    const PoseComparison compared = compare_poses({row}, {*at->second}, camera, tag_size_m);
    if (compared.tracked == 0) continue;
    error.off_px = compared.corner_rms_px;
    error.off_mm = compared.translation_median_mm;
    error.turned_deg = compared.rotation_median_deg;
  }
  return errors;
}

}  // namespace catchlight::app
