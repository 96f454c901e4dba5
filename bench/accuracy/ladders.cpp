#include <algorithm>
#include <cstdio>
#include <limits>

#include "bench/accuracy/experiments.hpp"
#include "bench/accuracy/score.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kClips = 5;  ///< clips a level, of 8 judged frames each

struct Ladder {
  const char* file;
  const char* title;
  const char* level_name;
  double Stress::*value;
  double easy;
  std::vector<double> levels;
  Stress base = {};
  double most_rise = std::numeric_limits<double>::infinity();  ///< rise of the stress from the easy frames to the hard ones
};

std::vector<Ladder> ladders() {
  Stress bright_bar;
  bright_bar.bar_linear = 0.9;
  return {
      {"size", "Tag size", "size_px", &Stress::size_px, 60, {160, 80, 60, 40, 30, 24, 20, 16}},
      {"noise", "Noise", "sigma_codes", &Stress::noise_codes, 0, {0, 1, 3, 5, 8, 12}},
      {"blur", "Defocus", "sigma_px", &Stress::blur_px, 0.5, {0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4}},
      {"motion", "Motion blur", "length_px", &Stress::motion_px, 0, {0, 2, 4, 8, 12}},
      {"tilt", "Tilt", "tilt_deg", &Stress::tilt_deg, 30, {0, 15, 30, 45, 60, 70, 75, 80, 85}, {}, 10},
      {"cover_dark", "Covered by a dark bar", "covered_percent", &Stress::covered_percent, 0, {0, 10, 20, 30, 40, 50}},
      {"cover_bright",
       "Covered by a bright bar",
       "covered_percent",
       &Stress::covered_percent,
       0,
       {0, 10, 20, 30, 40, 50},
       bright_bar},
      {"distortion", "Lens distortion", "k1", &Stress::k1, 0, {0, -0.1, -0.2, -0.3}},
      {"contrast", "Light of white over black", "ratio", &Stress::contrast, 20, {20, 8, 4, 2, 1.5, 1.25}},
  };
}

LadderRow measure(const Ladder& ladder, double level) {
  LadderRow row{level, {}};
  Stress easy = ladder.base, hard = ladder.base;
  easy.*ladder.value = std::max(ladder.easy, level - ladder.most_rise);
  hard.*ladder.value = level;
  each_clip(
      kClips, [&](unsigned seed) { return stress_clip(easy, hard, seed); }, {peers, rungs, followed},
      [&](const Clip& clip, const MethodResult& result) { add_result(clip, result, row); });
  return row;
}

}  // namespace

void measure_ladders(const std::optional<std::filesystem::path>& csv_folder) {
  std::puts(
      "Corner error, RMS per axis in px, and the share of frames found where it is not all. Unless the row says otherwise:\n"
      "tag of 60 px, tilt 25 deg, noise 3 codes, blur 0.7 px.");
  for (const Ladder& ladder : ladders()) {
    std::vector<LadderRow> rows;
    for (const double level : ladder.levels) rows.push_back(measure(ladder, level));
    print_table(ladder.title, ladder.level_name, rows);
    if (csv_folder) write_csv(*csv_folder / (std::string(ladder.file) + ".csv"), ladder.level_name, rows);
  }
}

}  // namespace catchlight::tracking
