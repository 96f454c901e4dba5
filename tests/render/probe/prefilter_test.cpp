#include "render/probe/prefilter.hpp"
#include "catchlight/image.hpp"
#include "render/probe/cube_map.hpp"
#include "render/probe/light_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

template <typename Radiance>
Probe latlong_of(int width, const Radiance& radiance) {
  Probe probe{Image(width, width / 2), ProbeLayout::latlong};
  for (int y = 0; y < probe.image.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 value = radiance(*direction_from_texel(ProbeLayout::latlong, width, width / 2, x, y));
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = static_cast<float>(value[c]);
    }
  }
  return probe;
}

glm::dvec3 mean_of(const Image& level) {
  glm::dvec3 sum(0);
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const float* value = level.pixel(x, y);
      sum += cube_texel_solid_angle(level.width, x, y % level.width) / (4 * kPi) * glm::dvec3(value[0], value[1], value[2]);
    }
  }
  return sum;
}

TEST(CubeTexels, SolidAnglesAddUpToTheSphere) {
  double sum = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) sum += 6 * cube_texel_solid_angle(16, x, y);
  }
  EXPECT_NEAR(sum, 4 * kPi, 1e-12);
}

TEST(Prefilter, KeepsAConstantProbeExactly) {
  const ReflectionMap map =
      prefilter_reflections(latlong_of(64, [](const glm::dvec3&) { return glm::dvec3(0.5, 1, 70000); }), glm::dmat3(1));
  for (const Image& level : map.levels) {
    for (std::size_t i = 0; i < level.data.size(); i += 3) {
      EXPECT_NEAR(level.data[i], 0.5, 1e-5);
      EXPECT_NEAR(level.data[i + 2] / 70000, 1, 1e-5) << "beyond half's range";
    }
  }
}

TEST(Prefilter, HasSixToEightLevelsOfHalvedFaces) {
  for (const int face_size : {0, 64, 100}) {
    const ReflectionMap map =
        prefilter_reflections(latlong_of(32, [](const glm::dvec3&) { return glm::dvec3(1); }), glm::dmat3(1), face_size);
    EXPECT_GE(map.levels.front().width, face_size);
    EXPECT_GE(map.levels.size(), 6u);
    EXPECT_LE(map.levels.size(), 8u);
    for (std::size_t k = 0; k < map.levels.size(); ++k) {
      EXPECT_EQ(map.levels[k].width, map.levels[0].width >> k);
      EXPECT_EQ(map.levels[k].height, 6 * map.levels[k].width);
    }
  }
}

TEST(Prefilter, KeepsTheMeanRadianceOfEveryLevelEvenWithASun) {
  Probe probe = latlong_of(256, [](const glm::dvec3& d) { return glm::dvec3(1 + 0.5 * d.y, 1, 1); });
  probe.image.pixel(60, 40)[1] = 5000;  // of one texel
  const glm::dvec3 mean = glm::dvec3(project_to_sh(probe, 1)[0]) / (2 * std::sqrt(kPi));
  const ReflectionMap map = prefilter_reflections(probe, tag_from_probe(UpAxis::z, 20));
  for (std::size_t k = 0; k < map.levels.size(); ++k) {
    EXPECT_NEAR(mean_of(map.levels[k]).x / mean.x, 1, 0.01) << "level " << k;
    EXPECT_NEAR(mean_of(map.levels[k]).y / mean.y, 1, 0.01) << "level " << k;
  }
}

TEST(Prefilter, MirrorLevelLooksUpTheProbe) {
  const auto sky = [](const glm::dvec3& d) { return glm::dvec3(1 + d.x, 1 + d.y, 1 + d.z * d.x); };
  const Probe probe = latlong_of(256, sky);
  const glm::dmat3 tag_from = tag_from_probe(UpAxis::z, 30);
  const ReflectionMap map = prefilter_reflections(probe, tag_from);
  const Image& level = map.levels.front();
  const int size = level.width;
  for (int row = 5; row < level.height; row += 37) {
    for (int x = 3; x < size; x += 41) {
      const glm::dvec3 expected = sky(glm::transpose(tag_from) * cube_texel_direction(row / size, size, x, row % size));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(level.pixel(x, row)[c], expected[c], 1e-3) << "curvature over one texel of 0.02 rad";
    }
  }
}

