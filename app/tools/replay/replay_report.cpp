#include "app/tools/replay/replay_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace catchlight::app {

namespace {

using Json = nlohmann::ordered_json;

Json figures_of(const Replayed& replayed) {
  Json figures = Json::object();
  for (const Figure& figure : replayed.result.figures) {
    const auto expected = replayed.expected.find(figure.key);
    figures[figure.key] = {{"value", figure.value},
                           {"expected", expected == replayed.expected.end() ? Json() : Json(expected->second)},
                           {"tolerance", figure.tolerance}};
  }
  return figures;
}

Json recording_of(const Replayed& replayed) {
  const ReplayResult& result = replayed.result;
  Json json{{"name", result.name},
            {"folder", replayed.folder},
            {"verdict", replayed.verdict()},
            {"against", result.kept ? "baseline" : "truth"},
            {"sheet", result.has_sheet ? Json(replayed.sheet) : Json()},
            {"figures", figures_of(replayed)},
            {"messages", replayed.drifted},
            {"renderers", nullptr}};
  for (const std::string& line : replayed.apart) json["messages"].push_back(line);
  if (result.renderers)
    json["renderers"] = {
        {"frames", result.renderers->frames}, {"mean", result.renderers->worst.mean}, {"p99", result.renderers->worst.p99}};
  return json;
}

}  // namespace

std::string replay_json(const std::vector<Replayed>& recordings) {
  const bool is_fine = std::ranges::all_of(recordings, [](const Replayed& r) { return r.drifted.empty() && r.apart.empty(); });
  Json json{{"as_expected", is_fine}, {"recordings", Json::array()}};
  for (const Replayed& replayed : recordings) json["recordings"].push_back(recording_of(replayed));
  // File names need not be UTF-8; JSON has to be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace catchlight::app
