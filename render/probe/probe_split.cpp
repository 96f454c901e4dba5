#include "render/probe/probe_split.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "catchlight/color.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/probe/light_clusters.hpp"
#include "render/probe/texel_rows.hpp"

namespace catchlight::render {
namespace {

constexpr int kMaxRings = 360;  // cells of half a degree
/// Display codes are about the 2.2nd root of light: an error of `tolerance` of white is this many times as large a share of the
/// light.
constexpr double kDisplayGamma = 2.2;
/// Finer than this no shadow map tells samples apart: an eighth of the sun's disc.
constexpr double kFinestSample_sr = 8e-6;
/// Texels are divided until each sample has about as many pieces to be cut from.
constexpr int kPiecesPerSample = 8;

double luminance_of(const float* radiance) {
  return glm::dot(kLuminanceWeights, glm::dvec3(radiance[0], radiance[1], radiance[2]));
}

// Luminance gathered in cells.
struct Brightness {
  SphereGrid grid;
  std::vector<int> cell_of;  // the cell of each texel; kNoCluster outside the layout
  std::vector<double> solid_angle_sr, luminance;
};

// Sets sky.cell_of. A latlong's row lies in one ring, and its columns in the same turns in every row.
void find_cells(ProbeLayout layout, int width, const TexelRows& texels, Brightness& sky) {
  const int height = static_cast<int>(sky.cell_of.size()) / width;
  std::vector<double> turns;
  for (int x = 0; layout == ProbeLayout::latlong && x < width; ++x)
    turns.push_back(SphereGrid::turn_of(*texels.direction(x, height / 2)));
  parallel_for(height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    int* cells = &sky.cell_of[row * width];
    const int ring = turns.empty() ? 0 : sky.grid.ring_at(texels.direction(0, y)->y);
    for (int x = 0; x < width; ++x) {
      if (!turns.empty())
        cells[x] = sky.grid.cell_at(ring, turns[x]);
      else if (const auto direction = texels.direction(x, y))
        cells[x] = sky.grid.cell_of(*direction);
    }
  });
}

Brightness gather(const Probe& probe) {
  const int width = probe.image.width, height = probe.image.height;
  // No finer than the probe, or cells between its texels would tear lights apart.
  const int rings = std::clamp(static_cast<int>(std::sqrt(width * static_cast<double>(height)) / 3), 6, kMaxRings);
  Brightness sky{SphereGrid(rings), std::vector<int>(static_cast<std::size_t>(width) * height, kNoCluster), {}, {}};
  const TexelRows texels(probe.layout, width, height);
  find_cells(probe.layout, width, texels, sky);
  sky.solid_angle_sr.resize(sky.grid.cells());
  sky.luminance.resize(sky.grid.cells());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int cell = sky.cell_of[static_cast<std::size_t>(y) * width + x];
      if (cell == kNoCluster) continue;
      const double solid_angle = texels.solid_angle(x, y);
      sky.solid_angle_sr[cell] += solid_angle;
      sky.luminance[cell] += solid_angle * luminance_of(probe.image.pixel(x, y));
    }
  }
  for (int cell = 0; cell < sky.grid.cells(); ++cell)
    if (sky.solid_angle_sr[cell] > 0) sky.luminance[cell] /= sky.solid_angle_sr[cell];
  return sky;
}

double flux_below(const Brightness& sky, double limit) {
  double sum = 0;
  for (std::size_t cell = 0; cell < sky.luminance.size(); ++cell)
    sum += sky.solid_angle_sr[cell] * std::min(sky.luminance[cell], limit);
  return sum;
}

// The largest t = contrast * mean(min(luminance, t)).
double find_threshold(const Brightness& sky, double total_flux) {
  double threshold = kLightContrast * total_flux / (4 * glm::pi<double>());
  for (int i = 0; i < 100; ++i) {
    const double next = kLightContrast * flux_below(sky, threshold) / (4 * glm::pi<double>());
    if (next > 0.999 * threshold) break;
    threshold = next;
  }
  return threshold;
}

