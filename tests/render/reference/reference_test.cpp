// The reference path tracer against closed forms: it must be right before anything is measured against it.
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/reference/path_tracer.hpp"
#include "tests/support/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catchlight::render::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// Probe frame = tag frame turned as on a table, as tag_from_probe(UpAxis::z, 0) has it.
const glm::dmat3 kOnTable = tag_from_probe(UpAxis::z, 0);

Probe constant_sky(const glm::vec3& radiance, int height = 16) {
  Probe probe{Image(2 * height, height), ProbeLayout::latlong};
  for (std::size_t i = 0; i < probe.image.data.size(); ++i) probe.image.data[i] = radiance[static_cast<int>(i % 3)];
  return probe;
}

/// Radiance 1 in the first `rows` rows, black below; bilinear between, so its edge is half way: the angle from straight up.
struct DiscLight {
  Probe probe;
  double angle;
};
DiscLight disc_light(int rows, int height) {
  DiscLight light{constant_sky(glm::vec3(0), height), (rows - 0.5) / (height - 1) * kPi};
  std::fill_n(light.probe.image.data.begin(), std::size_t(rows) * 2 * height * 3, 1.0f);
  return light;
}

ReferenceScene scene_of(Mesh mesh, Probe probe, bool has_receiver) {
  ReferenceScene scene;
  scene.mesh = std::move(mesh);
  scene.probe = std::move(probe);
  scene.tag_from_probe = kOnTable;
  scene.has_receiver = has_receiver;
  scene.probe_in_tag_m = {0, 0, 1};
  return scene;
}

TraceOptions with(int samples, int bounces = 6, int threads = 0) {
  TraceOptions options;
  options.samples = samples;
  options.bounces = bounces;
  options.threads = threads;
  return options;
}

Mesh with_material(Mesh mesh, const Material& material) {
  mesh.materials = {material};
  return mesh;
}

/// The mesh without the faint gloss of a dielectric.
Mesh lambertian(Mesh mesh) {
  for (Material& material : mesh.materials) material.dielectric_f0 = 0;
  return mesh;
}

Material metal(float roughness) {
  Material material = white();
  material.metallic = 1;
  material.roughness = roughness;
  return material;
}

Material plastic(float roughness) {
  Material material = white();
  material.roughness = roughness;
  return material;
}

/// A camera 8 px wide, 3 m in front of the tag's origin on its z axis, that a ball of radius 1 there more than fills.
struct Portrait {
  CameraModel camera;
  RigidTransform camera_from_tag;
  Portrait() {
    camera.width_px = camera.height_px = 8;
    camera.fx_px = camera.fy_px = 20;
    camera.cx_px = camera.cy_px = 3.5;
    camera_from_tag.rotation = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
    camera_from_tag.translation_m = {0, 0, 3};
  }
};

glm::dvec3 mean_of(const Image& image) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < image.data.size(); ++i) sum[static_cast<int>(i % 3)] += image.data[i];
  return sum / (image.data.size() / 3.0);
}

double ratio_at(const PathTracer& tracer, const glm::dvec2& point_m) {
  return tracer.receiver_ratio(std::vector{point_m})[0].g;
}

// --- furnaces: in a constant sky a white object that reflects everything cannot be seen --------------------------------------

TEST(ReferenceFurnace, ConvexWhiteObjectHasTheSkysRadiance) {
  Mesh ball = sphere({0, 0, 0}, 1, 32);
  std::vector<MattePoint> points;
  for (const std::uint32_t vertex : used_vertices(ball)) points.push_back(matte_vertices(ball)[vertex]);
  const PathTracer tracer(scene_of(ball, constant_sky({0.3f, 1, 2}), false), with(64));
  double sum = 0;
  for (const glm::dvec3& radiance : tracer.exit_radiance(points)) {
    EXPECT_NEAR(radiance.r, 0.3, 0.03);
    sum += radiance.b / static_cast<double>(points.size());
  }
  EXPECT_NEAR(sum, 2.0, 0.01) << "facets between smoothed normals cost light within half a facet's angle";
}