TEST(Prefilter, FacesFollowOpenGl) {
  // A lamp per axis must stand in the middle of the face of that axis, in the order +x -x +y -y +z -z.
  const glm::dvec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int face = 0; face < 6; ++face) {
    const Probe probe =
        latlong_of(128, [&](const glm::dvec3& d) { return glm::dvec3(glm::dot(d, axes[face]) > 0.97 ? 1.0 : 0.0); });
    const Image level = prefilter_reflections(probe, glm::dmat3(1), 64).levels.front();
    for (int other = 0; other < 6; ++other) EXPECT_NEAR(level.pixel(32, other * 64 + 32)[0], other == face ? 1 : 0, 1e-6);
  }
}

// The filter's definition (n = v = r): density D(h) / 4 times n.l, up to a constant.
double lobe(double n_l, double roughness) {
  const double alpha2 = std::pow(roughness, 4), root = (1 + n_l) / 2 * (alpha2 - 1) + 1;
  return std::max(n_l, 0.0) / (root * root);
}

// Its integral over the sphere, steps crowded towards the axis.
double lobe_integral(double roughness) {
  double sum = 0;
  constexpr int kSteps = 100000;
  for (int k = 0; k < kSteps; ++k) {
    const double u = (k + 0.5) / kSteps, n_l = 1 - u * u * u;
    sum += 2 * kPi * lobe(n_l, roughness) * 3 * u * u / kSteps;
  }
  return sum;
}

TEST(Prefilter, SpreadsASunAsTheLobeIsDefined) {
  // A sun of one texel: every texel of every level has a closed form. Level 1 is nearly as narrow as the cube's own texels, which
  // blur it.
  Probe probe{Image(256, 128), ProbeLayout::latlong};
  probe.image.pixel(100, 50)[0] = 30000;
  const double flux = 30000 * texel_solid_angle(ProbeLayout::latlong, 256, 128, 100, 50);
  const glm::dvec3 sun = *direction_from_texel(ProbeLayout::latlong, 256, 128, 100, 50);
  const ReflectionMap map = prefilter_reflections(probe, glm::dmat3(1));
  const int last = static_cast<int>(map.levels.size()) - 1;
  for (int k = 1; k <= last; ++k) {
    const Image& level = map.levels[k];
    const int size = level.width;
    const double roughness = static_cast<double>(k) / last, scale = flux / lobe_integral(roughness),
                 peak = scale * lobe(1, roughness);
    double worst = 0;
    for (int row = 0; row < level.height; ++row) {
      for (int x = 0; x < size; ++x) {
        const double n_l = glm::dot(cube_texel_direction(row / size, size, x, row % size), sun);
        worst = std::max(worst, std::abs(level.pixel(x, row)[0] - scale * lobe(n_l, roughness)) / peak);
      }
    }
    EXPECT_LT(worst, k == 1 ? 0.12 : 0.03) << "level " << k << ": share of the peak";
  }
}

TEST(Prefilter, LeavesNoDotsAroundASun) {
  // Going away from the sun the light falls: no texel is brighter than those nearer by more than the tree's error.
  Probe probe{Image(256, 128), ProbeLayout::latlong};
  probe.image.pixel(100, 50)[0] = 30000;
  const glm::dvec3 sun = *direction_from_texel(ProbeLayout::latlong, 256, 128, 100, 50);
  const ReflectionMap map = prefilter_reflections(probe, glm::dmat3(1));
  for (std::size_t k = 1; k < map.levels.size(); ++k) {
    const int size = map.levels[k].width;
    std::vector<std::pair<double, float>> by_angle;
    for (int row = 0; row < 6 * size; ++row) {
      for (int x = 0; x < size; ++x) {
        by_angle.emplace_back(-glm::dot(cube_texel_direction(row / size, size, x, row % size), sun),
                              map.levels[k].pixel(x, row)[0]);
      }
    }
    std::sort(by_angle.begin(), by_angle.end());
    float darkest = by_angle.front().second;
    for (const auto& [angle, value] : by_angle) {
      EXPECT_LT(value, 1.15f * darkest + 1e-4f * by_angle.front().second) << "level " << k;
      darkest = std::min(darkest, value);
    }
  }
}

