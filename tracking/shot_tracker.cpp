#include "tracking/shot_tracker.hpp"

#include <algorithm>

#include "catchlight/track.hpp"

namespace catchlight::tracking {
namespace {

constexpr std::size_t kMaxKept = 26;  ///< a second of footage, and two frames to start back from

}  // namespace

ShotTracker::ShotTracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options)
    : camera_(camera), target_(target), options_(options), forward_(camera, target, options) {}

const TagObservation& ShotTracker::add(const LumaView& luma, double time_s) {
  last_ = forward_.track(luma, time_s);
  frames_.push_back({time_s, {}});
  appearances_.emplace_back();
  record(frames_.size() - 1, last_);
  // Nothing is looked back for where the last three frames have been seen, nor beyond them.
  const auto is_seen = [&](std::size_t ago) {
    return frames_.size() > ago && !frames_[frames_.size() - 1 - ago].candidates.empty();
  };
  if (is_seen(0) && is_seen(1) && is_seen(2)) {
    kept_.clear();
    return last_;
  }
  keep(luma, time_s);
  if (is_seen(0) && is_seen(1) && frames_.size() >= 3) look_back();
  return last_;
}

void ShotTracker::record(std::size_t frame, const TagObservation& seen) {
  if (seen.state != TrackState::tracking) return;
  frames_[frame].candidates = seen.candidates;
  appearances_[frame] = seen.appearance;
}

void ShotTracker::keep(const LumaView& luma, double time_s) {
  if (kept_.size() == kMaxKept) kept_.pop_front();
  Kept& kept = kept_.emplace_back(Kept{frames_.size() - 1, time_s, luma, {}});
  kept.codes.reserve(static_cast<std::size_t>(luma.width_px) * static_cast<std::size_t>(luma.height_px));
  for (int row = 0; row < luma.height_px; ++row) {
    const std::uint8_t* from = luma.data + static_cast<std::ptrdiff_t>(row) * luma.stride;
    kept.codes.insert(kept.codes.end(), from, from + luma.width_px);
  }
  kept.luma.data = kept.codes.data();
  kept.luma.stride = luma.width_px;
}

/// Time runs backward for a second tracker, from the last two frames on.
void ShotTracker::look_back() {
  Tracker backward(camera_, target_, options_);
  for (std::size_t i = kept_.size(); i-- > 0;) {
    const TagObservation seen = backward.track(kept_[i].luma, -kept_[i].time_s);
    const bool known = !frames_[kept_[i].frame].candidates.empty();
    if (seen.state != TrackState::tracking || (known && i + 2 < kept_.size())) return;
    if (!known) record(kept_[i].frame, seen);
  }
}

std::vector<SolvedPose> ShotTracker::solve() const {
  return solve_trajectory(frames_, options_.coast_s);
}

}  // namespace catchlight::tracking