TEST(ReferenceFurnace, ConcaveWhiteObjectNeedsItsBounces) {
  // Inside a white bowl (a hemisphere open to the sky), light leaves only after many reflections: with all of them it is the
  // sky's.
  Mesh bowl = sphere({0, 0, 0}, 1, 32, true);
  std::vector<std::uint32_t> lower;
  for (std::size_t i = 0; i + 2 < bowl.indices.size(); i += 3) {
    const auto z = [&](int k) { return bowl.vertices[bowl.indices[i + k]].position_m.z; };
    if (z(0) < 1e-4 && z(1) < 1e-4 && z(2) < 1e-4) lower.insert(lower.end(), &bowl.indices[i], &bowl.indices[i] + 3);
  }
  bowl.indices = lower;
  bowl.triangle_material.assign(lower.size() / 3, 0);
  const std::vector<MattePoint> bottom{{{0, 0, -0.999}, {0, 0, 1}, glm::dvec3(1)}};
  const auto radiance = [&](int bounces) {
    return PathTracer(scene_of(lambertian(bowl), constant_sky(glm::vec3(1)), false), with(4096, bounces))
        .exit_radiance(bottom)[0]
        .g;
  };
  // Every point of the bowl sees half of it and half the sky's opening as form factor 1/2 (integrating sphere): 1/2 + 1/4 + ...
  EXPECT_NEAR(radiance(0), 0.5, 0.01);
  EXPECT_NEAR(radiance(1), 0.75, 0.01);
  EXPECT_NEAR(radiance(30), 1.0, 0.01);
}

TEST(ReferenceFurnace, SmoothMetalIsTheSky) {
  const Portrait view;
  const PathTracer tracer(scene_of(with_material(sphere({0, 0, 0}, 1, 64), metal(0)), constant_sky(glm::vec3(2)), false),
                          with(64));
  EXPECT_NEAR(mean_of(tracer.render(view.camera, view.camera_from_tag, {}).object).g, 2.0, 0.002);
}

TEST(ReferenceFurnace, NothingReflectsMoreThanArrives) {
  const Portrait view;
  for (const float roughness : {0.0f, 0.05f, 0.3f, 0.6f, 1.0f}) {
    for (const Material& material : {metal(roughness), plastic(roughness)}) {
      const PathTracer tracer(scene_of(with_material(sphere({0, 0, 0}, 1, 64), material), constant_sky(glm::vec3(1)), false),
                              with(256));
      const double mean = mean_of(tracer.render(view.camera, view.camera_from_tag, {}).object).g;
      EXPECT_LT(mean, 1.002) << roughness << (material.metallic > 0 ? " metal" : " plastic");
      // Single scattering loses light on rough metal; under a dielectric's gloss lies white Lambert.
      EXPECT_GT(mean, material.metallic > 0 ? 0.0 : 0.9) << roughness;
    }
  }
}

// --- the receiver -----------------------------------------------------------------------------------------------------------

TEST(ReferenceReceiver, BlackBallHidesItsFormFactorOfTheSky) {
  // A ball wholly above a point's horizon, centre at distance D and angle theta from the normal, radius R: (R/D)^2 cos(theta).
  constexpr double kRadius = 0.05;
  const PathTracer tracer(scene_of(blackened(sphere({0, 0, kRadius}, kRadius, 64)), constant_sky(glm::vec3(1)), true),
                          with(4096));
  for (const double distance : {0.02, 0.05, 0.1, 0.2}) {
    const double to_centre = std::hypot(distance, kRadius);
    const double hidden = kRadius * kRadius / (to_centre * to_centre) * (kRadius / to_centre);
    EXPECT_NEAR(ratio_at(tracer, {distance, 0}), 1 - hidden, 0.004) << "at " << distance;
  }
  EXPECT_NEAR(ratio_at(tracer, {0.001, 0}), 0, 0.002) << "contact";
}

