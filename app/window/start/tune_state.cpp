#include "app/window/start/tune_state.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "app/support/output_file.hpp"
#include "toml++/toml.h"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMinWidth = 640, kMinHeight = 400, kMaxSize = 8192;
constexpr float kMinSide = 200, kMaxSide = 2000;

std::vector<std::string> texts_of(const toml::node_view<const toml::node>& node) {
  std::vector<std::string> texts;
  if (const toml::array* array = node.as_array())
    for (const toml::node& entry : *array)
      if (const auto text = entry.value<std::string>()) texts.push_back(*text);
  return texts;
}

toml::array array_of(const auto& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

}  // namespace

void TuneState::remember(const std::string& recording) {
  std::error_code missing;
  const fs::path folder = fs::canonical(recording, missing);
  if (missing || !fs::is_directory(folder, missing)) return;
  std::erase(recordings, folder.string());
  recordings.insert(recordings.begin(), folder.string());
  if (recordings.size() > kMaxRecordings) recordings.resize(kMaxRecordings);
}

std::string tune_state_file() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value ? value : "");
  };
  const fs::path state = from("XDG_STATE_HOME");
  return ((state.empty() ? from("HOME") / ".local/state" : state) / "catchlight/tune.toml").string();
}

TuneState read_tune_state(const std::string& path, const WarningHandler& warn) {
  TuneState state;
  if (!fs::exists(path)) return state;
  try {
    const toml::table table = toml::parse_file(path);
    const auto root = toml::node_view<const toml::node>(table);
    state.width = std::clamp(root["width"].value_or(state.width), kMinWidth, kMaxSize);
    state.height = std::clamp(root["height"].value_or(state.height), kMinHeight, kMaxSize);
    const float side_width = root["side_width"].value_or(state.side_width);
    if (side_width >= kMinSide && side_width <= kMaxSide) state.side_width = side_width;
    const std::vector<std::string> sections = texts_of(root["open_sections"]);
    state.open_sections = {sections.begin(), sections.end()};
    state.recordings = texts_of(root["recordings"]);
  } catch (const toml::parse_error& error) {
    warn(path + ": damaged, and made anew (" + std::string(error.description()) + ")");
  }
  return state;
}

void write_tune_state(const std::string& path, const TuneState& state, const WarningHandler& warn) {
  std::ostringstream text;
  text << "# What the window of `catchlight tune` remembers; may be deleted.\n"
       << toml::table{{"width", state.width},
                      {"height", state.height},
                      {"side_width", state.side_width},
                      {"open_sections", array_of(state.open_sections)},
                      {"recordings", array_of(state.recordings)}}
       << '\n';
  try {
    fs::create_directories(fs::path(path).parent_path());
    write_text_file(path, text.str(), true);
  } catch (const std::exception& error) {
    warn(error.what());
  }
}

}  // namespace catchlight::app
