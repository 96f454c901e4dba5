// The renderers, for tests of what each of them must draw.
#pragma once

#include "render/cpu/cpu_compositor.hpp"
#include "render/gl_compositor.hpp"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {

using Renderers = ::testing::Types<GlCompositor, CpuCompositor>;

/// TYPED_TEST_SUITE's third argument: what the renderers are called in the tests' names.
struct RendererNames {
  template <typename Renderer>
  static std::string GetName(int) {
    return std::is_same_v<Renderer, GlCompositor> ? "gl" : "cpu";
  }
};

/// A fixture of TYPED_TEST_SUITE(..., Renderers, RendererNames): its tests run with each renderer as TypeParam.
template <typename Renderer>
class EachRenderer : public GlTest {};

}  // namespace catchlight::render::test
