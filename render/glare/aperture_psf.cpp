#include "render/glare/aperture_psf.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "catchlight/error.hpp"
#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr int kMinPicture_px = 512, kMaxPicture_px = 4096, kMaxTransform_px = 8192;
/// Distance of the far field's samples at the longest wave.
constexpr double kSample_px = 0.75;
/// Smallest padding, in picture widths: with less, rings finer than a pixel would beat against the samples.
constexpr double kPadding = 1.5;
/// Share of the reach at which fading sets in.
constexpr double kFadeStart = 0.75;
constexpr int kMinWaves = 40, kWaveSteps = 5;

double pixels_per_cycle(const ApertureOptics& optics, double wavelength_nm) {
  return wavelength_nm * 1e-6 / optics.aperture_mm * optics.focal_px;
}

double lobe(double wavelength_nm, double middle, double below, double above) {
  const double t = (wavelength_nm - middle) * (wavelength_nm < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

glm::dvec3 cie_xyz(double nm) {
  return {
      0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) - 0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
      0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
      1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 rec709_from_xyz(const glm::dvec3& xyz) {  // IEC 61966-2-1
  return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
          0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

struct Wave {
  double px_per_cycle;
  glm::dvec3 color;
};

/// `count` equal parts of the spectrum, whose colours add up to white.
std::vector<Wave> waves(const ApertureOptics& optics, int count) {
  std::vector<Wave> result;
  glm::dvec3 sum(0);
  for (int i = 0; i < count; ++i) {
    const double nm = kShortest_nm + (kLongest_nm - kShortest_nm) * (i + 0.5) / count;
    result.push_back({pixels_per_cycle(optics, nm), rec709_from_xyz(cie_xyz(nm))});
    sum += result.back().color;
  }
  for (Wave& wave : result) wave.color /= sum;
  return result;
}

/// Share of the light that falls into the pixel at (x, y) from the point, x >= 0.
double pixel_share(const ApertureFarField& field, int x, int y, double px_per_cycle) {
  const double s = 1 / px_per_cycle, top = (y - 0.5) * s, bottom = (y + 0.5) * s;
  if (x > 0) return field.share((x - 0.5) * s, (x + 0.5) * s, top, bottom);
  return field.share(0, 0.5 * s, top, bottom) + field.share(0, 0.5 * s, -bottom, -top);
}

glm::dvec3 within_primaries(const glm::dvec3& rgb) {
  const double luminance = glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)), least = std::min({rgb.r, rgb.g, rgb.b});
  if (least >= 0) return rgb;
  if (luminance <= 0) return glm::dvec3(0);
  return glm::max(glm::dvec3(luminance) + (rgb - luminance) * (luminance / (luminance - least)), 0.0);
}

/// A weight of 1 near the middle and 0 from `end` on.
double fade(double radius, double end) {
  const double t = std::clamp((radius / end - kFadeStart) / (1 - kFadeStart), 0.0, 1.0);
  return 0.5 + 0.5 * std::cos(glm::pi<double>() * t);
}

/// How often the number of waves is doubled so that the spectrum's steps lie no more than about two pixels apart at that radius.
std::size_t wave_step(double radius) {
  const double octaves = std::ceil(std::log2(std::max(radius / 2, 1.0) / kMinWaves));
  return static_cast<std::size_t>(std::clamp(octaves, 0.0, static_cast<double>(kWaveSteps - 1)));
}

/// The middle pixel takes what the others leave of 1.
void complete(Image& psf) {
  const int middle = psf.width / 2;
  float* core = psf.pixel(middle, middle);
  for (int c = 0; c < 3; ++c) {
    core[c] = 0;
    double rest = 0;
    for (std::size_t i = static_cast<std::size_t>(c); i < psf.data.size(); i += 3) rest += psf.data[i];
    core[c] = static_cast<float>(1 - rest);
  }
}

void check(const ApertureOptics& optics) {
  if (!(optics.aperture_mm > 0) || !(optics.focal_px > 0) || !std::isfinite(optics.aperture_mm + optics.focal_px))
    throw Error("an aperture needs a width and a focal length above 0, got " + std::to_string(optics.aperture_mm) + " mm and " +
                std::to_string(optics.focal_px) + " px");
}

}  // namespace

AperturePlan plan_aperture(const ApertureOptics& optics, int wanted_reach_px, int picture_px) {
  check(optics);
  const double shortest = pixels_per_cycle(optics, kShortest_nm), longest = pixels_per_cycle(optics, kLongest_nm);
  // The picture's resolution limits the reach: half a cycle a pixel.
  const auto needed = static_cast<int>(std::min(std::ceil(2 * wanted_reach_px / (shortest * kFadeStart)), 1e6));
  const int largest = std::clamp(static_cast<int>(kMaxTransform_px * kSample_px / longest), kMinPicture_px, kMaxPicture_px);
  const int picture = std::min(std::clamp(needed, kMinPicture_px, largest), picture_px);
  const double transform = std::clamp(std::ceil(picture * longest / kSample_px), kPadding * picture, 1.0 * kMaxTransform_px);
  const auto reach = static_cast<int>(std::min(0.5 * picture * shortest, 1.0 * wanted_reach_px));
  return {picture, static_cast<int>(transform), std::max(reach, 1)};
}

Image monochromatic_psf(const ApertureFarField& field, const ApertureOptics& optics, double wavelength_nm, int reach_px) {
  check(optics);
  const double scale = pixels_per_cycle(optics, wavelength_nm);
  Image psf(2 * reach_px + 1, 2 * reach_px + 1, 1);
  for (int y = -reach_px; y <= reach_px; ++y)
    for (int x = 0; x <= reach_px; ++x)
      *psf.pixel(reach_px + x, reach_px + y) = *psf.pixel(reach_px - x, reach_px - y) =
          static_cast<float>(pixel_share(field, x, y, scale));
  return psf;
}

Image aperture_psf(const ApertureFarField& field, const ApertureOptics& optics, int reach_px) {
  check(optics);
  const double end_px = field.limit() * pixels_per_cycle(optics, kShortest_nm);
  std::vector<std::vector<Wave>> spectra;
  for (int step = 0; step < kWaveSteps; ++step) spectra.push_back(waves(optics, kMinWaves << step));
  Image psf(2 * reach_px + 1, 2 * reach_px + 1);
  parallel_for(static_cast<std::size_t>(2 * reach_px + 1), 0, [&](std::size_t row) {
    const int y = static_cast<int>(row) - reach_px;
    for (int x = y < 0 ? 1 : 0; x <= reach_px; ++x) {
      const double radius = std::hypot(x, y), kept = fade(radius, end_px);
      if (kept == 0) continue;
      glm::dvec3 rgb(0);
      for (const Wave& wave : spectra[wave_step(radius)]) rgb += wave.color * pixel_share(field, x, y, wave.px_per_cycle);
      rgb = within_primaries(rgb) * kept;
      for (int c = 0; c < 3; ++c)
        psf.pixel(reach_px + x, reach_px + y)[c] = psf.pixel(reach_px - x, reach_px - y)[c] = static_cast<float>(rgb[c]);
    }
  });
  complete(psf);
  return psf;
}

Image glare_of(Image psf) {
  float* core = psf.pixel(psf.width / 2, psf.height / 2);
  std::fill_n(core, 3, 0.0f);
  return psf;
}

}  // namespace catchlight::render