TEST(ReferenceReceiver, ColourBleedsFromTheObject) {
  // An infinite wall's foot: half the sky is replaced by a wall that itself sees half a sky and half a table.
  Mesh wall;
  add_quad(wall, {0, 50, 0}, {0, -50, 0}, {0, -50, 100}, {0, 50, 100});
  wall.materials[0].base_color = {0.5f, 0, 0};
  ASSERT_LT(wall.vertices[0].normal.x, 0) << "faces the points";
  const PathTracer tracer(scene_of(lambertian(wall), constant_sky(glm::vec3(1)), true), with(4096, 0));
  const glm::dvec3 direct = tracer.receiver_ratio(std::vector{glm::dvec2(-0.01, 0)})[0];
  EXPECT_NEAR(direct.r, 0.5, 0.01);
  EXPECT_NEAR(direct.g, 0.5, 0.01);
  // One bounce: of the wall's light 1/2 is the sky's; the table's comes with the second bounce of the path.
  const PathTracer bounced(scene_of(lambertian(wall), constant_sky(glm::vec3(1)), true), with(4096, 1));
  const glm::dvec3 ratio = bounced.receiver_ratio(std::vector{glm::dvec2(-0.01, 0)})[0];
  EXPECT_NEAR(ratio.r, 0.5 + 0.5 * 0.5 * 0.5, 0.01);
  EXPECT_NEAR(ratio.g, 0.5, 0.01);
}

TEST(ReferenceReceiver, MirrorsNeverLightIt) {
  const auto ratio = [](const Material& material) {
    Mesh ball = with_material(sphere({0, 0, 0.05f}, 0.05f, 32), material);
    return ratio_at(PathTracer(scene_of(ball, constant_sky(glm::vec3(1)), true), with(1024)), {0.06, 0.01});
  };
  Material black = white();
  black.base_color = glm::vec3(0);
  EXPECT_NEAR(ratio(metal(0.1f)), ratio(black), 1e-12);
  EXPECT_GT(ratio(white()), ratio(black) + 0.05);
}

TEST(ReferenceReceiver, IsUntouchedWhereNothingIsInTheWay) {
  const PathTracer tracer(scene_of(disc({0, 0, -1}, 0.5f, 16), constant_sky(glm::vec3(1)), true), with(16));
  EXPECT_EQ(ratio_at(tracer, {0, 0}), 1.0) << "the object is under the table";
}

TEST(ReferenceReceiver, LightsTheObjectFromBelow) {
  // A surface that looks down at an unbounded table sees nothing but the table: its radiance, by the probe's lower half, is 0.25.
  Probe probe = constant_sky(glm::vec3(1), 64);
  for (int y = 32; y < 64; ++y) std::fill_n(probe.image.pixel(0, y), 3 * 128, 0.25f);
  Mesh plate = blackened(disc({0, 0, 1}, 1e-3f, 16));
  const std::vector<MattePoint> below{{{0, 0, 0.9}, {0, 0, -1}, glm::dvec3(1)}};
  const PathTracer tracer(scene_of(plate, probe, true), with(1024));
  EXPECT_NEAR(tracer.exit_radiance(below)[0].g, 0.25, 0.002);
}

TEST(ReferenceReceiver, IsReadFromTheFrameWhereTheFrameShowsIt) {
  ReferenceScene scene = scene_of(blackened(disc({0, 0, 5}, 1e-3f, 16)), constant_sky(glm::vec3(1)), true);
  const Portrait view;
  FrameLight frame{Image(8, 8), view.camera, view.camera_from_tag};
  std::fill(frame.radiance.data.begin(), frame.radiance.data.end(), 0.125f);
  scene.frame = frame;
  const PathTracer tracer(scene, with(4096));
  // Just above the table the frame's part of it, 0.4 m and more wide, is all that can be seen.
  EXPECT_NEAR(tracer.exit_radiance(std::vector<MattePoint>{{{0, 0, 0.001}, {0, 0, -1}, glm::dvec3(1)}})[0].g, 0.125, 1e-3);
}

// --- lights -----------------------------------------------------------------------------------------------------------------

