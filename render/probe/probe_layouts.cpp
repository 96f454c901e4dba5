#include "render/probe/probe_layouts.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
constexpr int kMaxSide = 32768;

// ImfEnvmap.h: each face as seen from the inside, stacked.
const CubeFaces kOpenExrFaces{{{kX, kZ, -kY, 0, 0},
                               {-kX, -kZ, -kY, 0, 1},
                               {kY, kX, -kZ, 0, 2},
                               {-kY, kX, kZ, 0, 3},
                               {kZ, -kX, -kY, 0, 4},
                               {-kZ, kX, -kY, 0, 5}}};

const CubeFaces kGlFaces{{{kX, -kZ, -kY, 0, 0},
                          {-kX, kZ, -kY, 0, 1},
                          {kY, kX, kZ, 0, 2},
                          {-kY, kX, -kZ, 0, 3},
                          {kZ, kX, -kY, 0, 4},
                          {-kZ, -kX, -kY, 0, 5}}};

// HDRShop's and cmft's vertical cross: OpenGL's faces, -z turned by half a turn so that the middle column folds down.
const CubeFaces kCrossFaces{{{kX, -kZ, -kY, 2, 1},
                             {-kX, kZ, -kY, 0, 1},
                             {kY, kX, kZ, 1, 0},
                             {-kY, kX, -kZ, 1, 2},
                             {kZ, kX, -kY, 1, 1},
                             {-kZ, kX, kY, 1, 3}}};

glm::dvec2 latlong_texel(int width, int height, const glm::dvec3& direction) {
  const double longitude = std::atan2(direction.x, direction.z);
  const double latitude = std::atan2(direction.y, std::hypot(direction.x, direction.z));
  return {(0.5 - longitude / (2 * kPi)) * (width - 1), (0.5 - latitude / kPi) * (height - 1)};
}

glm::dvec3 latlong_direction(int width, int height, double x, double y) {
  const double longitude = (0.5 - x / (width - 1)) * 2 * kPi, latitude = (0.5 - y / (height - 1)) * kPi;
  return {std::sin(longitude) * std::cos(latitude), std::sin(latitude), std::cos(longitude) * std::cos(latitude)};
}

/// The z of the direction in the disc's middle.
double middle_z(ProbeLayout disc) {
  return disc == ProbeLayout::angular_inside ? -1 : 1;
}

glm::dvec2 disc_texel(ProbeLayout layout, int width, int height, const glm::dvec3& direction) {
  const double across = std::hypot(direction.x, direction.y), angle = std::atan2(across, middle_z(layout) * direction.z);
  const double radius = layout == ProbeLayout::mirror_ball ? std::sin(angle / 2) : angle / kPi;
  // Straight ahead is the middle; straight back is the whole rim, of which the rightmost point stands for all.
  const glm::dvec2 outward = across > 0 ? glm::dvec2(direction.x, direction.y) / across : glm::dvec2(1, 0);
  return {(radius * outward.x + 1) / 2 * width - 0.5, (1 - radius * outward.y) / 2 * height - 0.5};
}

std::optional<glm::dvec3> disc_direction(ProbeLayout layout, int width, int height, double x, double y) {
  const double u = (2 * x + 1) / width - 1, v = 1 - (2 * y + 1) / height, radius = std::hypot(u, v);
  if (radius > 1) return std::nullopt;
  const double angle = layout == ProbeLayout::mirror_ball ? 2 * std::asin(radius) : kPi * radius;
  const double scale = radius > 0 ? std::sin(angle) / radius : 0.0;
  return glm::dvec3(u * scale, v * scale, middle_z(layout) * std::cos(angle));
}

