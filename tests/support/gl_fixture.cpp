#include "tests/support/gl_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <numbers>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/response.hpp"

namespace catchlight::render::test {
namespace {

void finish(Mesh& mesh) {
  mesh.materials.resize(1);
  mesh.triangle_material.assign(mesh.indices.size() / 3, 0);
}

/// Direction of OpenGL's cube map texel: face, and s, t in -1..1 (OpenGL 4.5 specification, table 8.19).
glm::dvec3 cube_direction(int face, double s, double t) {
  const glm::dvec3 directions[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
  return glm::normalize(directions[face]);
}

/// Calls `set(x, y, texel)` for each pixel of the rectangle, texel counted in pixels.
template <typename Set>
void for_each_pixel(const PixelRect& rect, const Set& set) {
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) set(rect.x + x, rect.y + y, static_cast<std::size_t>(y) * rect.width + x);
  }
}

}  // namespace

Mesh sphere(double radius_m, const glm::dvec3& center_m, int rings) {
  Mesh mesh;
  const int sectors = 2 * rings;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int sector = 0; sector <= sectors; ++sector) {
      const double theta = std::numbers::pi * ring / rings, phi = 2 * std::numbers::pi * sector / sectors;
      const glm::dvec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      mesh.vertices.push_back({glm::vec3(center_m + radius_m * n), glm::vec3(n), glm::vec3(1)});
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const auto a = static_cast<std::uint32_t>(ring * (sectors + 1) + sector), b = a + static_cast<std::uint32_t>(sectors) + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  finish(mesh);
  return mesh;
}

Mesh square(const glm::dvec2& min_m, const glm::dvec2& max_m, double z_m) {
  Mesh mesh;
  for (const glm::dvec2& corner : {min_m, glm::dvec2(max_m.x, min_m.y), max_m, glm::dvec2(min_m.x, max_m.y)}) {
    mesh.vertices.push_back({glm::vec3(glm::dvec3(corner, z_m)), glm::vec3(0, 0, 1), glm::vec3(1)});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  finish(mesh);
  return mesh;
}

Transfer unshadowed_transfer(const Mesh& mesh, int bands) {
  Transfer transfer;
  transfer.bands = bands;
  std::vector<const Material*> material_of(mesh.vertices.size(), &mesh.materials.front());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    material_of[mesh.indices[i]] = &mesh.materials[mesh.triangle_material[i / 3]];
  std::vector<float> y(static_cast<std::size_t>(sh_count(bands)));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    evaluate_sh(glm::normalize(glm::dvec3(mesh.vertices[v].normal)), bands, y);
    const bool is_diffuse = material_of[v]->base_color * mesh.vertices[v].color * (1 - material_of[v]->metallic) != glm::vec3(0);
    for (int l = 0; l < bands; ++l) {
      for (int m = -l; m <= l; ++m) {
        transfer.object.emplace_back(
            is_diffuse ? static_cast<float>(cosine_lobe_over_pi(l)) * y[static_cast<std::size_t>(sh_index(l, m))] : 0.0f);
      }
    }
  }
  return transfer;
}

void add_receiver(Transfer& transfer, const ReceiverGrid& grid, const std::function<double(double, double)>& ratio) {
  transfer.grid = grid;
  std::vector<float> y(static_cast<std::size_t>(sh_count(transfer.bands)));
  evaluate_sh({0, 0, 1}, transfer.bands, y);
  transfer.receiver_unshadowed.clear();
  for (int l = 0; l < transfer.bands; ++l) {
    for (int m = -l; m <= l; ++m) {
      transfer.receiver_unshadowed.push_back(static_cast<float>(cosine_lobe_over_pi(l)) *
                                             y[static_cast<std::size_t>(sh_index(l, m))]);
    }
  }
  transfer.receiver.clear();
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const glm::dvec2 share(column / (grid.columns - 1.0), row / (grid.rows - 1.0));
      const glm::dvec2 p = glm::mix(glm::dvec2(grid.min_m), glm::dvec2(grid.max_m), share);
      for (const float unshadowed : transfer.receiver_unshadowed) {
        transfer.receiver.emplace_back(unshadowed * static_cast<float>(ratio(p.x, p.y)));
      }
    }
  }
}

