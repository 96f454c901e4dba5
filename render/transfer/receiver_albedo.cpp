#include "render/transfer/receiver_albedo.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

// Raise when what is found changes: older files then no longer match.
constexpr std::uint32_t kVersion = 1;

constexpr int kColumns = 180, kRows = 45;  // texels of two degrees
constexpr int kSubsamples = 3;             // samples along each side of a texel
/// Share that may come back of the light that reaches the plane: 1 in truth, but probes and planes are not perfect.
constexpr double kMaxSentBack = 1.2;
/// Rounded to this, an albedo does not depend on the scale that the probe is in.
constexpr double kAlbedoStep = 1.0 / 1024;

// The direction towards texel position (x, y), corners at integers.
glm::dvec3 direction_at(double x, double y) {
  const double from_nadir = y / kRows * glm::half_pi<double>(), turn = x / kColumns * glm::two_pi<double>();
  return {std::sin(from_nadir) * std::cos(turn), std::sin(from_nadir) * std::sin(turn), -std::cos(from_nadir)};
}

glm::dvec3 mean_radiance(const Probe& probe, const glm::dmat3& probe_from_tag, int x, int y) {
  glm::dvec3 sum(0);
  for (int i = 0; i < kSubsamples * kSubsamples; ++i) {
    const glm::dvec2 within = (glm::dvec2(i % kSubsamples, i / kSubsamples) + 0.5) / static_cast<double>(kSubsamples);
    sum += glm::dvec3(sample(probe, probe_from_tag * direction_at(x + within.x, y + within.y)));
  }
  return sum / static_cast<double>(kSubsamples * kSubsamples);
}

}  // namespace

glm::vec3 ReceiverAlbedo::at(const glm::vec2& place_m) const {
  return towards(glm::vec3(place_m, 0.0f) - seen_from_m);
}

glm::vec3 ReceiverAlbedo::towards(const glm::vec3& direction) const {
  const float from_nadir = std::atan2(glm::length(glm::vec2(direction)), -direction.z) / glm::half_pi<float>();
  const float turn = std::atan2(direction.y, direction.x) / glm::two_pi<float>();
  const int row = std::clamp(static_cast<int>(from_nadir * image.height), 0, image.height - 1);
  const int column = std::clamp(static_cast<int>((turn - std::floor(turn)) * image.width), 0, image.width - 1);
  const float* rgb = image.pixel(column, row);
  return {rgb[0], rgb[1], rgb[2]};
}

ReceiverAlbedo constant_albedo(const glm::vec3& albedo) {
  ReceiverAlbedo constant{glm::vec3(0, 0, 1), Image(1, 1)};
  for (int c = 0; c < 3; ++c) constant.image.data[c] = albedo[c];
  return constant;
}

std::optional<ReceiverAlbedo> albedo_from_probe(const Probe& probe, const glm::dmat3& tag_from_probe,
                                                const glm::vec3& probe_in_tag_m) {
  if (!(probe_in_tag_m.z > 0)) return std::nullopt;
  const glm::dmat3 probe_from_tag = glm::transpose(tag_from_probe);
  const glm::dvec3 arriving = irradiance(probe, probe_from_tag * glm::dvec3(0, 0, 1));
  const glm::dvec3 leaving = irradiance(probe, probe_from_tag * glm::dvec3(0, 0, -1));
  for (int c = 0; c < 3; ++c)
    if (leaving[c] > kMaxSentBack * arriving[c]) return std::nullopt;
  ReceiverAlbedo albedo{probe_in_tag_m, Image(kColumns, kRows)};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const glm::dvec3 radiance = mean_radiance(probe, probe_from_tag, x, y);
      for (int c = 0; c < 3; ++c) {
        const double share = arriving[c] > 0 ? glm::pi<double>() * radiance[c] / arriving[c] : 0.0;
        albedo.image.pixel(x, y)[c] = static_cast<float>(std::round(std::min(share, 1.0) / kAlbedoStep) * kAlbedoStep);
      }
    }
  }
  return albedo;
}

std::optional<ReceiverAlbedo> load_or_find_albedo(const Probe& probe, const std::string& probe_key,
                                                  const glm::dmat3& tag_from_probe, const glm::vec3& probe_in_tag_m,
                                                  const ContentCache& cache, const WarningHandler& warn) {
  ContentHash hash;
  hash.add(kVersion);
  hash.add_bytes(probe_key.data(), probe_key.size());
  hash.add(tag_from_probe);
  hash.add(probe_in_tag_m);
  // Without an image there is no such surface.
  const auto make = [&] { return albedo_from_probe(probe, tag_from_probe, probe_in_tag_m).value_or(ReceiverAlbedo{}); };
  const auto archive = [](CacheStream& file, ReceiverAlbedo& albedo) {
    file(albedo.seen_from_m);
    file(albedo.image.width);
    file(albedo.image.height);
    file(albedo.image.data);
  };
  ReceiverAlbedo albedo = cache.get<ReceiverAlbedo>("albedo", hash.text(), warn, make, archive);
  return albedo.known() ? std::optional(std::move(albedo)) : std::nullopt;
}

}  // namespace catchlight::render
