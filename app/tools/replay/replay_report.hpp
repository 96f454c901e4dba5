// What replay found, for programs to read.
#pragma once

#include <string>
#include <vector>

#include "app/tools/replay/replay.hpp"

namespace catchlight::app {

/// A recording's result and what became of it.
struct Replayed {
  std::string folder, sheet;  ///< the sheet's file, where result.has_sheet
  ReplayResult result;
  ExpectedFigures expected;  ///< what expected.toml says; empty where it is missing
  std::vector<std::string> drifted,
      apart;  ///< a line for each figure, or for each difference of the renderers, that is too far off
  bool is_blessed = false;

  std::string verdict() const { return is_blessed ? "blessed" : drifted.empty() ? "as expected" : "drifted"; }
};

/// as_expected; recordings[]: name, folder, verdict, against ("truth" or "baseline"), sheet (or null), figures.{key}.{value,
/// expected (or null), tolerance}, messages[], renderers (or null).{frames, mean, p99}. JSON.
std::string replay_json(const std::vector<Replayed>& recordings);

}  // namespace catchlight::app
