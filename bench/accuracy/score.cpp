#include "bench/accuracy/score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "catchlight/error.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kStrayPx = 5;

std::string cell(const Score& score) {
  char text[64];
  if (score.found == 0) return "lost";
  const int length = std::snprintf(text, sizeof text, "%.3f", score.rms_per_axis_px());
  if (score.found < score.frames)
    std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length), " %.0f%%", score.found_percent());
  return text;
}

}  // namespace

void Score::add(const std::optional<Estimate>& estimate, const Corners& truth_px) {
  ++frames;
  if (!estimate) return;
  const double off_px = rms_distance(estimate->corners_px, truth_px);
  if (!(off_px < kStrayPx)) {
    ++stray;
    return;
  }
  ++found;
  squares_px2 += off_px * off_px;
  bias_px += tracking::outward_bias_px(estimate->corners_px, truth_px);
}

double Score::rms_2d_px() const {
  return std::sqrt(squares_px2 / found);
}

double Score::rms_per_axis_px() const {
  return rms_2d_px() / std::sqrt(2.0);
}

double Score::outward_bias_px() const {
  return bias_px / found;
}

void add_result(const Clip& clip, const MethodResult& result, LadderRow& row) {
  auto known =
      std::find_if(row.methods.begin(), row.methods.end(), [&](const auto& each) { return each.method == result.method; });
  if (known == row.methods.end()) known = row.methods.insert(known, {result.method, {}});
  for (std::size_t i = 0; i < clip.frames.size(); ++i)
    if (clip.frames[i].judged)
      known->score.add(result.estimates[i], true_corners_px(clip.camera, {clip.target, clip.frames[i].camera_from_tag}));
}

void print_table(const std::string& title, const std::string& level_name, const std::vector<LadderRow>& rows) {
  std::printf("\n%s\n%16s", title.c_str(), level_name.c_str());
  for (const NamedScore& each : rows.at(0).methods) std::printf(" %16s", each.method.c_str());
  std::printf("\n");
  for (const LadderRow& row : rows) {
    std::printf("%16g", row.level);
    for (const NamedScore& each : row.methods) std::printf(" %16s", cell(each.score).c_str());
    std::printf("\n");
  }
  std::fflush(stdout);
}

void write_csv(const std::filesystem::path& file, const std::string& level_name, const std::vector<LadderRow>& rows) {
  std::ofstream out(file);
  out << level_name << ",method,rms_per_axis_px,rms_2d_px,outward_bias_px,found_percent,stray_percent,frames\n";
  for (const LadderRow& row : rows)
    for (const auto& [method, score] : row.methods) {
      out << row.level << ",\"" << method << "\",";
      if (score.found > 0)
        out << score.rms_per_axis_px() << ',' << score.rms_2d_px() << ',' << score.outward_bias_px();
      else
        out << ",,";
      out << ',' << score.found_percent() << ',' << score.stray_percent() << ',' << score.frames << '\n';
    }
  if (!out.flush()) throw Error("cannot write " + file.string() + "; is its folder there?");
}

}  // namespace catchlight::tracking
