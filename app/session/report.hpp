// What a run did and how long it took: --report FILE, and a few lines for people.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/session/plan.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/thinned_sample.hpp"

namespace catchlight::app {

/// Milliseconds by stage, of the clock on the wall; the stages keep the order in which they first came. Stages may be timed on
/// several threads at once.
class StageTimer {
 public:
  StageTimer() = default;
  StageTimer(const StageTimer& other) : samples_ms_(other.samples()) {}
  StageTimer& operator=(const StageTimer& other);

  void add(const std::string& stage, double ms);

  /// Runs `work` and adds its time.
  template <class Work>
  decltype(auto) measure(const std::string& stage, Work&& work) {
    const Running running{*this, stage};
    return std::forward<Work>(work)();
  }

  struct Summary {
    std::string stage;
    double median_ms, p95_ms;
  };
  /// Percentiles by nearest rank.
  std::vector<Summary> summaries() const;

 private:
  struct Running {
    StageTimer& timer;
    const std::string& stage;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Running() { timer.add(stage, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()); }
  };
  using Samples = std::vector<std::pair<std::string, ThinnedSample<double>>>;
  Samples samples() const;

  mutable std::mutex mutex_;
  Samples samples_ms_;
};

struct Report {
  std::int64_t frames = 0, tracked_frames = 0, coasting_frames = 0, lost_frames = 0;
  std::int64_t dropped_frames = 0;  ///< of live footage, for newer ones
  std::int64_t glare_frames = 0;    ///< frames in which glare was drawn
  double glare_share = 0;           ///< share of the frame that glare reached in those, on average
  double fps = 0;        ///< frames a second of wall-clock time over all that was done: tracking, building, drawing, encoding
  std::string renderer;  ///< GL_RENDERER, or "cpu"
  std::string object;    ///< how large the objects are, as scale_text; empty where that is not known
  StageTimer stages;
  std::vector<PlanEntry> plan;
  std::vector<std::string> warnings;

  /// Counts a frame by what became of its tag.
  void count(const TrackRow& row);
};

/// The report as JSON: frames, tracked_frames, coasting_frames, lost_frames, dropped_frames, glare.{frames,share}, fps, renderer,
/// object, stages.{name}.{median_ms,p95_ms}, plan, warnings.
std::string report_json(const Report& report);

/// Writes the JSON beside `path` and renames it; throws as write_text_file.
void write_report(const std::string& path, const Report& report, bool overwrite);

/// The report in a line or two: frames, what became of the tag in them, speed; how large the objects are. Without a line end.
std::string report_summary(const Report& report);

/// A line for each stage's time, and one for each choice of the plan; the last has no line end. Empty where there are none.
std::string report_details(const Report& report);

/// A line for each choice and its reason, as report_details.
std::string plan_text(const std::vector<PlanEntry>& plan);

}  // namespace catchlight::app
