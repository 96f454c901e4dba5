// What the window remembers from one time to the next.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::app {

/// Lengths are in units, of which a pixel of the screen may be a part.
struct TuneState {
  static constexpr std::size_t kMaxRecordings = 10;

  int width = 1280, height = 720;
  float side_width = 370;
  std::set<std::string> open_sections = {};
  std::vector<std::string> recordings = {};  ///< folders, the one that was opened last first

  /// Puts a folder to the front; anything else than a folder, such as footage alone or a camera, is not remembered.
  void remember(const std::string& recording);

  bool operator==(const TuneState&) const = default;
};

/// $XDG_STATE_HOME/catchlight/tune.toml, or that of ~/.local/state.
std::string tune_state_file();

/// What the file holds. Where there is none, or a value makes no sense, what holds in the beginning; a damaged file is warned of.
TuneState read_tune_state(const std::string& path, const WarningHandler& warn);

/// Makes the folders in between. What cannot be written is warned of.
void write_tune_state(const std::string& path, const TuneState& state, const WarningHandler& warn);

}  // namespace catchlight::app
