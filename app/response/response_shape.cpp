// From points to a curve: mended, scaled, evenly spaced.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/response/response_points.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kChannels[] = {"red", "green", "blue"};
constexpr double kMaxMended = 0.05;  ///< share of white; larger dips are no noise

struct Dip {
  double depth = 0;  ///< how far mending moved a point, at most
  std::size_t first = 0, last = 0;
};

/// The dip that says where and how far a sequence was changed.
Dip compare(const std::vector<double>& before, const std::vector<double>& after) {
  Dip dip;
  bool is_found = false;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] == after[i]) continue;
    if (!is_found) dip.first = i;
    is_found = true;
    dip.last = i;
    dip.depth = std::max(dip.depth, std::abs(after[i] - before[i]));
  }
  return dip;
}

/// Returns a text for the user where something was mended.
std::string mend(ResponsePoints& points, std::size_t channel, const std::string& path) {
  std::vector<double>& light = points.light[channel];
  const std::vector<double> mended = isotonic(light);
  const double range = mended.back() - mended.front();
  const Dip dip = compare(light, mended);
  const std::string where = std::string(kChannels[channel]) + " does not rise between codes " +
                            plain_text(points.codes[dip.first]) + " and " + plain_text(points.codes[dip.last]);
  if (!(range > 0) || dip.depth > kMaxMended * range)
    throw Error(
        path + ": " + where + " (0 to 1), by " + (range > 0 ? fixed_text(100 * dip.depth / range, 1) + " % of white" : "all") +
        "; expected light that rises with the code: calibrate again with more samples or exposures, or check the column order");
  light = mended;
  return dip.depth > 0 ? where + ", by " + fixed_text(100 * dip.depth / range, 2) + " % of white" : "";
}

bool is_even(const std::vector<double>& codes) {
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (std::abs(codes[i] * static_cast<double>(codes.size() - 1) - static_cast<double>(i)) > 1e-6) return false;
  return true;
}

double interpolated(const std::vector<double>& codes, const std::vector<double>& light, double code) {
  const auto above = std::upper_bound(codes.begin() + 1, codes.end() - 1, code);
  const auto i = static_cast<std::size_t>(above - codes.begin());
  return light[i - 1] + (code - codes[i - 1]) / (codes[i] - codes[i - 1]) * (light[i] - light[i - 1]);
}

/// Resamples the points at every code of 16 bits, which has those of 8 bits among them.
void make_even(ResponsePoints& points) {
  constexpr int kCodes = 65536;
  ResponsePoints even;
  for (int i = 0; i < kCodes; ++i) {
    even.codes.push_back(i / static_cast<double>(kCodes - 1));
    for (std::size_t c = 0; c < 3; ++c) even.light[c].push_back(interpolated(points.codes, points.light[c], even.codes.back()));
  }
  points.codes = std::move(even.codes), points.light = std::move(even.light);
}

/// Every code has light of its own, be it by one bit: so that codes survive the way to light and back.
void push_above(std::vector<float>& table, float light) {
  constexpr float kMinStep = 1e-30f;  // far above what a GPU takes for 0
  if (!table.empty() && !(light > table.back()))
    light = std::max(std::nextafter(table.back(), std::numeric_limits<float>::max()), table.back() + kMinStep);
  table.push_back(light);
}

}  // namespace

std::vector<double> isotonic(const std::vector<double>& values) {
  struct Block {
    double sum;
    std::size_t count;
    double mean() const { return sum / static_cast<double>(count); }
  };
  std::vector<Block> blocks;
  for (const double value : values) {
    blocks.push_back({value, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean() > blocks.back().mean()) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().sum += last.sum, blocks.back().count += last.count;
    }
  }
  std::vector<double> result;
  for (const Block& block : blocks) result.insert(result.end(), block.count, block.mean());
  return result;
}

ResponseCurve curve_of(ResponsePoints points, const std::string& path, const WarningHandler& warn) {
  std::string mended;
  for (std::size_t c = 0; c < 3; ++c)
    if (const std::string what = mend(points, c, path); !what.empty()) mended += (mended.empty() ? "" : "; ") + what;
  if (!mended.empty() && warn) warn(path + ": " + mended + "; mended by the nearest curve that rises");
  if (warn && points.light[1][points.codes.size() / 2] > 0.6 * points.light[1].back())
    warn(path +
         ": half the highest code is more than half its light, as of a curve from light to codes; expected one from codes to "
         "light");
  if (!is_even(points.codes)) make_even(points);
  ResponseCurve::Tables tables;
  for (std::size_t c = 0; c < 3; ++c) {
    const double scale = points.is_measured ? 1 / points.light[c].back() : 1;
    for (const double light : points.light[c]) push_above(tables[c], static_cast<float>(light * scale));
  }
  return ResponseCurve(std::move(tables));
}

}  // namespace catchlight::app
