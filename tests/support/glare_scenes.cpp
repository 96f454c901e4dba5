#include "tests/support/glare_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>

namespace catchlight::render::test {
namespace {

constexpr int kSamples = 4;  ///< per axis and pixel

/// `radiance` of a place in shares of the height (x to the right, y down), averaged over each pixel.
Image picture_of(int width, int height, const std::function<glm::dvec3(const glm::dvec2&)>& radiance) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0);
      for (int s = 0; s < kSamples * kSamples; ++s)
        sum += radiance(glm::dvec2(x + (s % kSamples + 0.5) / kSamples, y + (s / kSamples + 0.5) / kSamples) / double(height));
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(sum[c] / (kSamples * kSamples));
    }
  }
  return image;
}

/// A room: grey walls, two windows, and a sun of about a degree, its edge soft so that its energy does not hang on the sampling.
glm::dvec3 room(const glm::dvec3& d) {
  static const glm::dvec3 sun = glm::normalize(glm::dvec3(0.4, -0.5, -0.6));
  const double from_sun = glm::distance(d, sun) / glm::radians(0.6);
  if (from_sun < 4) return glm::dvec3(3e4, 2.6e4, 2e4) * std::exp(-from_sun * from_sun);
  const glm::dvec2 at(d.x / std::max(-d.z, 1e-3), d.y / std::max(-d.z, 1e-3));
  if (d.z < 0 && std::abs(std::abs(at.x) - 0.8) < 0.4 && std::abs(at.y + 0.6) < 0.5) return {6, 7, 9};
  return glm::dvec3(0.35) - 0.25 * d.y;
}

}  // namespace

Image one_pixel_highlight(int width, int height, double x, double y, float radiance) {
  Image image(width, height, 3);
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const double right = x - column, below = y - row;
  for (int i = 0; i < 4; ++i) {
    const double covered = (i % 2 == 0 ? 1 - right : right) * (i / 2 == 0 ? 1 - below : below);
    float* pixel = image.pixel(column + i % 2, row + i / 2);
    pixel[0] = radiance * static_cast<float>(covered);
    pixel[1] = 0.8f * pixel[0], pixel[2] = 0.5f * pixel[0];
  }
  return image;
}

Image mirror_ball(int width, int height) {
  const glm::dvec2 middle(0.5 * width / height, 0.5);
  return picture_of(width, height, [&](const glm::dvec2& at) {
    const glm::dvec2 p = (at - middle) / 0.3;
    const double r2 = glm::dot(p, p);
    if (r2 >= 1) return glm::dvec3(0);
    // Seen from afar along +z; y down.
    const glm::dvec3 normal(p, -std::sqrt(1 - r2));
    return 0.9 * room(glm::reflect(glm::dvec3(0, 0, 1), normal));
  });
}

Image glossy_bar(int width, int height) {
  return picture_of(width, height, [&](const glm::dvec2& at) {
    const double across = (at.y - 0.5 - 0.1 * (at.x - 0.6)) / 0.12;
    if (std::abs(across) > 1 || at.x < 0.15 || at.x > 1.15 * width / height - 0.1) return glm::dvec3(0);
    const double ridge = std::exp(-std::pow((across + 0.35) / 0.12, 2));
    glm::dvec3 light(0.08 + 0.1 * (1 - across * across));
    const glm::dvec3 windows[3] = {{14, 12, 9}, {30, 32, 36}, {8, 9, 12}};
    for (int i = 0; i < 3; ++i) {
      const double along = std::abs(at.x - 0.35 - 0.3 * i) - 0.06;
      light += windows[i] * ridge / (1 + std::exp(along / 0.004));
    }
    return light;
  });
}

Image lamps(int width, int height) {
  struct Lamp {
    glm::dvec2 at;
    double radius;
    glm::dvec3 radiance;
  };
  std::mt19937 random(5);
  const auto uniform = [&] { return random() / 4294967296.0; };
  std::vector<Lamp> all;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec2 at(uniform() * width / height, uniform());
    const glm::dvec3 color(0.2 + uniform(), 0.2 + uniform(), 0.2 + uniform());
    all.push_back({at, 0.002 + 0.004 * uniform(), color * std::pow(10, 0.3 + 4 * uniform())});
  }
  return picture_of(width, height, [&](const glm::dvec2& at) {
    glm::dvec3 light(0);
    for (const Lamp& lamp : all) {
      if (glm::distance(at, lamp.at) < lamp.radius) light += lamp.radiance;
    }
    return light;
  });
}

std::vector<NamedScene> glare_scenes() {
  return {{"mirror ball", mirror_ball}, {"glossy bar", glossy_bar}, {"lamps", lamps}};
}

}  // namespace catchlight::render::test
