#include "render/cpu/mirror/mirror_rays.hpp"

#include <gtest/gtest.h>

#include <random>

#include "render/cpu/mirror/cube_texture.hpp"
#include "render/mesh/bounds.hpp"
#include "tests/support/random_direction.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

std::mt19937 random_numbers(8);

/// The inside of a box is its front.
Mesh turned_inside_out(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  for (Vertex& vertex : mesh.vertices) vertex.normal = -vertex.normal;
  return mesh;
}

Material metal(const glm::vec3& color, float roughness) {
  Material material;
  material.base_color = color;
  material.metallic = 1;
  material.roughness = roughness;
  return material;
}

CubeTexture constant_probe(const glm::vec3& radiance) {
  Image faces(4, 24);
  for (int i = 0; i < 4 * 24; ++i)
    for (int c = 0; c < 3; ++c) faces.data[static_cast<std::size_t>(3 * i + c)] = radiance[c];
  return CubeTexture({{faces}});
}

/// Mirror rays of a mesh of one material, in a room of the same radiance everywhere.
struct Room {
  Mesh mesh;
  RayScene rays;
  SurfaceMaterials materials;
  SurfaceTextures textures{mesh, materials};
  BrdfTable brdf;
  CubeTexture probe;
  Surroundings around{probe, probe, glm::vec3(0)};
  std::vector<glm::vec3> irradiance_over_pi, direct;
  MirrorRays mirror;

  Room(Mesh given, const Material& material, const glm::vec3& radiance, const glm::vec3& exit = glm::vec3(0))
      : mesh(with(std::move(given), material)),
        rays(mesh),
        materials(surface_materials(mesh)),
        probe(constant_probe(radiance)),
        irradiance_over_pi(mesh.vertices.size(), exit),
        mirror(mesh, rays, textures, brdf, 0.01f * bounds_of(mesh).diagonal_m()) {
    around.set_view({}, {}, nullptr, nullptr);
    mirror.set_frame(around, {irradiance_over_pi, direct}, glm::vec3(1));
  }

  static Mesh with(Mesh mesh, const Material& material) {
    for (Material& each : mesh.materials) each = material;
    return mesh;
  }

  std::vector<MirrorRay> traced(const glm::vec3& origin_m, int count) const {
    std::vector<MirrorRay> found;
    for (int i = 0; i < count; ++i) found.push_back({origin_m, random_direction<float>(random_numbers), 0, 0, i % 16});
    mirror.trace(found);
    return found;
  }
};

TEST(MirrorRays, AWhiteMirrorBoxInConstantLightIsConstantThroughAllBounces) {
  for (const float roughness : {0.0f, 0.3f, 1.0f}) {
    const Room room(turned_inside_out(box(glm::vec3(-1), glm::vec3(1))), metal(glm::vec3(1), roughness), {1, 0.5f, 20});
    for (const MirrorRay& ray : room.traced({0.2f, -0.3f, 0.1f}, 500)) {
      EXPECT_TRUE(ray.meets_object);
      EXPECT_LT(glm::distance(ray.radiance / glm::vec3(1, 0.5f, 20), glm::vec3(1)), 5e-3f) << roughness;
    }
  }
}

TEST(MirrorRays, ABoxThatIsOpenAboveIsConstantToo) {
  Mesh mesh = turned_inside_out(box(glm::vec3(-1), glm::vec3(1)));
  mesh.indices.erase(mesh.indices.begin() + 24, mesh.indices.begin() + 30);
  mesh.triangle_material.resize(mesh.indices.size() / 3);
  const Room room(mesh, metal(glm::vec3(1), 0), glm::vec3(2));
  int met = 0;
  for (const MirrorRay& ray : room.traced({0.2f, -0.3f, 0.1f}, 500)) {
    met += ray.meets_object;
    if (ray.meets_object) {
      EXPECT_LT(glm::distance(ray.radiance, glm::vec3(2)), 1e-2f);
    }
  }
  EXPECT_GT(met, 300);
  EXPECT_LT(met, 480);
}