TEST(ReferenceLight, DiscOverheadGivesPiLSin2) {
  const DiscLight light = disc_light(20, 360);
  const PathTracer tracer(scene_of({}, light.probe, false), with(256));
  const double exit = tracer.exit_radiance(std::vector<MattePoint>{{{0, 0, 0}, {0, 0, 1}, glm::dvec3(1)}})[0].g;
  EXPECT_NEAR(exit * kPi, kPi * std::pow(std::sin(light.angle), 2), 0.005 * exit * kPi);
}

TEST(ReferenceLight, BlackBallBeforeTheDiscCastsUmbraAndAnnulus) {
  const DiscLight light = disc_light(20, 360);  // half angle 9.8 degrees
  const double a = light.angle;
  const auto ratio = [&](double half_angle, const glm::dvec2& at) {
    const float radius = static_cast<float>(std::sin(half_angle));
    return ratio_at(PathTracer(scene_of(blackened(sphere({0, 0, 1}, radius, 128)), light.probe, true), with(4096)), at);
  };
  EXPECT_NEAR(ratio(1.2 * a, {0, 0}), 0.0, 1e-3) << "umbra";
  EXPECT_NEAR(ratio(0.5 * a, {0, 0}), 1 - std::pow(std::sin(0.5 * a) / std::sin(a), 2), 0.004) << "annulus";
  EXPECT_EQ(ratio(0.5 * a, {1, 0}), 1.0) << "in the open: 45 degrees away";
}

TEST(ReferenceLight, StraightEdgeThroughTheDiscHalvesIt) {
  const DiscLight light = disc_light(20, 360);
  Mesh half;
  add_quad(half, {0, -50, 1}, {50, -50, 1}, {50, 50, 1}, {0, 50, 1});
  const PathTracer tracer(scene_of(blackened(half), light.probe, true), with(4096));
  EXPECT_NEAR(ratio_at(tracer, {0, 0}), 0.5, 0.002) << "middle of the penumbra";
  EXPECT_NEAR(ratio_at(tracer, {1.01 * std::tan(light.angle), 0}), 0.0, 1e-3) << "umbra";
  EXPECT_NEAR(ratio_at(tracer, {-1.01 * std::tan(light.angle), 0}), 1.0, 1e-3) << "in the open";
}

TEST(ReferenceLight, SunOfOneTexelConverges) {
  Probe probe = constant_sky(glm::vec3(0.01f), 128);
  const int x = 90, y = 30;
  std::fill_n(probe.image.pixel(x, y), 3, 1e6f);
  const PathTracer tracer(scene_of({}, probe, false), with(64));
  const double exact = irradiance(probe, {0, 1, 0}).g;
  const double traced = kPi * tracer.exit_radiance(std::vector<MattePoint>{{{0, 0, 0}, {0, 0, 1}, glm::dvec3(1)}})[0].g;
  EXPECT_NEAR(traced / exact, 1.0, 0.002);
  // On a rough metal, too, whose own lobe would miss it.
  const Portrait view;
  const PathTracer lit(scene_of(with_material(sphere({0, 0, 0}, 1, 64), metal(0.5f)), probe, false), with(64));
  const PathTracer again(scene_of(with_material(sphere({0, 0, 0}, 1, 64), metal(0.5f)), probe, false), with(1024));
  const double few = mean_of(lit.render(view.camera, view.camera_from_tag, {}).object).g;
  const double many = mean_of(again.render(view.camera, view.camera_from_tag, {}).object).g;
  EXPECT_GT(many, 0);
  EXPECT_NEAR(few / many, 1.0, 0.01);
}

TEST(ReferenceLight, EmissiveSurfacesShine) {
  Material glowing = white();
  glowing.base_color = glm::vec3(0);
  glowing.emissive = {3, 2, 1};
  const Portrait view;
  const PathTracer tracer(scene_of(with_material(sphere({0, 0, 0}, 1, 32), glowing), constant_sky(glm::vec3(0)), false), with(4));
  EXPECT_EQ(mean_of(tracer.render(view.camera, view.camera_from_tag, {}).object), glm::dvec3(3, 2, 1));
}

