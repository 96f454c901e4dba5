// What the GL tests share: a context, and scenes whose pictures are known in closed form.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "render/frame_view.hpp"
#include "render/gl/gl_context.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/prefilter.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render::test {

/// One context for all tests of a process: making one costs a fifth of a second.
class GlTest : public ::testing::Test {
 protected:
  void SetUp() override { static const std::unique_ptr<GlContext> context = make_headless_context(); }
  void TearDown() override { check_gl("the test"); }
};

/// Unit sphere times `radius_m` around `center_m`; rings from pole to pole.
Mesh sphere(double radius_m, const glm::dvec3& center_m, int rings = 48);

/// Two triangles (counter-clockwise seen from +z) at height z_m.
Mesh square(const glm::dvec2& min_m, const glm::dvec2& max_m, double z_m);

/// Unshadowed transfer by the closed form; nothing for vertices whose material has no diffuse part.
Transfer unshadowed_transfer(const Mesh& mesh, int bands);

/// Adds a grid on which `ratio(x, y)` of the unshadowed light arrives.
void add_receiver(Transfer& transfer, const ReceiverGrid& grid, const std::function<double(double, double)>& ratio);

/// Light of the same radiance from everywhere.
ShRgb constant_light(const glm::vec3& radiance, int bands);

/// Cube faces filled by `radiance` of the direction; `levels` copies of it.
ReflectionMap reflections_of(const std::function<glm::vec3(const glm::dvec3&)>& radiance, int face_size, int levels = 1);

/// A scene of a mesh under constant light; `material` becomes its first one.
RenderScene constant_scene(Mesh mesh, const Material& material, const glm::vec3& radiance, int bands = 3);

/// Settings for tests whose light exceeds white without being about glare.
CompositorSettings without_glare();

/// 160 x 120 pixels, looking straight down at the tag from `height_m`; picture right = tag x, picture up = tag y.
FrameView view_from_above(double height_m = 0.5);

/// The same of footage whose codes are linear light, and half of the sensor's white in all of it.
FrameView linear_view_from_above();
PlateReader linear_grey_plate();

/// A plate whose pixel at (x, y) of the frame is code(x, y) of 255.
PlateReader plate_u8(const std::function<glm::ivec3(int, int)>& code);
PlateReader plate_u8(int code);
PlateReader plate_f32(const std::function<glm::vec3(int, int)>& code);

/// The composite's pixel at (x, y) of the frame.
glm::vec4 pixel_at(const Composite& composite, int x, int y);

/// Whether the composite holds that pixel; beyond it the frame is the plate's.
bool holds(const Composite& composite, int x, int y);

}  // namespace catchlight::render::test
