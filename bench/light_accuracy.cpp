// How far light held by spherical harmonics is from all of the probe's light, traced by brute force: for 3 to 10 bands, with and
// without lights split off. docs/light.md explains the figures. Prints a table a probe; --csv FILE also writes them all there.
// Probes: those named, else the eight of Debian's blender-data.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "bench/accuracy/light_scene.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/parallel.hpp"
#include "render/probe/probe_split.hpp"

namespace {

using namespace catchlight;
using namespace catchlight::render;

constexpr int kMinBands = 3;
constexpr int kRays = 1024;  // rays a vertex, as the program's default
constexpr double kTolerance = 0.004;
constexpr int kMaxSamples = 96;
const std::filesystem::path kBlenderProbes = "/usr/share/blender/datafiles/studiolights/world";

double luminance_of(const glm::dvec3& rgb) {
  return glm::dot(kLuminanceWeights, rgb);
}

/// Scene, and its transfer baked twice from different rays.
struct Baked {
  LightScene scene;
  Transfer transfer, other;
};

/// Light for a number of bands: what the transfer carries, and the samples that are traced.
struct Light {
  int bands;
  std::vector<double> coefficients;  // luminance
  std::vector<LightSample> samples;  // tag frame
  int lights = 0;
};

struct Values {
  std::vector<double> object, ground;  // irradiance / pi; irradiance relative to the unshadowed one
};

struct Figures {
  double rms = 0, most = 0, noise = 0;  // %
};

Light light_of(const Probe& probe, const glm::dmat3& tag_from_probe, int bands, bool is_split) {
  Light light{bands, {}, {}, 0};
  if (is_split) {
    const SplitProbe split = split_lights(probe, {bands, kTolerance, kMaxSamples});
    light.samples = samples_of(split, tag_from_probe);
    light.lights = static_cast<int>(split.lights.size());
  }
  const ShRgb whole = rotate_sh(project_to_sh(probe, bands), tag_from_probe), taken = project_to_sh(light.samples, bands);
  for (std::size_t i = 0; i < whole.size(); ++i) light.coefficients.push_back(luminance_of(whole[i] - taken[i]));
  return light;
}

/// What the bands bring, as the program lights: they ring below zero around strong lights, light cannot.
double smooth_part(const Light& light, const glm::vec3* transfer) {
  double sum = 0;
  for (std::size_t i = 0; i < light.coefficients.size(); ++i) sum += light.coefficients[i] * transfer[i].x;
  return std::max(sum, 0.0);
}

double traced_part(const LightScene& scene, const SeenPoint& point, const std::vector<LightSample>& samples) {
  std::vector<Ray> rays;
  for (const LightSample& sample : samples) rays.push_back({sample.direction, luminance_of(sample.irradiance)});
  return brute_force(scene, point, rays);
}

double unshadowed_ground(const Light& light, const Transfer& transfer) {
  double sum = 0;
  for (std::size_t i = 0; i < light.coefficients.size(); ++i) sum += light.coefficients[i] * transfer.receiver_unshadowed[i];
  sum = std::max(sum, 0.0);
  for (const LightSample& sample : light.samples)
    sum += luminance_of(sample.irradiance) * std::max(sample.direction.z, 0.0) / glm::pi<double>();
  return sum;
}

Values lit(const LightScene& scene, const Transfer& transfer, const Light& light) {
  const std::size_t stride = sh_count(transfer.bands);
  Values values;
  for (const SeenPoint& point : scene.object)
    values.object.push_back(smooth_part(light, &transfer.object[point.index * stride]) +
                            traced_part(scene, point, light.samples));
  const double open = unshadowed_ground(light, transfer);
  for (const SeenPoint& point : scene.ground) {
    const double irradiance =
        smooth_part(light, &transfer.receiver[point.index * stride]) + traced_part(scene, point, light.samples);
    values.ground.push_back(open > 0 ? irradiance / open : 1.0);
  }
  return values;
}

Values truth(const LightScene& scene, const std::vector<Ray>& rays) {
  Values values{std::vector<double>(scene.object.size()), std::vector<double>(scene.ground.size())};
  const double open = unshadowed({0, 0, 1}, rays);
  parallel_for(scene.object.size(), 0, [&](std::size_t i) { values.object[i] = brute_force(scene, scene.object[i], rays); });
  parallel_for(scene.ground.size(), 0,
               [&](std::size_t i) { values.ground[i] = open > 0 ? brute_force(scene, scene.ground[i], rays) / open : 1.0; });
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// The differences in percent of `unit`.
Figures compare(const std::vector<double>& ours, const std::vector<double>& other_bake, const std::vector<double>& true_values,
                double unit) {
  Figures figures{100 * rms_difference(ours, true_values) / unit, 0,
                  100 * rms_difference(ours, other_bake) / std::sqrt(2.0) / unit};
  for (std::size_t i = 0; i < ours.size(); ++i)
    figures.most = std::max(figures.most, 100 * std::abs(ours[i] - true_values[i]) / unit);
  return figures;
}

void measure(const Baked& baked, const std::filesystem::path& file, std::ofstream& csv) {
  const Probe probe = load_probe(file.string(), {}, {});
  const glm::dmat3 turn = tag_from_probe(UpAxis::z, 0);
  const Values exact = truth(baked.scene, rays_of(probe, turn));
  std::printf("\n%s\n\n", file.stem().c_str());
  std::printf("| bands | lights | samples | object RMS | max | bake noise | shadow RMS | max | bake noise |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (const bool is_split : {false, true}) {
    for (int bands = kMinBands; bands <= kMaxShBands; ++bands) {
      const Light light = light_of(probe, turn, bands, is_split);
      const Values ours = lit(baked.scene, baked.transfer, light), other = lit(baked.scene, baked.other, light);
      const Figures object = compare(ours.object, other.object, exact.object, mean(exact.object));
      const Figures ground = compare(ours.ground, other.ground, exact.ground, 1.0);
      std::printf("| %d | %d | %zu | %.2f | %.1f | %.3f | %.2f | %.1f | %.3f |\n", bands, light.lights, light.samples.size(),
                  object.rms, object.most, object.noise, ground.rms, ground.most, ground.noise);
      csv << file.stem().string() << ',' << bands << ',' << (is_split ? "split" : "whole") << ',' << light.lights << ','
          << light.samples.size() << ',' << object.rms << ',' << object.most << ',' << object.noise << ',' << ground.rms << ','
          << ground.most << ',' << ground.noise << '\n';
    }
  }
  std::fflush(stdout);
}

std::vector<std::filesystem::path> blender_probes() {
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(kBlenderProbes, missing))
    if (entry.path().extension() == ".exr") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty())
    std::fprintf(stderr, "light_accuracy: no probes in %s (apt-get install blender-data); name some\n", kBlenderProbes.c_str());
  return files;
}

