// The lights on the receiving plane, and the shadow that they and the transfer make together.
#include "render/cpu/receiver/receiver_shadow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "render/cpu/receiver/plane_lights.hpp"
#include "render/mesh/bounds.hpp"
#include "render/probe/light_samples.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/brute_rays.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

constexpr int kBands = 3;

const std::vector<LightSample> kLamps{{glm::normalize(glm::dvec3(0.3, 0.2, 1)), {1, 2, 3}},
                                      {glm::normalize(glm::dvec3(-0.8, 0.1, 0.7)), {4, 1, 0.5}},
                                      {glm::normalize(glm::dvec3(0.1, 0.9, 0.4)), {0.2, 0.3, 2}},
                                      {glm::normalize(glm::dvec3(0.2, 0.1, -1)), {9, 9, 9}}};

Mesh still() {
  Mesh mesh = box({-0.03f, -0.02f, 0.001f}, {0.02f, 0.04f, 0.05f});
  append(mesh, sphere({0.05f, 0.02f, 0.06f}, 0.02f, 12));
  return mesh;
}

/// The light of `lamps` alone, and a transfer whose grid of 0.2 m nothing shadows.
struct Scene {
  Mesh mesh = still();
  Transfer transfer;
  SplitLight light;
  RayScene rays{mesh};
  Bounds bounds = bounds_of(mesh);

  explicit Scene(const std::vector<LightSample>& lamps) {
    transfer = bake_transfer(mesh, {.min_m = glm::vec2(-0.1f), .max_m = glm::vec2(0.1f), .columns = 21, .rows = 21},
                             {.bands = kBands, .rays = 64}, {});
    light.whole = project_to_sh(lamps, kBands);
    if (!lamps.empty()) light.split_off = light.whole;
    light.samples = lamps;
  }
};

/// Irradiance / pi of the lamps that a place of the plane sees.
glm::dvec3 brute_light(const Scene& scene, const glm::dvec2& place_m) {
  const double lift_m = 1.5 / 512 * scene.bounds.diagonal_m();
  glm::dvec3 sum(0);
  for (const LightSample& lamp : scene.light.samples)
    if (lamp.direction.z > 0 && !test::meets_any(scene.mesh, {place_m, lift_m}, lamp.direction))
      sum += lamp.irradiance * (lamp.direction.z / std::numbers::pi);
  return sum;
}

TEST(PlaneLights, AreWhatARayForEveryTexelFinds) {
  const Scene scene(kLamps);
  const ReceiverTexels texels{{glm::vec2(-0.15f), glm::vec2(0.15f, 0.12f)}, {197, 161}};
  const PlaneLights lights = plane_lights(kLamps, scene.rays, texels, scene.bounds);
  ASSERT_EQ(lights.irradiance_over_pi.size(), 197u * 161);
  int wrong = 0, dark = 0;
  for (int y = 0; y < 161; ++y)
    for (int x = 0; x < 197; ++x) {
      const glm::dvec2 place(-0.15 + (x + 0.5) * 0.3 / 197, -0.15 + (y + 0.5) * 0.27 / 161);
      const glm::dvec3 expected = brute_light(scene, place);
      const glm::vec3 found = lights.at(glm::vec2(x, y) + 0.5f);
      wrong += glm::distance(glm::dvec3(found), expected) > 1e-4;
      dark += expected.x < 0.9;
    }
  EXPECT_GT(dark, 500);
  EXPECT_LE(wrong, 10) << "rays that graze a corner, or go through what is narrower than the four texels between nodes";
  EXPECT_LT(glm::distance(lights.texel_at({-0.15f, 0.12f}), glm::vec2(0, 161)), 1e-3f);
}

TEST(PlaneLights, AreLinearBetweenTexelsAndGoOnBeyond) {
  PlaneLights lights{{{glm::vec2(0), glm::vec2(1)}, {3, 2}}, {}};
  for (int i = 0; i < 6; ++i) lights.irradiance_over_pi.emplace_back(i % 3, i / 3, 1);
  EXPECT_LT(glm::distance(lights.at({1.25f, 1}), glm::vec3(0.75f, 0.5f, 1)), 1e-6f);
  EXPECT_EQ(lights.at({-5, 9}), glm::vec3(0, 1, 1));
  EXPECT_EQ(lights.at({9, -5}), glm::vec3(2, 0, 1));
}

