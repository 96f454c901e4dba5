#include "render/glare/aperture_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <random>
#include <vector>

namespace catchlight::render {
namespace {

/// Radius of the rim, in picture widths: an edge's soft pixel stays inside.
constexpr double kRim = 0.49;

/// How much of a pixel lies inside an edge `distance_px` away (inside: negative).
double inside(double distance_px) {
  return std::clamp(0.5 - distance_px, 0.0, 1.0);
}

/// `distance` (x, y from the middle, in picture widths) is negative where light passes.
template <class Distance>
Image drawn(int size_px, const Distance& distance) {
  Image image(size_px, size_px, 1);
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const glm::dvec2 p((x + 0.5) / size_px - 0.5, (y + 0.5) / size_px - 0.5);
      *image.pixel(x, y) = static_cast<float>(inside(distance(p) * size_px));
    }
  return image;
}

/// Uniform numbers in [low, high), the same everywhere; std's distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }

 private:
  std::mt19937 engine_;
};

/// A round-ended stroke that tapers.
struct Stroke {
  glm::dvec2 a, b;  ///< from the middle, in picture widths
  double radius_a, radius_b;
};

void block(Image& image, const Stroke& stroke) {
  const double size = image.width, reach = std::max(stroke.radius_a, stroke.radius_b) + 1 / size;
  const glm::dvec2 low = (glm::min(stroke.a, stroke.b) - reach + 0.5) * size,
                   high = (glm::max(stroke.a, stroke.b) + reach + 0.5) * size;
  const glm::dvec2 along = stroke.b - stroke.a;
  const double length2 = std::max(glm::dot(along, along), 1e-30);
  for (int y = std::max(0, static_cast<int>(low.y)); y < std::min(size, high.y); ++y)
    for (int x = std::max(0, static_cast<int>(low.x)); x < std::min(size, high.x); ++x) {
      const glm::dvec2 p((x + 0.5) / size - 0.5, (y + 0.5) / size - 0.5);
      const double t = std::clamp(glm::dot(p - stroke.a, along) / length2, 0.0, 1.0);
      const double away = glm::length(p - stroke.a - along * t), radius = glm::mix(stroke.radius_a, stroke.radius_b, t);
      // Between two edges: a hair thinner than a pixel dims it by its width.
      const double covered = inside((away - radius) * size) - inside((away + radius) * size);
      *image.pixel(x, y) = std::min(*image.pixel(x, y), static_cast<float>(1 - covered));
    }
}

/// A round grain, dark by its area however small.
void block_grain(Image& image, const glm::dvec2& middle, double radius) {
  const double size = image.width, radius_px = radius * size;
  // Softening a disc's rim adds pi / 12 square pixels.
  const double sharp_px = std::sqrt(std::max(radius_px * radius_px - 1.0 / 12, 0.0)),
               dark = std::min(12 * radius_px * radius_px, 1.0);
  const glm::dvec2 low = (middle - radius + 0.5) * size - 1.0, high = (middle + radius + 0.5) * size + 1.0;
  for (int y = std::max(0, static_cast<int>(low.y)); y < std::min(size, high.y); ++y)
    for (int x = std::max(0, static_cast<int>(low.x)); x < std::min(size, high.x); ++x) {
      const double away_px = glm::length(glm::dvec2(x + 0.5, y + 0.5) - (middle + 0.5) * size);
      *image.pixel(x, y) *= static_cast<float>(1 - dark * inside(away_px - sharp_px));
    }
}

/// A tapering lash that bends sideways by `bend` of its length.
void block_lash(Image& image, const glm::dvec2& root, const glm::dvec2& tip, double bend, double radius) {
  constexpr int kPieces = 24;
  const glm::dvec2 along = tip - root, control = root + 0.5 * along + bend * glm::dvec2(-along.y, along.x);
  const auto at = [&](double t) { return (1 - t) * (1 - t) * root + 2 * t * (1 - t) * control + t * t * tip; };
  for (int i = 0; i < kPieces; ++i) {
    const double t0 = static_cast<double>(i) / kPieces, t1 = static_cast<double>(i + 1) / kPieces;
    block(image, {at(t0), at(t1), radius * (1 - 0.8 * t0), radius * (1 - 0.8 * t1)});
  }
}

/// The lashes of one lid: `side` is -1 for the upper, 1 for the lower.
void block_lashes(Image& image, Random& random, int count, double side, double length) {
  for (int i = 0; i < count; ++i) {
    const double across = -0.55 + 1.1 * (i + random.between(0.2, 0.8)) / count;
    const glm::dvec2 root(across, side * (0.56 + random.between(-0.02, 0.02)));
    const double lean = 0.35 * across + random.between(-0.12, 0.12), reach = length * random.between(0.6, 1.0);
    const double bend = 0.12 * (across < 0 ? -1 : 1) + random.between(-0.06, 0.06);
    block_lash(image, root, root + reach * glm::dvec2(-std::sin(lean), -side * std::cos(lean)), bend,
               random.between(0.006, 0.010));
  }
}

}  // namespace

Image diaphragm_aperture(const Diaphragm& diaphragm, int size_px) {
  const double half = glm::pi<double>() / diaphragm.blades, turn = glm::radians(diaphragm.rotation_deg);
  // A blade is part of a circle through two corners; its middle lies `behind` the lens's.
  const double blade_radius = kRim / std::max(diaphragm.curvature, 1e-6);
  const double corner_height = kRim * std::sin(half);
  const double behind = std::sqrt(blade_radius * blade_radius - corner_height * corner_height) - kRim * std::cos(half);
  std::vector<glm::dvec2> normals;
  for (int i = 0; i < diaphragm.blades; ++i) {
    const double angle = turn + (2 * i + 1) * half;
    normals.push_back({std::cos(angle), std::sin(angle)});
  }
  return drawn(size_px, [&](const glm::dvec2& p) {
    double distance = -1;
    for (const glm::dvec2& normal : normals) distance = std::max(distance, glm::length(p + behind * normal) - blade_radius);
    return distance;
  });
}

Image circle_aperture(int size_px) {
  return drawn(size_px, [](const glm::dvec2& p) { return glm::length(p) - kRim; });
}

Image eyelash_aperture(int size_px) {
  Image image = circle_aperture(size_px);
  Random random(2005);
  block_lashes(image, random, 22, -1, 0.75);
  block_lashes(image, random, 14, 1, 0.35);
  return image;
}

Image dusty_aperture(int size_px) {
  Image image = circle_aperture(size_px);
  Random random(2009);
  const auto anywhere = [&] { return glm::dvec2(random.between(-kRim, kRim), random.between(-kRim, kRim)); };
  for (int i = 0; i < 400; ++i) {
    const glm::dvec2 middle = anywhere();
    block_grain(image, middle, 0.0015 * std::exp(random.between(0.0, 1.8)));
  }
  for (int i = 0; i < 14; ++i) {
    const glm::dvec2 start = anywhere();
    const double angle = random.between(0, glm::two_pi<double>()), radius = random.between(0.0006, 0.0014);
    block(image, {start, start + random.between(0.1, 0.6) * glm::dvec2(std::cos(angle), std::sin(angle)), radius, 0.4 * radius});
  }
  return image;
}

}  // namespace catchlight::render
