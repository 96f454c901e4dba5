#include "tests/support/studio.hpp"

#include <cmath>
#include <numbers>

#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {

glm::vec3 studio(const glm::dvec3& d) {
  const glm::vec3 sky =
      glm::mix(glm::vec3(0.10f, 0.08f, 0.06f), glm::vec3(0.5f, 0.6f, 0.8f), static_cast<float>(0.5 + 0.5 * d.z));
  const double to_lamp = glm::dot(d, glm::normalize(glm::dvec3(-1, -0.8, 1)));
  return sky + glm::vec3(150, 120, 80) * static_cast<float>(1 / (1 + std::exp(-1500 * (to_lamp - 0.993))));
}

ShRgb studio_light(int bands) {
  ShRgb light(static_cast<std::size_t>(sh_count(bands)), glm::vec3(0));
  std::vector<float> y(light.size());
  constexpr int kRows = 90;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < 2 * kRows; ++column) {
      const double theta = std::numbers::pi * (row + 0.5) / kRows, phi = std::numbers::pi * (column + 0.5) / kRows;
      const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      evaluate_sh(d, bands, y);
      const double solid_angle =
          std::numbers::pi / kRows * (std::cos(std::numbers::pi * row / kRows) - std::cos(std::numbers::pi * (row + 1) / kRows));
      for (std::size_t i = 0; i < y.size(); ++i) light[i] += studio(d) * y[i] * static_cast<float>(solid_angle);
    }
  }
  return light;
}

RenderScene ball(const Material& material) {
  RenderScene scene = constant_scene(sphere(0.05, {0, 0, 0.05}), material, glm::vec3(1), 4);
  scene.light = studio_light(4);
  scene.reflections = reflections_of(studio, 64, 1);
  return scene;
}

Material material_of(const glm::vec3& color, float metallic, float roughness, float f0) {
  Material material;
  material.base_color = color;
  material.metallic = metallic;
  material.roughness = roughness;
  material.dielectric_f0 = f0;
  return material;
}

FrameView tilted_view() {
  FrameView view;
  view.camera = {.width_px = 200, .height_px = 150, .fx_px = 240, .fy_px = 240, .cx_px = 99.5, .cy_px = 74.5, .distortion = {}};
  const double tilt = glm::radians(125.0);
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, std::cos(tilt), std::sin(tilt), 0, -std::sin(tilt), std::cos(tilt));
  view.camera_from_tag.translation_m = {0, 0.03, 0.32};
  view.exposure = glm::vec3(0.9f);
  return view;
}

glm::ivec3 table(int x, int y) {
  return glm::ivec3(120, 105, 90) + glm::ivec3(((x / 10 + y / 10) % 2) * 25);
}

}  // namespace catchlight::render::test
