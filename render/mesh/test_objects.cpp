#include "render/mesh/test_objects.hpp"

#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

constexpr std::uint32_t kAround = 96, kRings = 48;

/// A ball with its poles along z.
Mesh ball(const glm::dvec3& middle_m, double radius_m, const Material& material) {
  Mesh mesh;
  mesh.materials.push_back(material);
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double down = glm::pi<double>() * ring / kRings, around = glm::two_pi<double>() * i / kAround;
      const glm::dvec3 normal(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down));
      mesh.vertices.push_back({glm::vec3(middle_m + radius_m * normal), glm::vec3(normal)});
    }
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t upper = ring * kAround, lower = upper + kAround, next = (i + 1) % kAround;
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {upper + i, lower + i, upper + next});
      if (ring + 1 < kRings) mesh.indices.insert(mesh.indices.end(), {upper + next, lower + i, lower + next});
    }
  }
  mesh.triangle_material.assign(mesh.indices.size() / 3, 0);
  return mesh;
}

Material matte(const char* name, float reflected) {
  Material material;
  material.name = name;
  material.base_color = glm::vec3(reflected);
  material.dielectric_f0 = 0;
  return material;
}

Material chrome() {
  Material material;
  material.name = "chrome";
  material.base_color = glm::vec3(1);
  material.metallic = 1;
  material.roughness = 0;
  return material;
}

}  // namespace

std::optional<Mesh> test_object(const std::string& name, double tag_size_m) {
  if (name == "sphere") return ball(glm::dvec3(0), 0.375 * tag_size_m, matte("white", 0.8f));
  if (name != "chrome-and-grey") return std::nullopt;
  const glm::dvec3 aside_m(0.35 * tag_size_m, 0, 0);
  Mesh pair = ball(-aside_m, 0.3 * tag_size_m, chrome());
  append(pair, ball(aside_m, 0.3 * tag_size_m, matte("grey", 0.18f)));
  return pair;
}

}  // namespace catchlight::render