TEST(ReceiverShadow, WithoutLightThereIsNone) {
  const Scene scene({});
  ReceiverShadow shadow(scene.transfer, scene.rays, scene.bounds);
  for (const float light : {0.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
    SplitLight odd = scene.light;
    odd.whole.assign(kBands * kBands, glm::vec3(light));
    shadow.update(odd, true);
    for (const glm::vec2& place : {glm::vec2(0), {0.05f, -0.03f}, {0.0999f, 0.0999f}, {4, 4}}) {
      const glm::vec3 ratio = shadow.ratio(place);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(ratio[c] >= 0 && ratio[c] <= kMaxShadowRatio) << light;
      if (light == 0) {
        EXPECT_EQ(ratio, glm::vec3(1));
      }
    }
  }
}

TEST(ReceiverShadow, IsWhatIsLeftOfTheLampsLight) {
  const Scene scene(kLamps);
  ReceiverShadow shadow(scene.transfer, scene.rays, scene.bounds);
  shadow.update(scene.light, true);
  glm::dvec3 open(0);
  for (const LightSample& lamp : kLamps) open += lamp.irradiance * (std::max(lamp.direction.z, 0.0) / std::numbers::pi);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-0.2, 0.2);
  int compared = 0, dark = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec2 place(at(random), at(random));
    const glm::dvec3 expected = brute_light(scene, place) / open;
    bool at_edge = false;  // within two texels, of which there are 192 across the object
    for (const glm::dvec2& beside :
         {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}, {0.7, 0.7}, {-0.7, 0.7}, {0.7, -0.7}, {-0.7, -0.7}})
      at_edge = at_edge || brute_light(scene, place + 2.0 / 192 * 0.12 * beside) / open != expected;
    if (at_edge) continue;
    ++compared;
    dark += expected.x < 0.9;
    // What the bands cannot hold of the lamps is not there to be shadowed: the rest is black but for rounding.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shadow.ratio(place)[c], expected[c], 0.01) << place.x << ", " << place.y;
  }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(dark, 100) << "nothing of the shadow is cut off";
}

TEST(ReceiverShadow, IsOneBeyondItsReachAndContinuousThere) {
  const Scene scene(kLamps);
  ReceiverShadow shadow(scene.transfer, scene.rays, scene.bounds);
  shadow.update(scene.light, true);
  const PlaneRect& reach = shadow.reach();
  for (float share = 0; share <= 1; share += 0.01f) {
    const glm::vec2 p = glm::mix(reach.min_m, reach.max_m, share);
    for (const glm::vec2& rim :
         {glm::vec2(p.x, reach.min_m.y), {p.x, reach.max_m.y}, {reach.min_m.x, p.y}, {reach.max_m.x, p.y}}) {
      const glm::vec2 inwards = rim + 1e-4f * glm::sign(0.5f * (reach.min_m + reach.max_m) - rim);
      EXPECT_LT(glm::distance(shadow.ratio(inwards), glm::vec3(1)), 2e-3f) << rim.x << ", " << rim.y;
    }
  }
}

TEST(ReceiverShadow, FollowsTheLight) {
  const Scene scene(kLamps);
  ReceiverShadow once(scene.transfer, scene.rays, scene.bounds), twice(scene.transfer, scene.rays, scene.bounds);
  once.update(scene.light, true);
  SplitLight other = scene.light;
  for (LightSample& lamp : other.samples) lamp.direction.x = -lamp.direction.x;
  other.split_off = other.whole = project_to_sh(other.samples, kBands);
  twice.update(other, true);
  twice.update(scene.light, true);
  for (float x = -0.2f; x < 0.2f; x += 0.013f)
    for (float y = -0.2f; y < 0.2f; y += 0.017f) EXPECT_EQ(once.ratio({x, y}), twice.ratio({x, y}));
}

/// Ratios all over the plane.
std::vector<glm::vec3> ratios(const ReceiverShadow& shadow) {
  std::vector<glm::vec3> result;
  for (float x = -0.2f; x < 0.2f; x += 0.013f)
    for (float y = -0.2f; y < 0.2f; y += 0.017f) result.push_back(shadow.ratio({x, y}));
  return result;
}

class KeptReceiverShadow : public testing::Test {
 protected:
  /// As it is in the light of the scene. `rays`: of what throws the shadow where it must be found.
  std::vector<glm::vec3> shadow(const RayScene& rays, const KeyedCache& kept) const {
    ReceiverShadow result(scene_.transfer, rays, scene_.bounds);
    result.update(scene_.light, true, kept);
    return ratios(result);
  }

  TempFolder folder_;
  Scene scene_{kLamps};
  Mesh smaller_ = sphere({0.05f, 0.02f, 0.06f}, 0.01f, 6);
  RayScene other_{smaller_};
  KeyedCache kept_{ContentCache(folder_ / "cache"), content_hash("transfer", scene_.light)};
};

TEST_F(KeptReceiverShadow, IsTakenFromTheCache) {
  const std::vector<glm::vec3> made = shadow(scene_.rays, kept_);
  EXPECT_EQ(made, shadow(scene_.rays, {}));
  EXPECT_EQ(made, shadow(other_, kept_)) << "it was made anew";
}

TEST_F(KeptReceiverShadow, IsMadeAnewWhereTheFileIsDamagedOrTheLightIsAnother) {
  shadow(scene_.rays, kept_);
  SplitLight brighter = scene_.light;
  brighter.samples[1].irradiance.y *= 1.5;
  const std::vector<glm::vec3> anew = shadow(other_, {});
  EXPECT_EQ(anew, shadow(other_, {ContentCache(folder_ / "cache"), content_hash("transfer", brighter)}));
  EXPECT_EQ(anew, shadow(other_, {ContentCache(folder_ / "cache"), content_hash("another", scene_.light)}));
  damage_all_in(folder_ / "cache");
  EXPECT_EQ(anew, shadow(other_, kept_));
}

}  // namespace
}  // namespace catchlight::render
