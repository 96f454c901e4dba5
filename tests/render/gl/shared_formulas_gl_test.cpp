// shaders/shading.h and shaders/noise.h: what C++ makes of them against what GLSL does, on the same random numbers.
#include <cmath>
#include <functional>
#include <random>

#include "render/gl/gl_objects.hpp"
#include "render/gl/shader_text.hpp"
#include "shaders/noise.h"
#include "shaders/shading.h"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr std::size_t kInputs = 512;

/// Four random vectors: a of length 1, b of length 1 on its side, c and d between 0 and 1.
struct Input {
  vec4 a, b, c, d;
};

struct Output {
  vec4 r{0}, s{0};
};

std::vector<Input> random_inputs() {
  std::mt19937 random(12);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> share(0, 1);
  const auto direction = [&] { return glm::normalize(vec3(normal(random), normal(random), normal(random))); };
  const auto shares = [&] { return vec4(share(random), share(random), share(random), share(random)); };
  std::vector<Input> inputs;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const vec3 a = direction(), b = direction();
    inputs.push_back({vec4(a, 0), vec4(glm::dot(a, b) < 0 ? -b : b, 0), shares(), shares()});
  }
  return inputs;
}

class SharedFormulasGl : public GlTest {
 protected:
  /// Runs GLSL statements that set `r` and `s` from `a`, `b`, `c`, `d` and `i`, the input's number.
  static std::vector<Output> by_glsl(const std::vector<Input>& inputs, const std::string& statements) {
    const std::string text = "#version 450 core\nlayout(local_size_x = 64) in;\n" + shader_text("interface.h", "").text +
                             shader_text("shading.h", "").text + shader_text("noise.h", "").text +
                             "layout(std430, binding = 0) readonly buffer Inputs { vec4 inputs[]; };\n"
                             "layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };\n"
                             "void main() {\n"
                             "  int i = int(gl_GlobalInvocationID.x);\n"
                             "  vec4 a = inputs[4 * i], b = inputs[4 * i + 1], c = inputs[4 * i + 2], d = inputs[4 * i + 3];\n"
                             "  vec4 r = vec4(0), s = vec4(0);\n" +
                             statements + "\n  outputs[2 * i] = r;\n  outputs[2 * i + 1] = s;\n}\n";
    const char* source = text.c_str();
    const GlProgram program(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
    GLint is_linked = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &is_linked);
    std::string log(2000, '\0');
    glGetProgramInfoLog(program.id(), 2000, nullptr, log.data());
    EXPECT_TRUE(is_linked) << log.c_str();
    std::vector<Output> outputs(inputs.size());
    const GlBuffer from = make_buffer("inputs", std::span(inputs)),
                   to = make_buffer("outputs", outputs.size() * sizeof(Output), nullptr, GL_CLIENT_STORAGE_BIT);
    bind_storage(0, from.id()), bind_storage(1, to.id());
    glUseProgram(program.id());
    glDispatchCompute(kInputs / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(to.id(), 0, static_cast<GLsizeiptr>(outputs.size() * sizeof(Output)), outputs.data());
    glUseProgram(0);
    return outputs;
  }

  /// `tolerance`: of each number, relative where it is above 1.
  static void expect_alike(const std::string& glsl, const std::function<Output(const Input&, int)>& cpp, double tolerance) {
    const std::vector<Input> inputs = random_inputs();
    const std::vector<Output> found = by_glsl(inputs, glsl);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Output expected = cpp(inputs[i], static_cast<int>(i));
      for (int k = 0; k < 4; ++k) {
        ASSERT_NEAR(found[i].r[k], expected.r[k], tolerance * std::max(1.0f, std::abs(expected.r[k]))) << glsl << " input " << i;
        ASSERT_NEAR(found[i].s[k], expected.s[k], tolerance * std::max(1.0f, std::abs(expected.s[k]))) << glsl << " input " << i;
      }
    }
  }
};

shader_interface::SurfaceMaterial material_of(const Input& in) {
  return {in.c, in.d, {in.c.x, in.c.y, 0, 0}, {in.d.x, in.d.y, in.d.z, 0}};
}

const std::string kMaterial = "SurfaceMaterial m = SurfaceMaterial(c, d, vec4(c.xy, 0, 0), vec4(d.xyz, 0));";