TEST(Prefilter, GivesTheSameBytesTwice) {
  const Probe probe = latlong_of(64, [](const glm::dvec3& d) { return glm::dvec3(1 + d.x, 1 + d.y, 1 + d.z); });
  const ReflectionMap one = prefilter_reflections(probe, glm::dmat3(1)), other = prefilter_reflections(probe, glm::dmat3(1));
  for (std::size_t k = 0; k < one.levels.size(); ++k) EXPECT_EQ(one.levels[k].data, other.levels[k].data);
}

// Eight lobes go through the tree together, and meet its nodes as each alone.
TEST(LightTrees, MeansDoNotDependOnTheirCompany) {
  Image cube(32, 6 * 32);
  for (std::size_t i = 0; i < cube.data.size(); ++i) cube.data[i] = 1 + std::sin(0.37f * static_cast<float>(i));
  cube.pixel(7, 40)[0] = 3000;
  const LightTree tree(cube);
  std::vector<glm::vec3> directions;
  for (int i = 0; i < 19; ++i) directions.push_back(glm::vec3(cube_texel_direction(i % 6, 32, i, 31 - i)));
  for (const float alpha : {0.02f, 0.2f, 1.0f}) {
    std::vector<glm::vec3> means(directions.size());
    tree.under_lobes(directions, alpha, means);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      glm::vec3 alone;
      tree.under_lobes({&directions[i], 1}, alpha, {&alone, 1});
      EXPECT_EQ(means[i], alone) << i;
    }
  }
}

TEST(EnvironmentBrdf, WhiteMirrorReflectsAllAndRoughOnesNeverMore) {
  const Image table = environment_brdf_table(32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const double total = table.pixel(x, y)[0] + table.pixel(x, y)[1];
      EXPECT_LE(total, 1.005) << "n.v " << x << ", roughness " << y << "; 1024 samples";
      EXPECT_GE(table.pixel(x, y)[0], 0);
      EXPECT_GE(table.pixel(x, y)[1], 0);
      if (y == 0) {
        EXPECT_NEAR(total, 1, 1e-3);
      }
    }
  }
}

TEST(EnvironmentBrdf, SmoothSurfaceFollowsSchlick) {
  const Image table = environment_brdf_table(64);
  for (int x = 4; x < 64; x += 10) {
    const double n_v = (x + 0.5) / 64, fresnel = std::pow(1 - n_v, 5);
    EXPECT_NEAR(table.pixel(x, 0)[0], 1 - fresnel, 2e-3);
    EXPECT_NEAR(table.pixel(x, 0)[1], fresnel, 2e-3);
  }
}

TEST(EnvironmentBrdf, AgreesWithAPlainSumOverLightDirections) {
  // f n.l summed over a fine grid of l, with D, F and the separable form of the correlated G written out as in Heitz 2014.
  const Image table = environment_brdf_table(16);
  for (const glm::ivec2& at : {glm::ivec2(4, 8), glm::ivec2(8, 12), glm::ivec2(14, 15), glm::ivec2(2, 13)}) {
    const double n_v = (at.x + 0.5) / 16, roughness = (at.y + 0.5) / 16, alpha = roughness * roughness;
    const glm::dvec3 view(std::sqrt(1 - n_v * n_v), 0, n_v);
    const auto lambda = [&](double cosine) { return (-1 + std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1))) / 2; };
    glm::dvec2 sum(0);
    constexpr int kSteps = 1200;
    for (int i = 0; i < kSteps; ++i) {
      const double n_l = (i + 0.5) / kSteps;
      for (int k = 0; k < kSteps; ++k) {
        const double phi = 2 * kPi * (k + 0.5) / kSteps, radius = std::sqrt(1 - n_l * n_l);
        const glm::dvec3 light(radius * std::cos(phi), radius * std::sin(phi), n_l), half = glm::normalize(light + view);
        const double root = half.z * half.z * (alpha * alpha - 1) + 1, d = alpha * alpha / (kPi * root * root);
        const double g = 1 / (1 + lambda(n_l) + lambda(n_v)), f = std::pow(1 - glm::dot(view, half), 5);
        sum += d * g / (4 * n_v) * glm::dvec2(1 - f, f) * (2 * kPi / (1.0 * kSteps * kSteps));
      }
    }
    EXPECT_NEAR(table.pixel(at.x, at.y)[0], sum.x, 5e-3);
    EXPECT_NEAR(table.pixel(at.x, at.y)[1], sum.y, 5e-3);
  }
}

}  // namespace
}  // namespace catchlight::render
