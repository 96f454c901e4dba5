#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/accuracy/experiments.hpp"
#include "bench/accuracy/methods.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kTrajectories = 100;

struct Count {
  std::string method;
  int found = 0, wrong = 0, ended = 0, wrong_at_end = 0;
};

/// The pose that the true one is taken for has its normal mirrored at the line of sight (to first order in size over distance).
glm::dvec3 mirrored_normal(const RigidTransform& camera_from_tag) {
  const glm::dvec3 sight = glm::normalize(camera_from_tag.translation_m), normal = camera_from_tag.rotation[2];
  return 2 * glm::dot(normal, sight) * sight - normal;
}

/// Whether a pose is nearer to the mirrored one than to the true one; two that are within 4 degrees are as good as one.
bool is_wrong(const RigidTransform& found, const RigidTransform& truth) {
  const glm::dvec3 normal = truth.rotation[2], mirrored = mirrored_normal(truth);
  return glm::dot(normal, mirrored) < std::cos(glm::radians(4.0)) &&
         glm::dot(found.rotation[2], mirrored) > glm::dot(found.rotation[2], normal);
}

void add(const Clip& clip, const MethodResult& result, std::vector<Count>& counts) {
  auto count = std::find_if(counts.begin(), counts.end(), [&](const Count& each) { return each.method == result.method; });
  if (count == counts.end()) count = counts.insert(count, {result.method});
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    if (!result.estimates[i]) continue;
    const bool wrong = is_wrong(result.estimates[i]->camera_from_tag, clip.frames[i].camera_from_tag);
    ++count->found;
    count->wrong += wrong;
    if (i + 1 == clip.frames.size()) {
      ++count->ended;
      count->wrong_at_end += wrong;
    }
  }
}

}  // namespace

void measure_branches() {
  std::vector<Count> counts;
  each_clip(kTrajectories, frontal_clip, {peers, followed},
            [&](const Clip& clip, const MethodResult& result) { add(clip, result, counts); });
  std::puts(
      "\nWrong of the two planar poses: tag of 30 to 60 px within 15 deg of frontal, focal length 1000 px, 100 trajectories of "
      "48 "
      "frames");
  std::printf("%16s %10s %18s %18s\n", "", "found", "wrong, frames", "wrong at the end");
  for (const Count& each : counts)
    std::printf("%16s %9.1f%% %17.2f%% %10d of %d\n", each.method.c_str(), 100.0 * each.found / (kTrajectories * 48.0),
                100.0 * each.wrong / each.found, each.wrong_at_end, each.ended);
  std::fflush(stdout);
}

}  // namespace catchlight::tracking