std::optional<glm::dvec3> cube_direction(ProbeLayout layout, int width, double x, double y) {
  const int size = face_size(layout, width);
  const int column = static_cast<int>(std::floor((x + 0.5) / size)), row = static_cast<int>(std::floor((y + 0.5) / size));
  for (const CubeFace& face : faces_of(layout)) {
    if (face.column != column || face.row != row) continue;
    const double s = face_from_texel(layout, size, x - column * size), t = face_from_texel(layout, size, y - row * size);
    return glm::normalize(face.centre + s * face.right + t * face.down);
  }
  return std::nullopt;
}

}  // namespace

ProbeLayout probe_layout_from_name(const std::string& name) {
  if (const auto layout = value_named<ProbeLayout>(name)) return *layout;
  throw Error("unknown probe layout \"" + name + "\": expected " + quoted_list(name_list<ProbeLayout>()));
}

const CubeFaces& gl_cube_faces() {
  return kGlFaces;
}

const CubeFaces& faces_of(ProbeLayout layout) {
  return layout == ProbeLayout::cube ? kOpenExrFaces : kCrossFaces;
}

int face_of(const CubeFaces& faces, const glm::dvec3& direction) {
  int best = 0;
  for (int i = 1; i < 6; ++i) {
    if (glm::dot(faces[i].centre, direction) > glm::dot(faces[best].centre, direction)) best = i;
  }
  return best;
}

glm::dvec2 position_on_face(const CubeFace& face, const glm::dvec3& direction) {
  return glm::dvec2(glm::dot(face.right, direction), glm::dot(face.down, direction)) / glm::dot(face.centre, direction);
}

glm::ivec2 nearest_disc_texel(int width, int height, int x, int y) {
  for (;;) {
    const glm::dvec2 from_middle((2 * x + 1.0) / width - 1, (2 * y + 1.0) / height - 1);
    const double radius = glm::length(from_middle);
    if (radius <= 1) return {x, y};
    x -= static_cast<int>(std::lround(from_middle.x / radius));
    y -= static_cast<int>(std::lround(from_middle.y / radius));
  }
}

void check_probe_shape(ProbeLayout layout, int width, int height, const std::string& what) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  const auto expect = [&](bool ok, const char* expected) {
    if (!ok) throw Error(what + ": " + size + " texels cannot be a " + name_of(layout) + " probe: expected " + expected);
  };
  expect(width <= kMaxSide && height <= kMaxSide, "at most 32768 texels a side");
  switch (layout) {
    case ProbeLayout::latlong:
      return expect(width >= 4 && height >= 3, "at least 4 x 3");
    case ProbeLayout::angular:
    case ProbeLayout::angular_inside:
    case ProbeLayout::mirror_ball:
      return expect(width >= 4 && width == height, "a square of at least 4 x 4");
    case ProbeLayout::cube_cross:
      return expect(width >= 6 && width % 3 == 0 && height == width / 3 * 4, "3 x 4 square faces of at least 2 x 2");
    case ProbeLayout::cube:
      return expect(width >= 2 && height == width * 6, "6 stacked square faces of at least 2 x 2");
  }
}

std::optional<glm::dvec3> direction_from_texel(ProbeLayout layout, int width, int height, double x, double y) {
  if (x < -0.5 || y < -0.5 || x >= width - 0.5 || y >= height - 0.5) return std::nullopt;
  if (layout == ProbeLayout::latlong) return latlong_direction(width, height, x, y);
  return is_disc(layout) ? disc_direction(layout, width, height, x, y) : cube_direction(layout, width, x, y);
}

glm::dvec2 texel_from_direction(ProbeLayout layout, int width, int height, const glm::dvec3& direction) {
  if (layout == ProbeLayout::latlong) return latlong_texel(width, height, direction);
  if (is_disc(layout)) return disc_texel(layout, width, height, direction);
  const CubeFace& face = faces_of(layout)[face_of(faces_of(layout), direction)];
  const glm::dvec2 position = position_on_face(face, direction);
  const int size = face_size(layout, width);
  return {face.column * size + texel_from_face(layout, size, position.x),
          face.row * size + texel_from_face(layout, size, position.y)};
}

}  // namespace catchlight::render
