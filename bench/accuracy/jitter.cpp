#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/accuracy/experiments.hpp"
#include "bench/accuracy/score.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kPoses = 4, kNoises = 60;

struct Spread {
  std::string method;
  double squares_px2 = 0;
  int count = 0;
};

/// Adds the spread about each corner's own mean: a bias is not a jitter.
void add_spread(const Estimates& estimates, Spread& spread) {
  for (int corner = 0; corner < 4; ++corner) {
    glm::dvec2 sum(0);
    double squares = 0;
    int count = 0;
    for (const auto& estimate : estimates) {
      if (!estimate) continue;
      sum += estimate->corners_px[corner];
      squares += glm::dot(estimate->corners_px[corner], estimate->corners_px[corner]);
      ++count;
    }
    if (count < 2) continue;
    spread.squares_px2 += (squares - glm::dot(sum, sum) / count) / 2;
    spread.count += count - 1;
  }
}

}  // namespace

void measure_jitter() {
  std::puts("\nJitter of a still tag, noise 3 codes: standard deviation of its corners per axis in px");
  for (const double size_px : {160.0, 80.0, 40.0}) {
    std::vector<Spread> spreads;
    for (unsigned seed = 1; seed <= kPoses; ++seed) {
      const Clip clip = still_clip(size_px, 3, kNoises, seed);
      for (const auto& measure : {peers, rungs, followed})
        for (const MethodResult& result : measure(clip)) {
          auto known =
              std::find_if(spreads.begin(), spreads.end(), [&](const Spread& each) { return each.method == result.method; });
          if (known == spreads.end()) known = spreads.insert(known, {result.method});
          add_spread(result.estimates, *known);
        }
    }
    if (size_px == 160) {
      std::printf("%16s", "size_px");
      for (const Spread& each : spreads) std::printf(" %16s", each.method.c_str());
      std::puts("");
    }
    std::printf("%16g", size_px);
    for (const Spread& each : spreads) std::printf(" %16.4f", std::sqrt(each.squares_px2 / std::max(each.count, 1)));
    std::puts("");
  }
  std::fflush(stdout);
}

}  // namespace catchlight::tracking
