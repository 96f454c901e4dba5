#include "app/session/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/support/output_file.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// The smallest sample that at least `share` of them do not exceed.
double percentile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

std::string line_of(const StageTimer::Summary& stage) {
  char text[128];
  std::snprintf(text, sizeof text, "  %-12s %8.2f ms median, %8.2f ms 95th percentile", stage.stage.c_str(), stage.median_ms,
                stage.p95_ms);
  return text;
}

/// With line ends between them.
std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    if (!text.empty()) text += '\n';
    text += line;
  }
  return text;
}

}  // namespace

StageTimer& StageTimer::operator=(const StageTimer& other) {
  Samples samples = other.samples();
  const std::lock_guard lock(mutex_);
  samples_ms_ = std::move(samples);
  return *this;
}

StageTimer::Samples StageTimer::samples() const {
  const std::lock_guard lock(mutex_);
  return samples_ms_;
}

void StageTimer::add(const std::string& stage, double ms) {
  const std::lock_guard lock(mutex_);
  const auto known =
      std::find_if(samples_ms_.begin(), samples_ms_.end(), [&](const auto& entry) { return entry.first == stage; });
  if (known != samples_ms_.end())
    known->second.add(ms);
  else
    samples_ms_.push_back({stage, {}}), samples_ms_.back().second.add(ms);
}

std::vector<StageTimer::Summary> StageTimer::summaries() const {
  std::vector<Summary> summaries;
  for (const auto& [stage, samples] : samples()) {
    std::vector<double> sorted = samples.values();
    std::sort(sorted.begin(), sorted.end());
    summaries.push_back({stage, percentile(sorted, 0.5), percentile(sorted, 0.95)});
  }
  return summaries;
}

void Report::count(const TrackRow& row) {
  ++frames;
  switch (row.state) {
    case TrackState::tracking:
      ++tracked_frames;
      break;
    case TrackState::coasting:
      ++coasting_frames;
      break;
    case TrackState::lost:
      ++lost_frames;
      break;
  }
}

std::string report_json(const Report& report) {
  nlohmann::ordered_json json{{"frames", report.frames},
                              {"tracked_frames", report.tracked_frames},
                              {"coasting_frames", report.coasting_frames},
                              {"lost_frames", report.lost_frames},
                              {"dropped_frames", report.dropped_frames},
                              {"glare", {{"frames", report.glare_frames}, {"share", report.glare_share}}},
                              {"fps", report.fps},
                              {"renderer", report.renderer},
                              {"object", report.object},
                              {"stages", nlohmann::ordered_json::object()},
                              {"plan", nlohmann::ordered_json::array()},
                              {"warnings", report.warnings}};
  for (const StageTimer::Summary& stage : report.stages.summaries())
    json["stages"][stage.stage] = {{"median_ms", stage.median_ms}, {"p95_ms", stage.p95_ms}};
  for (const PlanEntry& entry : report.plan)
    json["plan"].push_back({{"choice", entry.choice}, {"value", entry.value}, {"reason", entry.reason}});
  // File names in warnings need not be UTF-8; JSON has to be.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

void write_report(const std::string& path, const Report& report, bool overwrite) {
  write_text_file(path, report_json(report), overwrite);
}

std::string report_summary(const Report& report) {
  std::string text = counted(report.frames, "frame") + ", " + std::to_string(report.tracked_frames) + " tracked, " +
                     std::to_string(report.coasting_frames) + " coasting, " + std::to_string(report.lost_frames) + " lost, " +
                     (report.dropped_frames > 0 ? std::to_string(report.dropped_frames) + " dropped, " : "") +
                     fixed_text(report.fps, 1) + " frames/s";
  if (!report.renderer.empty()) text += " on " + report.renderer;
  if (!report.object.empty()) text += '\n' + report.object;
  return text;
}

std::string report_details(const Report& report) {
  std::vector<std::string> lines;
  for (const StageTimer::Summary& stage : report.stages.summaries()) lines.push_back(line_of(stage));
  if (!report.plan.empty()) lines.push_back(plan_text(report.plan));
  return joined(lines);
}

std::string plan_text(const std::vector<PlanEntry>& plan) {
  std::vector<std::string> lines;
  for (const PlanEntry& entry : plan) lines.push_back("  " + entry.choice + " = " + entry.value + ": " + entry.reason);
  return joined(lines);
}

}  // namespace catchlight::app