void run(std::vector<std::string> arguments) {
  std::ofstream csv;
  if (!arguments.empty() && arguments[0] == "--csv") {
    if (arguments.size() < 2) throw UsageError("usage: light_accuracy [--csv FILE] [PROBE...]");
    csv.open(arguments[1]);
    if (!csv) throw Error(arguments[1] + ": cannot be written");
    arguments.erase(arguments.begin(), arguments.begin() + 2);
  }
  const std::vector<std::filesystem::path> files =
      arguments.empty() ? blender_probes() : std::vector<std::filesystem::path>(arguments.begin(), arguments.end());
  csv << "probe,bands,light,lights,samples,object_rms,object_max,object_noise,shadow_rms,shadow_max,shadow_noise\n";
  Baked baked{make_light_scene(), {}, {}};
  TransferOptions options{.bands = kMaxShBands, .rays = kRays, .receiver_albedo = {}};
  baked.transfer = bake_transfer(baked.scene.mesh, baked.scene.grid, options, {});
  options.seed = 2;
  baked.other = bake_transfer(baked.scene.mesh, baked.scene.grid, options, {});
  std::printf("%zu points on the object, %zu on the ground\n", baked.scene.object.size(), baked.scene.ground.size());
  for (const std::filesystem::path& file : files) measure(baked, file, csv);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run({argv + 1, argv + argc});
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