TEST(MirrorRays, EachMeetingTakesItsShare) {
  // Perfect mirrors of half the light, three deep; what they leave is the surroundings'.
  const Room room(turned_inside_out(box(glm::vec3(-1), glm::vec3(1))), metal(glm::vec3(0.5f, 1, 0.5f), 0), glm::vec3(1));
  std::vector<MirrorRay> straight{{glm::vec3(0), {1, 0, 0}, 0, 0, 0}};
  room.mirror.trace(straight);
  EXPECT_NEAR(straight[0].radiance.x, 0.125f, 0.01f);
  EXPECT_NEAR(straight[0].radiance.y, 1, 0.01f);
}

TEST(MirrorRays, MatteWallsShowTheirOwnLight) {
  Material matte;
  matte.dielectric_f0 = 0, matte.base_color = glm::vec3(0.5f);
  const Room room(turned_inside_out(box(glm::vec3(-1), glm::vec3(1))), matte, glm::vec3(9), {0.1f, 0.2f, 0.3f});
  for (const MirrorRay& ray : room.traced(glm::vec3(0.1f), 200))
    EXPECT_LT(glm::distance(ray.radiance, glm::vec3(0.05f, 0.1f, 0.15f)), 1e-2f) << "grazing surfaces still mirror a little";
}

TEST(MirrorRays, OfASmoothedSurfaceDoNotMeetItself) {
  // The smooth normal of a ball of flat pieces lets rays start below its triangles: those are skin, not another surface.
  const Room room(sphere({0, 0, 0}, 1, 40), metal(glm::vec3(1), 0), glm::vec3(1));
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<MirrorRay> found;
  for (std::size_t t = 0; t < room.mesh.indices.size(); t += 3)
    for (int i = 0; i < 3; ++i) {
      glm::vec2 w(share(random_numbers), share(random_numbers));
      if (w.x + w.y > 1) w = 1.0f - w;
      const auto corner = [&](std::size_t k) { return room.mesh.vertices[room.mesh.indices[t + k]]; };
      const glm::vec3 place = (1 - w.x - w.y) * corner(0).position_m + w.x * corner(1).position_m + w.y * corner(2).position_m;
      const glm::vec3 normal =
          glm::normalize((1 - w.x - w.y) * corner(0).normal + w.x * corner(1).normal + w.y * corner(2).normal);
      glm::vec3 direction = random_direction<float>(random_numbers);
      if (glm::dot(direction, normal) < 0) direction = glm::reflect(direction, normal);
      found.push_back({room.mirror.start(place, normal), direction, 0, 0, i % 16});
    }
  room.mirror.look(found);
  int met = 0;
  for (const MirrorRay& ray : found) met += ray.meets_object;
  EXPECT_LE(met, static_cast<int>(found.size()) / 500) << "of " << found.size();
}

TEST(MirrorRays, SeeAnotherPartOfTheObjectBeyondTheSkin) {
  Mesh mesh = sphere({0, 0, 0}, 1, 24);
  append(mesh, sphere({3, 0, 0}, 1, 24));
  const Room room(mesh, metal(glm::vec3(1), 0), glm::vec3(1));
  std::vector<MirrorRay> found{{room.mirror.start({1, 0, 0}, {1, 0, 0}), {1, 0, 0}, 0, 0, 0},
                               {room.mirror.start({-1, 0, 0}, {-1, 0, 0}), {-1, 0, 0}, 0, 0, 0}};
  room.mirror.look(found);
  EXPECT_TRUE(found[0].meets_object);
  EXPECT_FALSE(found[1].meets_object);
}

TEST(MirrorRays, DoNotDependOnTheirCompany) {
  Mesh mesh = sphere({0, 0, 0}, 1, 12, true);
  append(mesh, sphere({0.3f, 0, 0}, 0.3f, 12));
  const Room room(mesh, metal({0.9f, 0.8f, 0.7f}, 0.3f), glm::vec3(1), {0.1f, 0, 0.2f});
  std::vector<MirrorRay> together = room.traced({-0.3f, 0.1f, 0.2f}, 200);
  for (const MirrorRay& ray : together) {
    std::vector<MirrorRay> alone{{ray.origin_m, ray.direction, ray.spread, ray.roughness, ray.index}};
    room.mirror.trace(alone);
    EXPECT_EQ(alone[0].radiance, ray.radiance);
  }
}

}  // namespace
}  // namespace catchlight::render