ShRgb constant_light(const glm::vec3& radiance, int bands) {
  ShRgb light(static_cast<std::size_t>(sh_count(bands)), glm::vec3(0));
  light[0] = radiance * static_cast<float>(2 * std::sqrt(std::numbers::pi));
  return light;
}

ReflectionMap reflections_of(const std::function<glm::vec3(const glm::dvec3&)>& radiance, int face_size, int levels) {
  ReflectionMap map;
  for (int level = 0; level < levels; ++level) {
    const int size = std::max(face_size >> level, 1);
    Image image(size, 6 * size);
    for (int y = 0; y < 6 * size; ++y) {
      for (int x = 0; x < size; ++x) {
        const glm::vec3 value = radiance(cube_direction(y / size, (2 * x + 1.0) / size - 1, (2 * (y % size) + 1.0) / size - 1));
        std::memcpy(image.pixel(x, y), &value, sizeof value);
      }
    }
    map.levels.push_back(std::move(image));
  }
  return map;
}

RenderScene constant_scene(Mesh mesh, const Material& material, const glm::vec3& radiance, int bands) {
  mesh.materials.resize(std::max<std::size_t>(mesh.materials.size(), 1));
  mesh.materials.front() = material;
  RenderScene scene{.mesh = mesh,
                    .transfer = unshadowed_transfer(mesh, bands),
                    .light = constant_light(radiance, bands),
                    .reflections = reflections_of([&](const glm::dvec3&) { return radiance; }, 4)};
  return scene;
}

CompositorSettings without_glare() {
  CompositorSettings settings;
  settings.glare.enabled = false;
  return settings;
}

FrameView view_from_above(double height_m) {
  FrameView view;
  view.camera = {.width_px = 160, .height_px = 120, .fx_px = 200, .fy_px = 200, .cx_px = 79.5, .cy_px = 59.5, .distortion = {}};
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  view.camera_from_tag.translation_m = {0, 0, height_m};
  return view;
}

PlateReader plate_u8(const std::function<glm::ivec3(int, int)>& code) {
  return [code](const PixelRect& rect) {
    Plate plate{rect, Plate::Format::rgb_u8, RawVector<std::byte>(static_cast<std::size_t>(rect.width) * rect.height * 3)};
    for_each_pixel(rect, [&](int x, int y, std::size_t i) {
      const glm::ivec3 value = code(x, y);
      for (int c = 0; c < 3; ++c) plate.pixels[3 * i + c] = static_cast<std::byte>(value[c]);
    });
    return plate;
  };
}

PlateReader plate_u8(int code) {
  return plate_u8([code](int, int) { return glm::ivec3(code); });
}

PlateReader plate_f32(const std::function<glm::vec3(int, int)>& code) {
  return [code](const PixelRect& rect) {
    Plate plate{rect, Plate::Format::rgb_f32, RawVector<std::byte>(static_cast<std::size_t>(rect.width) * rect.height * 12)};
    for_each_pixel(rect, [&](int x, int y, std::size_t i) {
      const glm::vec3 value = code(x, y);
      std::memcpy(&plate.pixels[12 * i], &value, 12);
    });
    return plate;
  };
}

bool holds(const Composite& composite, int x, int y) {
  const PixelRect& r = composite.rect;
  return x >= r.x && y >= r.y && x < r.x + r.width && y < r.y + r.height;
}

glm::vec4 pixel_at(const Composite& composite, int x, int y) {
  const PixelRect& r = composite.rect;
  if (!holds(composite, x, y)) {
    ADD_FAILURE() << "pixel " << x << ", " << y << " is outside the composite";
    return {};
  }
  const float* p = &composite.rgba[(static_cast<std::size_t>(y - r.y) * r.width + (x - r.x)) * 4];
  return {p[0], p[1], p[2], p[3]};
}

FrameView linear_view_from_above() {
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  return view;
}

PlateReader linear_grey_plate() {
  return plate_f32([](int, int) { return glm::vec3(0.5f); });
}

}  // namespace catchlight::render::test