// Share of a cluster's energy that `bands` bands hold: near 0 for a small light, near 1 for one wider than they resolve.
std::vector<double> energy_held(const Brightness& sky, const LightClusters& clusters, double threshold, int bands) {
  std::vector<double> energy(clusters.count), held(clusters.count);
  const int count = sh_count(bands);
  std::vector<double> coefficients(static_cast<std::size_t>(clusters.count) * count), basis(count);
  for (int cell = 0; cell < sky.grid.cells(); ++cell) {
    const int cluster = clusters.cluster_of[cell];
    if (cluster == kNoCluster) continue;
    const double light = (sky.luminance[cell] - threshold) * sky.solid_angle_sr[cell];
    energy[cluster] += light * light / sky.solid_angle_sr[cell];
    evaluate_sh(sky.grid.middle_of(cell), bands, std::span<double>(basis));
    for (int l = 0; l < bands; ++l) {
      // A cell is no point: a square's variance along an axis is a twelfth of its area, and blurs band l as a Gaussian's does.
      const double blur = std::exp(-l * (l + 1) * sky.solid_angle_sr[cell] / 24);
      for (int i = sh_index(l, -l); i <= sh_index(l, l); ++i)
        coefficients[static_cast<std::size_t>(cluster) * count + i] += light * blur * basis[i];
    }
  }
  for (int cluster = 0; cluster < clusters.count; ++cluster) {
    for (int i = 0; i < count; ++i) held[cluster] += std::pow(coefficients[static_cast<std::size_t>(cluster) * count + i], 2);
    held[cluster] = std::min(held[cluster] / energy[cluster], 1.0);
  }
  return held;
}

// The share (ProbeLight::share) of each cluster, 0 where splitting it off would not be seen.
std::vector<double> shares_that_pay(const Brightness& sky, const LightClusters& clusters, double threshold, double total_flux,
                                    const SplitOptions& options) {
  std::vector<double> shares(clusters.count);
  for (int cell = 0; cell < sky.grid.cells(); ++cell) {
    const int cluster = clusters.cluster_of[cell];
    if (cluster != kNoCluster) shares[cluster] += (sky.luminance[cell] - threshold) * sky.solid_angle_sr[cell];
  }
  const std::vector<double> held = energy_held(sky, clusters, threshold, options.bands);
  for (int cluster = 0; cluster < clusters.count; ++cluster) {
    shares[cluster] *= 4 / total_flux;  // an average surface's irradiance is a quarter of the flux
    if (shares[cluster] * std::sqrt(1 - held[cluster]) < kDisplayGamma * options.tolerance) shares[cluster] = 0;
  }
  return shares;
}

// Samples per light in proportion to its share, until their steps cannot be seen or the budget is spent.
std::vector<int> sample_counts(const std::vector<ProbeLight>& lights, const SplitOptions& options) {
  double step = kDisplayGamma * options.tolerance;
  const auto counts_for = [&](double each) {
    std::vector<int> counts;
    for (const ProbeLight& light : lights)
      counts.push_back(static_cast<int>(
          std::ceil(std::clamp(light.share / each, 1.0, std::max(light.solid_angle_sr / kFinestSample_sr, 1.0)))));
    return counts;
  };
  std::vector<int> counts = counts_for(step);
  while (std::accumulate(counts.begin(), counts.end(), 0) > std::max(options.max_samples, static_cast<int>(lights.size())))
    counts = counts_for(step *= 1.05);
  return counts;
}

// A light's outermost texels may lie in cells that are too dim as a whole: those go to their brightest neighbour's cluster.
std::vector<int> with_rims(const Brightness& sky, const LightClusters& clusters) {
  std::vector<int> cluster_of = clusters.cluster_of;
  for (int cell = 0; cell < sky.grid.cells(); ++cell) {
    if (clusters.cluster_of[cell] != kNoCluster) continue;
    double brightest = 0;
    for (const int neighbour : sky.grid.neighbours(cell)) {
      if (clusters.cluster_of[neighbour] == kNoCluster || sky.luminance[neighbour] <= brightest) continue;
      brightest = sky.luminance[neighbour];
      cluster_of[cell] = clusters.cluster_of[neighbour];
    }
  }
  return cluster_of;
}

struct Cluster {
  double share = 0;
  std::vector<glm::ivec2> texels;
};

// Clusters worth a light, brightest first, with their texels brighter than the threshold.
std::vector<Cluster> worthy_clusters(const Probe& probe, const Brightness& sky, double threshold, double total_flux,
                                     const SplitOptions& options) {
  const double negligible = kDisplayGamma * options.tolerance * total_flux / 4;
  const LightClusters clusters = cluster_lights(sky.grid, sky.luminance, sky.solid_angle_sr, threshold, negligible);
  const std::vector<double> shares = shares_that_pay(sky, clusters, threshold, total_flux, options);
  const std::vector<int> cluster_at = with_rims(sky, clusters);
  std::vector<Cluster> found(clusters.count);
  for (int i = 0; i < clusters.count; ++i) found[i].share = shares[i];
  for (int y = 0; y < probe.image.height; ++y) {
    for (int x = 0; x < probe.image.width; ++x) {
      const int cell = sky.cell_of[static_cast<std::size_t>(y) * probe.image.width + x];
      if (cell == kNoCluster || cluster_at[cell] == kNoCluster) continue;
      if (luminance_of(probe.image.pixel(x, y)) > threshold) found[cluster_at[cell]].texels.emplace_back(x, y);
    }
  }
  std::erase_if(found, [](const Cluster& cluster) { return cluster.share == 0 || cluster.texels.empty(); });
  std::ranges::stable_sort(found, std::greater{}, &Cluster::share);
  if (found.size() > static_cast<std::size_t>(options.max_samples)) found.resize(options.max_samples);
  return found;
}

