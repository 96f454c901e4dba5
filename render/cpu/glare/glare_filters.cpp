#include "render/cpu/glare/glare_filters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catchlight::render {
namespace {

/// Weights of the four texels from one after `first` to two before it, for what lies `f` of a texel before `first`: Catmull and
/// Rom's cubic.
std::array<double, 4> between_texels(double f) {
  return {f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2.0 - 1.5 * f)),
          f * f * (-0.5 + 0.5 * f)};
}

/// One of the samples that are added up: a texel of the source that lies so far to the left and above, and its weight.
struct Sample {
  int right, down;
  Float4 weight;
};

std::vector<Sample> samples_of(const StreakSamples& pass) {
  std::vector<Sample> samples;
  glm::dvec3 weight = pass.gain;
  const bool along_x = std::abs(pass.pace.x) >= std::abs(pass.pace.y);
  for (int s = 0; s < pass.count; ++s, weight *= pass.falloff) {
    const glm::dvec2 behind = static_cast<double>(s) * pass.pace, whole = glm::floor(behind), rest = behind - whole;
    const int right = static_cast<int>(whole.x), down = static_cast<int>(whole.y);
    const std::array<double, 4> shares = between_texels(along_x ? rest.y : rest.x);
    for (int k = 0; k < 4; ++k) {
      const double share = shares[static_cast<std::size_t>(k)];
      const int across = k - 1;
      if (share != 0)
        samples.push_back({along_x ? right : right + across, along_x ? down + across : down, float4(share * weight)});
    }
  }
  return samples;
}

}  // namespace

void fit(GlarePicture& picture, const GlarePicture& like) {
  if (picture.columns() != like.columns() || picture.rows() != like.rows()) picture = GlarePicture(like.columns(), like.rows());
  picture.clear();
}

void add_blurred(const GlarePicture& from, const std::vector<double>& taps, double weight, GlarePicture& scratch,
                 GlarePicture& to, const PixelRect& reached) {
  const int radius = static_cast<int>(taps.size()) - 1;
  const auto tap = [&](int d) { return taps[static_cast<std::size_t>(std::abs(d))]; };
  if (radius > 0) scratch.clear();
  for (int y = 0; radius > 0 && y < from.rows(); ++y)
    for (int d = -radius; d <= radius; ++d) scratch.add(y, from, y, d, splat(tap(d)), scratch.all_columns());
  const GlarePicture& rows = radius > 0 ? scratch : from;
  for (int y = reached.y; y < reached.y + reached.height; ++y)
    for (int d = -radius; d <= radius; ++d) to.add(y, rows, y + d, 0, splat(weight * tap(d)), columns_of(reached));
}

void add_streak_pass(const GlarePicture& from, const StreakSamples& pass, GlarePicture& to, const PixelRect& reached) {
  const std::vector<Sample> samples = samples_of(pass);
  for (int y = reached.y; y < reached.y + reached.height; ++y)
    for (const Sample& each : samples) to.add(y, from, y - each.down, each.right, each.weight, columns_of(reached));
}

std::vector<LinearSamples> linear_samples(int count, int texels) {
  std::vector<LinearSamples> samples;
  for (int i = 0; i < count; ++i) {
    const double at = std::clamp((i + 0.5) * texels / count - 0.5, 0.0, texels - 1.0), first = std::floor(at);
    samples.push_back(
        {static_cast<int>(first), std::min(static_cast<int>(first) + 1, texels - 1), static_cast<float>(at - first)});
  }
  return samples;
}

void add_between(const GlarePicture& from, const LinearSamples& down, const std::vector<LinearSamples>& across, float weight,
                 Float4* to) {
  std::vector<Float4> line(static_cast<std::size_t>(from.columns()));
  bool is_lit = false;
  const auto add = [&](int y, float share) {
    const Span lit = from.lit(y);
    for (int x = lit.begin; x < lit.end; ++x) line[static_cast<std::size_t>(x)] += share * from.row(y)[x];
    is_lit |= !lit.empty();
  };
  add(down.first, weight * (1 - down.share));
  add(down.second, weight * down.share);
  if (!is_lit) return;
  for (std::size_t i = 0; i < across.size(); ++i) {
    const Float4 a = line[static_cast<std::size_t>(across[i].first)], b = line[static_cast<std::size_t>(across[i].second)];
    to[i] += a + across[i].share * (b - a);
  }
}

}  // namespace catchlight::render
