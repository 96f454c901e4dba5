#include "render/mesh/test_objects.hpp"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <vector>

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

/// A place of a profile: its distance from the axis, its height, and the normal there.
struct ProfilePoint {
  double radius_m, z_m;
  glm::dvec2 normal;  ///< outwards, upwards
};

/// Turns a profile, from below upwards as seen with the outside on the right, about z. Adds to the mesh.
void add_turned(Mesh& mesh, const std::vector<ProfilePoint>& profile) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const ProfilePoint& point : profile)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double around = glm::two_pi<double>() * i / kAround;
      const glm::dvec2 out(std::cos(around), std::sin(around));
      mesh.vertices.push_back({glm::vec3(point.radius_m * out.x, point.radius_m * out.y, point.z_m),
                               glm::vec3(point.normal.x * out.x, point.normal.x * out.y, point.normal.y)});
    }
  for (std::uint32_t row = 0; row + 1 < profile.size(); ++row)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t next = (i + 1) % kAround, low = first + row * kAround, high = low + kAround;
      if (profile[row].radius_m > 0) mesh.indices.insert(mesh.indices.end(), {low + i, low + next, high + i});
      if (profile[row + 1].radius_m > 0) mesh.indices.insert(mesh.indices.end(), {low + next, high + next, high + i});
    }
}

/// A cylinder, or a cone where it has no radius above.
Mesh pillar(double radius_m, double radius_above_m) {
  Mesh mesh;
  const double half_m = radius_m;
  const glm::dvec2 side = glm::normalize(glm::dvec2(2 * half_m, radius_m - radius_above_m));
  add_turned(mesh, {{0, -half_m, {0, -1}}, {radius_m, -half_m, {0, -1}}});
  add_turned(mesh, {{radius_m, -half_m, side}, {radius_above_m, half_m, side}});
  if (radius_above_m > 0) add_turned(mesh, {{radius_above_m, half_m, {0, 1}}, {0, half_m, {0, 1}}});
  return mesh;
}

Mesh torus(double radius_m) {
  const double tube_m = radius_m / 4;
  std::vector<ProfilePoint> profile;
  for (std::uint32_t i = 0; i <= kRings; ++i) {
    const double turn = glm::two_pi<double>() * i / kRings;
    const glm::dvec2 normal(std::cos(turn), std::sin(turn));
    profile.push_back({radius_m - tube_m + tube_m * normal.x, tube_m * normal.y, normal});
  }
  Mesh mesh;
  add_turned(mesh, profile);
  return mesh;
}

/// A square of the plane through `middle_m` that spans two axes, its front where their cross product points.
void add_square(Mesh& mesh, const glm::vec3& middle_m, const glm::vec3& x_m, const glm::vec3& y_m) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::vec3 normal = glm::normalize(glm::cross(x_m, y_m));
  for (const glm::vec2& corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
    mesh.vertices.push_back({middle_m + corner.x * x_m + corner.y * y_m, normal});
  mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

Mesh cube(float half_m) {
  Mesh mesh;
  for (const float side : {-half_m, half_m})
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 out(0), x(0), y(0);
      out[axis] = side, x[(axis + 1) % 3] = half_m, y[(axis + 2) % 3] = side;
      add_square(mesh, out, x, y);
    }
  return mesh;
}

/// Without a material.
Mesh shape(const std::string& name, double radius_m) {
  if (name == "cube") return cube(static_cast<float>(radius_m));
  if (name == "cone") return pillar(radius_m, 0);
  if (name == "cylinder") return pillar(radius_m, radius_m);
  if (name == "torus") return torus(radius_m);
  Mesh mesh;
  const auto half_m = static_cast<float>(radius_m);
  if (name == "plane") add_square(mesh, glm::vec3(0), {half_m, 0, 0}, {0, half_m, 0});
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
  if (std::ranges::find(kTestObjects, name) == kTestObjects.end()) return std::nullopt;
  const double radius_m = 0.375 * tag_size_m;
  if (name == "sphere") return ball(glm::dvec3(0), radius_m, matte("white", 0.8f));
  if (name != "chrome-and-grey") {
    Mesh mesh = shape(name, radius_m);
    mesh.materials = {matte("white", 0.8f)};
    mesh.triangle_material.assign(mesh.indices.size() / 3, 0);
    return mesh;
  }
  const glm::dvec3 aside_m(0.35 * tag_size_m, 0, 0);
  Mesh pair = ball(-aside_m, 0.3 * tag_size_m, chrome());
  append(pair, ball(aside_m, 0.3 * tag_size_m, matte("grey", 0.18f)));
  return pair;
}

}  // namespace catchlight::render