// Share of a texel's radiance that stays when it is cut down to the threshold.
float kept_share(const float* radiance, double threshold) {
  return static_cast<float>(threshold / luminance_of(radiance));
}

void cut_down(const Cluster& cluster, double threshold, Probe& probe) {
  for (const glm::ivec2& texel : cluster.texels) {
    float* radiance = probe.image.pixel(texel.x, texel.y);
    const float kept = kept_share(radiance, threshold);
    for (int c = 0; c < 3; ++c) radiance[c] *= kept;
  }
}

// Luminance times solid angle of the texel's light above the threshold.
double flux_above(const Probe& probe, const glm::ivec2& texel, double threshold) {
  return (luminance_of(probe.image.pixel(texel.x, texel.y)) - threshold) *
         texel_solid_angle(probe.layout, probe.image.width, probe.image.height, texel.x, texel.y);
}

// What cut_down takes, in at least `wanted` pieces, none with much more of the light than others: a sun of few texels within a
// bright sky is divided too.
std::vector<LightPiece> pieces_above(const Cluster& cluster, double threshold, int wanted, const Probe& probe) {
  const int width = probe.image.width, height = probe.image.height;
  double total = 0;
  for (const glm::ivec2& texel : cluster.texels) total += flux_above(probe, texel, threshold);
  std::vector<LightPiece> pieces;
  for (const glm::ivec2& texel : cluster.texels) {
    const double pieces_here = wanted * flux_above(probe, texel, threshold) / total;
    const int across = static_cast<int>(std::ceil(std::sqrt(std::max(pieces_here, 1.0))));
    const float* radiance = probe.image.pixel(texel.x, texel.y);
    const float kept = kept_share(radiance, threshold);
    glm::dvec3 taken;
    for (int c = 0; c < 3; ++c) taken[c] = static_cast<double>(radiance[c]) - static_cast<double>(radiance[c] * kept);
    const double solid_angle = texel_solid_angle(probe.layout, width, height, texel.x, texel.y) / (across * across);
    const auto middle = direction_from_texel(probe.layout, width, height, texel.x, texel.y);
    for (int i = 0; i < across * across; ++i) {
      const glm::dvec2 within = (glm::dvec2(i % across, i / across) + 0.5) / static_cast<double>(across) - 0.5;
      const auto direction = direction_from_texel(probe.layout, width, height, texel.x + within.x, texel.y + within.y);
      pieces.push_back({direction.value_or(*middle), solid_angle * taken, solid_angle});
    }
  }
  return pieces;
}

}  // namespace

SplitProbe split_lights(const Probe& probe, const SplitOptions& options) {
  SplitProbe split{{}, probe, probe, 0};
  const Brightness sky = gather(probe);
  const double total_flux = flux_below(sky, INFINITY);
  if (!(total_flux > 0) || options.max_samples < 1) return split;
  split.threshold = find_threshold(sky, total_flux);
  const std::vector<Cluster> clusters = worthy_clusters(probe, sky, split.threshold, total_flux, options);
  for (const Cluster& cluster : clusters) {
    ProbeLight& light = split.lights.emplace_back();
    light.share = cluster.share;
    for (const glm::ivec2& texel : cluster.texels)
      light.solid_angle_sr += texel_solid_angle(probe.layout, probe.image.width, probe.image.height, texel.x, texel.y);
  }
  const std::vector<int> counts = sample_counts(split.lights, options);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const std::vector<LightPiece> pieces = pieces_above(clusters[i], split.threshold, kPiecesPerSample * counts[i], probe);
    cut_down(clusters[i], split.threshold, split.rest);
    const LightSample whole = median_cut(pieces, 1).front();
    split.lights[i].direction = whole.direction;
    split.lights[i].irradiance = whole.irradiance;
    split.lights[i].samples = median_cut(pieces, counts[i]);
    split.lights[i].compact = std::ranges::all_of(
        split.lights[i].samples, [](const LightSample& sample) { return sample.spread_rad <= kCompactSpread_rad; });
    for (LightSample& sample : split.lights[i].samples) sample.compact = split.lights[i].compact;
    if (split.lights[i].compact) cut_down(clusters[i], split.threshold, split.mirrored);
  }
  return split;
}

std::vector<LightSample> samples_of(const SplitProbe& split, const glm::dmat3& rotation) {
  std::vector<LightSample> samples;
  for (const ProbeLight& light : split.lights) {
    for (LightSample sample : light.samples) {
      sample.direction = rotation * sample.direction;
      samples.push_back(sample);
    }
  }
  return samples;
}

}  // namespace catchlight::render