TEST(ReferenceLight, UnlitSurfacesHaveTheRadianceThatTheirColourIsExposedFrom) {
  Material label = white();
  label.base_color = glm::vec3(0);
  label.unlit_color = {0.5f, 0.25f, 1};
  const Portrait view;
  ReferenceScene scene = scene_of(with_material(sphere({0, 0, 0}, 1, 32), label), constant_sky(glm::vec3(3)), false);
  scene.unlit_radiance = {2, 4, 8};
  label.dielectric_f0 = 0;
  scene.mesh = with_material(sphere({0, 0, 0}, 1, 32), label);
  EXPECT_EQ(mean_of(PathTracer(scene, with(4)).render(view.camera, view.camera_from_tag, {}).object), glm::dvec3(1, 1, 8));
}

// --- what it is made of -----------------------------------------------------------------------------------------------------

TEST(ReferenceTracer, DoesNotDependOnThreads) {
  const Portrait view;
  const Mesh ball = with_material(sphere({0, 0, 1}, 0.5f, 16), plastic(0.4f));
  const auto picture = [&](int threads) {
    return PathTracer(scene_of(ball, disc_light(3, 16).probe, true), with(8, 6, threads))
        .render(view.camera, view.camera_from_tag, {});
  };
  const ReferencePicture one = picture(1), three = picture(3);
  EXPECT_EQ(one.object.data, three.object.data);
  EXPECT_EQ(one.kept.data, three.kept.data);
}

TEST(ReferenceTracer, EmptyMeshLeavesTheFrameAsItIs) {
  const Portrait view;
  const ReferencePicture picture =
      PathTracer(scene_of({}, constant_sky(glm::vec3(1)), true), with(2)).render(view.camera, view.camera_from_tag, {});
  for (const float value : picture.object.data) EXPECT_EQ(value, 0);
  for (const float value : picture.kept.data) EXPECT_EQ(value, 1);
}

TEST(ReferenceTracer, BlackProbeGivesBlackAndNoNan) {
  const PathTracer tracer(scene_of(sphere({0, 0, 1}, 1, 16), constant_sky(glm::vec3(0)), true), with(4));
  EXPECT_EQ(tracer.exit_radiance(std::vector<MattePoint>{{{0, 0, 2}, {0, 0, 1}, glm::dvec3(1)}})[0], glm::dvec3(0));
  EXPECT_EQ(ratio_at(tracer, {0.1, 0.1}), 1.0) << "without light there is no shadow to divide";
}

TEST(ReferenceTracer, BacksOfTrianglesBlockAndReflectNothing) {
  const Portrait view;
  const Mesh inside_out = sphere({0, 0, 0}, 1, 16, true);
  const ReferencePicture picture =
      PathTracer(scene_of(inside_out, constant_sky(glm::vec3(1)), false), with(4)).render(view.camera, view.camera_from_tag, {});
  EXPECT_EQ(mean_of(picture.object), glm::dvec3(0));
  EXPECT_EQ(mean_of(picture.kept), glm::dvec3(0));
}

TEST(ReferenceTracer, OptionsOutOfRangeAreNamed) {
  const ReferenceScene scene = scene_of({}, constant_sky(glm::vec3(1)), false);
  EXPECT_THROW(PathTracer(scene, with(0)), Error);
  EXPECT_THROW(PathTracer(scene, with(1, -1)), Error);
}

TEST(ReferenceTracer, MatteVerticesHaveTheFirstMaterialsDiffuseAlbedo) {
  Mesh mesh = box(glm::vec3(0), glm::vec3(1));
  mesh.materials[0].base_color = {0.5f, 0.25f, 1};
  mesh.materials.push_back(metal(0.2f));
  mesh.triangle_material.back() = 1;
  mesh.vertices[0].color = {1, 0.5f, 1};
  const std::vector<MattePoint> points = matte_vertices(mesh);
  EXPECT_EQ(points[0].albedo, glm::dvec3(0.5, 0.125, 1));
  EXPECT_EQ(points[mesh.indices.back()].albedo, glm::dvec3(0)) << "the metal triangle's own corner";
}

}  // namespace
}  // namespace catchlight::render::reference
