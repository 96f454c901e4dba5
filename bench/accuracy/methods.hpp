// The ways of finding a tag that are compared, each on the same frames.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy/clip.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {

struct Estimate {
  Corners corners_px{};
  RigidTransform camera_from_tag;
};

/// One entry a frame of the clip; empty where the tag was not found, or the frame was not asked for.
using Estimates = std::vector<std::optional<Estimate>>;

struct MethodResult {
  std::string method;
  Estimates estimates;
};

/// The peers see single frames: Debian's AprilTag library at full resolution, and OpenCV's aruco module (left out where it is not
/// installed) with its AprilTag-2 detector and with its own and cornerSubPix, all else at its defaults. Poses are the better of
/// IPPE's two, by OpenCV.
std::vector<MethodResult> peers(const Clip& clip);

/// Our own method frame by frame, with no memory, on each rung.
std::vector<MethodResult> rungs(const Clip& clip);

/// Our own method through the clip: `direct, follow` knows the frames before, `direct, solved` those after too.
std::vector<MethodResult> followed(const Clip& clip);

using Measure = std::vector<MethodResult> (*)(const Clip&);

/// Measures the clips of seeds 1 to `count`, several at once, and hands over what came out in the order of the seeds.
void each_clip(unsigned count, const std::function<Clip(unsigned seed)>& make, const std::vector<Measure>& measures,
               const std::function<void(const Clip&, const MethodResult&)>& take);

}  // namespace catchlight::tracking
