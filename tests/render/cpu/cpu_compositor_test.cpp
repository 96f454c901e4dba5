// The processor's compositor as a whole: the same bytes whatever came before and however many cores there are, and scenes that
// are hard to draw. Needs no GL.
#include "render/cpu/cpu_compositor.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "render/math/sh.hpp"
#include "render/probe/light_samples.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

namespace {
long pretended_cores = sysconf(_SC_NPROCESSORS_ONLN);
}

/// What std::thread::hardware_concurrency() asks.
extern "C" int get_nprocs() {
  return static_cast<int>(pretended_cores);
}

namespace catchlight::render {
namespace {

constexpr int kBands = 3;

Material material_of(float metallic, float roughness) {
  Material material;
  material.base_color = {0.8f, 0.6f, 0.4f};
  material.metallic = metallic;
  material.roughness = roughness;
  return material;
}

ReflectionMap sky() {
  ReflectionMap map;
  for (int level = 0; level < 4; ++level) {
    Image faces(16 >> level, 6 * (16 >> level));
    for (std::size_t i = 0; i < faces.data.size(); ++i) faces.data[i] = 0.2f + 0.1f * static_cast<float>(i % 9);
    map.levels.push_back(faces);
  }
  return map;
}

/// Lit evenly and by two lamps; nothing of the mesh's own shadows is in the transfer.
RenderScene scene_of(Mesh mesh, bool has_lamps = true) {
  RenderScene scene;
  scene.transfer.bands = kBands;
  scene.transfer.object.assign(mesh.vertices.size() * kBands * kBands, glm::vec3(0.05f));
  scene.transfer.grid = {.min_m = glm::vec2(-0.12f), .max_m = glm::vec2(0.12f), .columns = 9, .rows = 9};
  scene.transfer.receiver.assign(81 * kBands * kBands, glm::vec3(0.1f));
  scene.transfer.receiver_unshadowed.assign(kBands * kBands, 0.1f);
  scene.light.assign(kBands * kBands, glm::vec3(1));
  if (has_lamps) {
    scene.transfer.object_direct = scene.transfer.object;
    scene.transfer.receiver_direct = scene.transfer.receiver;
    scene.lights = {{glm::normalize(glm::dvec3(0.5, 0.3, 1)), {1, 0.9, 0.7}, 0.02},
                    {glm::normalize(glm::dvec3(-1, 0.1, 0.6)), {0.5, 0.6, 0.9}, 0}};
  }
  scene.reflections = scene.rest_reflections = sky();
  scene.probe_in_tag_m = {0, 0, 0.05f};
  scene.mesh = std::move(mesh);
  return scene;
}

Mesh still() {
  Mesh mesh = sphere({0, 0, 0.05f}, 0.04f, 20);
  mesh.materials = {material_of(1, 0.3f)};
  Mesh other = box({0.02f, 0.03f, 0}, {0.08f, 0.09f, 0.05f});
  other.materials = {material_of(0, 0.6f)};
  append(mesh, other);
  return mesh;
}

FrameView view_of(double height_m = 0.4) {
  FrameView view;
  view.camera = {.width_px = 120, .height_px = 90, .fx_px = 160, .fy_px = 160, .cx_px = 59.5, .cy_px = 44.5};
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  view.camera_from_tag.translation_m = {0, 0, height_m};
  view.exposure = glm::vec3(2);
  view.effects.noise = {true, glm::vec3(1e-4f), glm::vec3(1e-5f), glm::mat3(1), {1, 1}, 4};
  return view;
}

Plate plate_of(const PixelRect& rect) {
  Plate plate{rect, Plate::Format::rgb_u8, RawVector<std::byte>(3 * static_cast<std::size_t>(rect.width) * rect.height)};
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x)
      for (int c = 0; c < 3; ++c)
        plate.pixels[3 * (static_cast<std::size_t>(y) * rect.width + x) + static_cast<std::size_t>(c)] =
            static_cast<std::byte>(60 + ((rect.x + x) * 3 + (rect.y + y) * 5 + 11 * c) % 120);
  return plate;
}

FrameView turned(FrameView view, double angle_rad) {
  view.light_turns = true;
  view.tag_from_light = glm::dmat3(glm::dvec3(std::cos(angle_rad), std::sin(angle_rad), 0),
                                   glm::dvec3(-std::sin(angle_rad), std::cos(angle_rad), 0), glm::dvec3(0, 0, 1));
  return view;
}

bool all_finite(const Composite& composite) {
  return std::ranges::all_of(composite.rgba, [](float value) { return std::isfinite(value) && value >= 0 && value <= 1; });
}

int changed_pixels(const Composite& composite) {
  int changed = 0;
  for (std::size_t i = 3; i < composite.rgba.size(); i += 4) changed += composite.rgba[i] != 0;
  return changed;
}

TEST(CpuCompositor, GivesTheSameBytesHoweverManyCoresThereAre) {
  const RenderScene scene = scene_of(still());
  FrameView view = view_of();
  view.effects.defocus_px2 = 0.5;
  const Composite expected = CpuCompositor(scene, {}).render(view, plate_of);
  EXPECT_GT(changed_pixels(expected), 500);
  const long cores = pretended_cores;
  for (const unsigned count : {1, 2, 4, 7}) {
    pretended_cores = count;
    ASSERT_EQ(std::thread::hardware_concurrency(), count);
    CpuCompositor compositor(scene, {});
    EXPECT_EQ(compositor.render(view, plate_of).rgba, expected.rgba) << count;
    EXPECT_EQ(compositor.render(view, plate_of).rgba, expected.rgba) << "once more";
  }
  pretended_cores = cores;
}

TEST(CpuCompositor, GivesTheSameBytesWhateverWasDrawnBefore) {
  const RenderScene scene = scene_of(still());
  CpuCompositor used(scene, {});
  used.render(view_of(0.25), plate_of, true);
  used.render(turned(view_of(0.6), 1), plate_of);
  FrameView odd = view_of();
  odd.camera.distortion = {-0.3, 0.1, 0, 0, 0, 0, 0, 0};
  odd.color.transfer = TransferFunction::linear;
  odd.black = glm::vec3(0.1f);
  odd.effects.defocus_px2 = 4;
  used.render(odd, plate_of);
  EXPECT_EQ(used.render(view_of(), plate_of).rgba, CpuCompositor(scene, {}).render(view_of(), plate_of).rgba);
}

/// A still camera's pose differs from frame to frame by what tracking does not know: some hundredths of a pixel. Outlines step
/// with their samples; within them, rays must not show.
TEST(CpuCompositor, RaysDoNotFlickerWhileTheCameraStandsStill) {
  for (const float roughness : {0.0f, 0.15f, 0.25f, 0.5f}) {
    RenderScene scene = scene_of(still());
    scene.mesh.materials.front().roughness = roughness;
    // An even sky: what moves in the picture of another moves rightly.
    for (ReflectionMap* map : {&scene.reflections, &scene.rest_reflections})
      for (Image& level : map->levels) std::ranges::fill(level.data, 0.4f);
    CpuCompositor compositor(scene, {});
    FrameView view = view_of();
    view.exposure = glm::vec3(1);
    view.effects.noise.enabled = false;
    const auto draw = [&] { return *compositor.render(view, plate_of, true).layers; };
    const Image first = draw().object;
    const auto is_within = [&](int x, int y) {
      bool covered = x > 0 && y > 0 && x + 1 < first.width && y + 1 < first.height;
      for (int i = 0; i < 9 && covered; ++i) covered = first.pixel(x + i % 3 - 1, y + i / 3 - 1)[3] == 1;
      return covered;
    };
    double squares = 0;
    int values = 0;
    for (const glm::dvec2& shift_px : {glm::dvec2(0.02, 0), {0, 0.02}, {-0.015, 0.015}}) {
      view.camera_from_tag.translation_m = {0.4 / 160 * shift_px, 0.4};
      const Image moved = draw().object;
      for (int y = 0; y < first.height; ++y)
        for (int x = 0; x < first.width; ++x)
          for (int c = 0; c < 3 && is_within(x, y); ++c) {
            const auto code = [&](const Image& light) { return 255 * srgb_from_linear(std::min(light.pixel(x, y)[c], 1.0f)); };
            squares += std::pow(code(moved) - code(first), 2), ++values;
          }
    }
    EXPECT_GT(values, 3000);
    EXPECT_LE(std::sqrt(squares / values), 0.3) << "roughness " << roughness;
  }
}

TEST(CpuCompositor, LightThatTurnsEveryFrameIsTheLightTurned) {
  const RenderScene scene = scene_of(still());
  CpuCompositor compositor(scene, {});
  for (int frame = 0; frame < 5; ++frame) {
    const FrameView view = turned(view_of(), 0.4 * frame);
    const Composite composite = compositor.render(view, plate_of);
    EXPECT_TRUE(all_finite(composite));
    EXPECT_EQ(composite.rgba, CpuCompositor(scene, {}).render(view, plate_of).rgba) << frame;
  }
}

TEST(CpuCompositor, KeepsOnDiskOnlyWhatIsFoundInALightThatStandsStill) {
  const TempFolder folder;
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string restored = before ? before : "";
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  const auto entries = [&] {
    const std::filesystem::path cache = folder / "cache/catchlight";
    return std::filesystem::exists(cache) ? std::distance(std::filesystem::directory_iterator(cache), {}) : 0;
  };
  RenderScene scene = scene_of(still());
  const Composite expected = CpuCompositor(scene, {}).render(view_of(), plate_of);
  EXPECT_EQ(entries(), 0) << "a scene without a name";
  scene.transfer_key = "still life";
  {
    CpuCompositor turning(scene, {});
    for (const double angle_rad : {0.1, 0.2}) turning.render(turned(view_of(), angle_rad), plate_of);
  }
  EXPECT_EQ(entries(), 0) << "light that turns";
  for (int run = 0; run < 3; ++run) {
    EXPECT_EQ(CpuCompositor(scene, {}).render(view_of(), plate_of).rgba, expected.rgba) << run;
    EXPECT_EQ(entries(), 2) << "the object's light, and the receiver's shadow";
  }
  before ? setenv("XDG_CACHE_HOME", restored.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
}

TEST(CpuCompositor, DrawsAnObjectLargerThanTheFrame) {
  const Composite composite = CpuCompositor(scene_of(still()), {}).render(view_of(0.1), plate_of);
  EXPECT_TRUE(all_finite(composite));
  EXPECT_GT(changed_pixels(composite), 5000);
}

TEST(CpuCompositor, DrawsWithTheCameraWithinTheObject) {
  Mesh mesh = sphere({0, 0, 0.2f}, 0.25f, 20);
  mesh.materials = {material_of(1, 0.3f)};
  const Composite composite = CpuCompositor(scene_of(mesh), {}).render(view_of(0.2), plate_of);
  EXPECT_TRUE(all_finite(composite));
  EXPECT_EQ(changed_pixels(composite), 120 * 90);
}

TEST(CpuCompositor, DrawsDegenerateTriangles) {
  Mesh mesh = still();
  add_triangle(mesh, 0, 0, 1);
  add_triangle(mesh, 5, 5, 5);
  mesh.vertices.push_back({{0.01f, 0, 0.02f}, glm::vec3(0)});
  mesh.vertices.push_back({{0.02f, 0, 0.02f}, glm::vec3(0)});
  mesh.vertices.push_back({{0.03f, 0.03f, 0.15f}, glm::vec3(0)});
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  add_triangle(mesh, last - 2, last - 1, last);  // without normals
  const Composite composite = CpuCompositor(scene_of(mesh), {}).render(view_of(), plate_of);
  EXPECT_TRUE(all_finite(composite));
  EXPECT_GT(changed_pixels(composite), 500);
}

TEST(CpuCompositor, DrawsTwoMillionTriangles) {
  constexpr int kSide = 1000;
  Mesh mesh;
  mesh.materials = {material_of(0, 0.5f)};
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) {
      const glm::vec2 p = glm::vec2(x, y) / float{kSide} * 0.1f - 0.05f;
      mesh.vertices.push_back({{p, 0.02f + 0.005f * std::sin(200 * p.x) * std::cos(150 * p.y)}, {0, 0, 1}});
    }
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  mesh.triangle_material.assign(mesh.indices.size() / 3, 0);
  const Composite composite = CpuCompositor(scene_of(mesh, false), {}).render(view_of(), plate_of);
  EXPECT_TRUE(all_finite(composite));
  EXPECT_GT(changed_pixels(composite), 1000);
}

TEST(CpuCompositor, WithNothingInSightLeavesTheFrameAlone) {
  const RenderScene scene = scene_of(still());
  CpuCompositor compositor(scene, {});
  FrameView view = view_of();
  view.camera_from_tag.translation_m = {3, 0, 0.4};
  EXPECT_EQ(changed_pixels(compositor.render(view, plate_of)), 0);
  view.camera_from_tag.translation_m = {0, 0, -1};
  EXPECT_EQ(changed_pixels(compositor.render(view, plate_of)), 0) << "behind the camera";
  view.has_pose = false;
  EXPECT_TRUE(compositor.render(view, plate_of).rect.empty());
}

TEST(CpuCompositor, RefusesWhatDoesNotFitTogether) {
  RenderScene scene = scene_of(still());
  scene.mesh.indices[7] = 1u << 30;
  EXPECT_THROW(CpuCompositor(scene, {}), Error);
  scene = scene_of(still());
  CpuCompositor compositor(scene, {});
  const auto short_plate = [](const PixelRect& rect) { return Plate{rect, Plate::Format::rgb_u8, RawVector<std::byte>(5)}; };
  EXPECT_THROW(compositor.render(view_of(), short_plate), Error);
  EXPECT_THROW(compositor.render(view_of(), [](const PixelRect&) { return plate_of({1, 2, 3, 4}); }), Error);
}

}  // namespace
}  // namespace catchlight::render