TEST_F(SharedFormulasGl, OfMaterials) {
  expect_alike(
      kMaterial + "r = vec4(diffuse_albedo(m, b.xyz), mirror_f90(m)); s = vec4(mirror_f0(m, b.xyz), 0);",
      [](const Input& in, int) {
        const auto m = material_of(in);
        return Output{vec4(shading::diffuse_albedo(m, vec3(in.b)), shading::mirror_f90(m)),
                      vec4(shading::mirror_f0(m, vec3(in.b)), 0)};
      },
      1e-6);
  expect_alike(
      kMaterial + "r = mirror_factor(m, abs(b.xyz), d.xy + 0.1); s = vec4(emitted_radiance(m, c.xyz, d.yzw), 0);",
      [](const Input& in, int) {
        const auto m = material_of(in);
        return Output{shading::mirror_factor(m, glm::abs(vec3(in.b)), vec2(in.d) + 0.1f),
                      vec4(shading::emitted_radiance(m, vec3(in.c), vec3(in.d.y, in.d.z, in.d.w)), 0)};
      },
      1e-5);
}

TEST_F(SharedFormulasGl, OfLobes) {
  expect_alike(
      "r = vec4(glossy_brdf(a.xyz, b.xyz, normalize(a.xyz + 0.6 * b.xyz), 0.2 * c.x, 0.01 + 0.9 * c.y, d.xyz, d.w), 0);",
      [](const Input& in, int) {
        const vec3 a(in.a), b(in.b);
        return Output{vec4(
            shading::glossy_brdf(a, b, glm::normalize(a + 0.6f * b), 0.2f * in.c.x, 0.01f + 0.9f * in.c.y, vec3(in.d), in.d.w),
            0)};
      },
      1e-3);
  expect_alike(
      "r = vec4(lobe_weight(c.x, c.y), wider(c.z, c.w), level_of(d.x, 7), level_of(d.y, 2)); s.xyz = multiple_scattering(d.xyz, "
      "c.xy + 0.1);",
      [](const Input& in, int) {
        return Output{vec4(shading::lobe_weight(in.c.x, in.c.y), shading::wider(in.c.z, in.c.w), shading::level_of(in.d.x, 7),
                           shading::level_of(in.d.y, 2)),
                      vec4(shading::multiple_scattering(vec3(in.d), vec2(in.c) + 0.1f), 0)};
      },
      1e-5);
}

TEST_F(SharedFormulasGl, OfDirections) {
  expect_alike(
      "r = vec4(hammersley(i % 32, 32), way_from_surface(i % 16, i % 3)); s.xy = disc_point(c.xy);",
      [](const Input& in, int i) {
        return Output{vec4(shading::hammersley(i % 32, 32), shading::way_from_surface(i % 16, i % 3)),
                      vec4(shading::disc_point(vec2(in.c)), 0, 0)};
      },
      2e-5);
  expect_alike(
      "mat3 m = frame_around(a.xyz); r = vec4(m[0], m[1].x); s = vec4(m[1].yz, m[2].xy);",
      [](const Input& in, int) {
        const glm::mat3 m = shading::frame_around(vec3(in.a));
        return Output{vec4(m[0], m[1].x), vec4(m[1].y, m[1].z, m[2].x, m[2].y)};
      },
      1e-5);
  expect_alike(
      "r.xyz = visible_normal(b.xyz * frame_around(a.xyz), 0.01 + 0.99 * c.z, disc_point(c.xy));"
      "s.xyz = mirrored_way(-b.xyz, a.xyz, d.x, d.yz);",
      [](const Input& in, int) {
        return Output{vec4(shading::visible_normal(vec3(in.b) * shading::frame_around(vec3(in.a)), 0.01f + 0.99f * in.c.z,
                                                   shading::disc_point(vec2(in.c))),
                           0),
                      vec4(shading::mirrored_way(-vec3(in.b), vec3(in.a), in.d.x, vec2(in.d.y, in.d.z)), 0)};
      },
      2e-4);
}

TEST_F(SharedFormulasGl, OfNoise) {
  expect_alike(
      "uvec4 h = hash_of(uvec4(i, i * 7, 3, 11)); r = vec4(h & 0xffffu); s = vec4(h >> 16u);",
      [](const Input&, int i) {
        const auto n = static_cast<std::uint32_t>(i);
        const glm::uvec4 h = shading::hash_of(glm::uvec4(n, n * 7, 3, 11));
        return Output{vec4(h & 0xffffu), vec4(h >> 16u)};
      },
      0);
  expect_alike(
      "r = vec4(gaussian(ivec2(i, 3 * i - 100), 5u, 0u), gaussian(ivec2(0, i), uint(i), 2u), 0, 0);"
      "s.x = missing_sigma(c.x, c.y, c.z, d.x, d.y);",
      [](const Input& in, int i) {
        return Output{
            vec4(shading::gaussian({i, 3 * i - 100}, 5u, 0u), shading::gaussian({0, i}, static_cast<std::uint32_t>(i), 2u), 0, 0),
            vec4(shading::missing_sigma(in.c.x, in.c.y, in.c.z, in.d.x, in.d.y), 0, 0, 0)};
      },
      1e-6);
}

}  // namespace
}  // namespace catchlight::render::test
