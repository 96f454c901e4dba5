#include "tracking/trajectory/solver.hpp"

#include "tracking/trajectory/smoothing.hpp"

namespace catchlight::tracking {
namespace {

/// Solves the frames of [begin, end), the first of which has candidates, and so has every one after at most a short gap.
void solve_stretch(std::span<const TrajectoryFrame> frames, std::span<SolvedPose> poses) {
  std::vector<const TrajectoryFrame*> seen;
  std::vector<double> times_s;
  for (const TrajectoryFrame& frame : frames) {
    times_s.push_back(frame.time_s);
    if (!frame.candidates.empty()) seen.push_back(&frame);
  }
  const std::vector<Branch> branches = choose_branches(seen);
  std::vector<TimedCandidate> measured;
  for (std::size_t i = 0; i < seen.size(); ++i) measured.push_back({seen[i]->time_s, seen[i]->candidates[branches[i].candidate]});
  const std::vector<SmoothedPose> smoothed = smooth_trajectory(measured, times_s);
  std::size_t next = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_seen = !frames[i].candidates.empty();
    poses[i] = {is_seen ? TrackState::tracking : TrackState::coasting, smoothed[i].camera_from_tag, smoothed[i].covariance,
                is_seen ? branches[next].ambiguity : 0};
    next += is_seen;
  }
}

}  // namespace

std::vector<SolvedPose> solve_trajectory(std::span<const TrajectoryFrame> frames, double coast_s) {
  constexpr double kRounding_s = 1e-6;  // frame times are rounded
  std::vector<SolvedPose> poses(frames.size());
  std::size_t begin = 0;
  while (begin < frames.size()) {
    if (frames[begin].candidates.empty()) {
      ++begin;
      continue;
    }
    std::size_t last_seen = begin, end = begin + 1;
    while (end < frames.size() && frames[end].time_s - frames[last_seen].time_s <= coast_s + kRounding_s) {
      if (!frames[end].candidates.empty()) last_seen = end;
      ++end;
    }
    solve_stretch(frames.subspan(begin, end - begin), std::span(poses).subspan(begin, end - begin));
    begin = end;
  }
  return poses;
}

}  // namespace catchlight::tracking
