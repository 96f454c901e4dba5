// Corner errors gathered over frames, and tables of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy/methods.hpp"

namespace catchlight::tracking {

/// One method's errors at one stress.
struct Score {
  int frames = 0, found = 0, stray = 0;
  double squares_px2 = 0, bias_px = 0;

  /// A pose whose corners are off by more than 5 px RMS is not the tag: counted as `stray`, left out of the errors.
  void add(const std::optional<Estimate>& estimate, const Corners& truth_px);

  double rms_2d_px() const;
  double rms_per_axis_px() const;
  double outward_bias_px() const;
  double found_percent() const { return 100.0 * found / frames; }
  double stray_percent() const { return 100.0 * stray / frames; }
};

struct NamedScore {
  std::string method;
  Score score;
};

struct LadderRow {
  double level = 0;
  std::vector<NamedScore> methods;
};

/// Adds a clip's judged frames to the method's score.
void add_result(const Clip& clip, const MethodResult& result, LadderRow& row);

/// `title` and a table of the RMS error per axis, with the share found where it is not all.
void print_table(const std::string& title, const std::string& level_name, const std::vector<LadderRow>& rows);

/// One line a level and method. Throws Error where the file cannot be written.
void write_csv(const std::filesystem::path& file, const std::string& level_name, const std::vector<LadderRow>& rows);

}  // namespace catchlight::tracking
