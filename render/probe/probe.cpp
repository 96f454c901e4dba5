#include "render/probe/probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "catchlight/util/parallel.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

glm::vec3 texel(const Image& image, int x, int y) {
  const float* value = image.pixel(x, y);
  return {value[0], value[1], value[2]};
}

// Bilinear blend of fetch(x, y) at the four integers around (x, y).
template <typename Fetch>
glm::vec3 bilinear(const glm::dvec2& position, const Fetch& fetch) {
  const int x = static_cast<int>(std::floor(position.x)), y = static_cast<int>(std::floor(position.y));
  const float right = static_cast<float>(position.x - x), down = static_cast<float>(position.y - y);
  return glm::mix(glm::mix(fetch(x, y), fetch(x + 1, y), right), glm::mix(fetch(x, y + 1), fetch(x + 1, y + 1), right), down);
}

/// What bilinear() gives well within an image, a register a texel. Reads a float beyond the four texels.
glm::vec3 blend_of_four(const float* upper, const float* lower, float right, float down) {
  const auto mixed = [](Float4 a, Float4 b, float share) { return a * (1 - share) + b * share; };
  return rgb(mixed(mixed(load(upper), load(upper + 3), right), mixed(load(lower), load(lower + 3), right), down));
}

glm::vec3 sample_latlong(const Image& image, const glm::dvec2& position) {
  if (position.x >= 1 && position.y >= 0 && position.x < image.width - 3 && position.y < image.height - 1) {
    const int x = static_cast<int>(position.x), y = static_cast<int>(position.y);
    return blend_of_four(image.pixel(x, y), image.pixel(x, y + 1), static_cast<float>(position.x - x),
                         static_cast<float>(position.y - y));
  }
  return bilinear(position, [&](int x, int y) {
    y = std::clamp(y, 0, image.height - 1);
    // The outermost columns are the same meridian.
    if (x <= 0 || x >= image.width - 1) return 0.5f * (texel(image, 0, y) + texel(image, image.width - 1, y));
    return texel(image, x, y);
  });
}

// Texel of a face, or, beyond its border, the texel of the face next to it; beyond a corner the mean of the three that meet
// there.
glm::vec3 cube_texel(const Probe& probe, const CubeFace& face, int size, int x, int y) {
  const auto inside = [&](int i) { return i >= 0 && i < size; };
  if (inside(x) && inside(y)) return texel(probe.image, face.column * size + x, face.row * size + y);
  if (!inside(x) && !inside(y)) {
    const int corner_x = std::clamp(x, 0, size - 1), corner_y = std::clamp(y, 0, size - 1);
    return (cube_texel(probe, face, size, corner_x, corner_y) + cube_texel(probe, face, size, x, corner_y) +
            cube_texel(probe, face, size, corner_x, y)) /
           3.0f;
  }
  const glm::dvec3 direction =
      face.centre + face_from_texel(probe.layout, size, x) * face.right + face_from_texel(probe.layout, size, y) * face.down;
  const glm::dvec2 there = texel_from_direction(probe.layout, probe.image.width, probe.image.height, direction);
  return texel(probe.image, static_cast<int>(std::lround(there.x)), static_cast<int>(std::lround(there.y)));
}

glm::vec3 sample_cube(const Probe& probe, const glm::dvec3& direction) {
  const CubeFaces& faces = faces_of(probe.layout);
  const CubeFace& face = faces[face_of(faces, direction)];
  const int size = face_size(probe.layout, probe.image.width);
  const glm::dvec2 position = position_on_face(face, direction);
  const glm::dvec2 in_face(texel_from_face(probe.layout, size, position.x), texel_from_face(probe.layout, size, position.y));
  if (probe.layout == ProbeLayout::cube) {  // texel centres reach the borders: no neighbour is ever needed
    return bilinear(in_face, [&](int x, int y) {
      return cube_texel(probe, face, size, std::clamp(x, 0, size - 1), std::clamp(y, 0, size - 1));
    });
  }
  return bilinear(in_face, [&](int x, int y) { return cube_texel(probe, face, size, x, y); });
}

glm::vec3 disc_at(const Image& image, const glm::dvec2& position) {
  return bilinear(position, [&](int x, int y) {
    const glm::ivec2 valid = nearest_disc_texel(image.width, image.height, x, y);
    return texel(image, valid.x, valid.y);
  });
}

glm::vec3 sample_disc(const Probe& probe, const glm::dvec3& direction) {
  const int width = probe.image.width, height = probe.image.height;
  const glm::dvec2 position = texel_from_direction(probe.layout, width, height, direction);
  const glm::vec3 value = disc_at(probe.image, position);
  // Straight back is the whole rim: over the last texel fade to the mean of four of its points, so that the value there is one.
  const glm::dvec2 middle((width - 1) / 2.0, (height - 1) / 2.0);
  const double texels_from_rim = width / 2.0 - glm::distance(position, middle);
  if (texels_from_rim >= 1) return value;
  glm::vec3 rim(0);
  for (const glm::dvec2& side : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(-1, 0), glm::dvec2(0, -1)}) {
    rim += 0.25f * disc_at(probe.image, middle + side * (width / 2.0));
  }
  return glm::mix(rim, value, static_cast<float>(std::max(texels_from_rim, 0.0)));
}

// Widths with about the same angle per texel at the equator (of a disc: along its radius; of a face: in its middle).
double texels_per_turn(ProbeLayout layout, int width) {
  switch (layout) {
    case ProbeLayout::latlong:
      return width - 1;
    case ProbeLayout::angular:
    case ProbeLayout::angular_inside:
    case ProbeLayout::mirror_ball:
      return width;  // the ball's middle has pi/2 times as few, its rim is far denser
    case ProbeLayout::cube_cross:
      return width / 3 * kPi;
    case ProbeLayout::cube:
      return (width - 1) * kPi;
  }
  return width;
}

glm::ivec2 size_with(ProbeLayout layout, double per_turn) {
  const int side = std::max(2, static_cast<int>(std::lround(per_turn / kPi)));
  switch (layout) {
    case ProbeLayout::latlong: {
      const int height = std::max(3, static_cast<int>(std::lround((per_turn + 1) / 2)));
      return {2 * height, height};
    }
    case ProbeLayout::angular:
    case ProbeLayout::angular_inside:
    case ProbeLayout::mirror_ball:
      return glm::ivec2(std::max(4, static_cast<int>(std::lround(per_turn))));
    case ProbeLayout::cube_cross:
      return {3 * side, 4 * side};
    case ProbeLayout::cube:
      return {side + 1, 6 * (side + 1)};
  }
  return {};
}

glm::ivec2 size_of_width(ProbeLayout layout, int width) {
  switch (layout) {
    case ProbeLayout::latlong:
      return {width, (width + 1) / 2};
    case ProbeLayout::angular:
    case ProbeLayout::angular_inside:
    case ProbeLayout::mirror_ball:
      return {width, width};
    case ProbeLayout::cube_cross:
      return {width, width / 3 * 4};
    case ProbeLayout::cube:
      return {width, width * 6};
  }
  return {};
}

}  // namespace

glm::vec3 sample(const Probe& probe, const glm::dvec3& direction) {
  if (probe.layout == ProbeLayout::latlong) {
    const int width = probe.image.width, height = probe.image.height;
    return sample_latlong(probe.image, texel_from_direction(probe.layout, width, height, direction));
  }
  return is_disc(probe.layout) ? sample_disc(probe, direction) : sample_cube(probe, direction);
}

void sample(const Probe& probe, const Coordinates3& directions, std::span<glm::vec3> radiance) {
  if (probe.layout != ProbeLayout::latlong) {
    for (std::size_t i = 0; i < radiance.size(); ++i)
      radiance[i] = sample(probe, glm::dvec3(directions.x[i], directions.y[i], directions.z[i]));
    return;
  }
  Coordinates2 texels(radiance.size());
  texels_from_directions(probe.layout, probe.image.width, probe.image.height, directions, texels);
  for (std::size_t i = 0; i < radiance.size(); ++i)
    radiance[i] = sample_latlong(probe.image, glm::dvec2(texels.x[i], texels.y[i]));
}

Probe mirrored(const Probe& probe) {
  const Image& image = probe.image;
  Probe result{Image(image.width, image.height), probe.layout};
  for (int y = 0; y < image.height; ++y) {
    // OpenEXR's cube has +x and -x one above the other; all other layouts have them right and left of their middle.
    const int side = image.width, face = y / side;
    const int from = probe.layout == ProbeLayout::cube && face < 2 ? (1 - face) * side + y % side : y;
    for (int x = 0; x < image.width; ++x) std::copy_n(image.pixel(image.width - 1 - x, from), 3, result.image.pixel(x, y));
  }
  return result;
}

Probe convert(const Probe& probe, ProbeLayout layout, int width) {
  if (layout == probe.layout && (width == 0 || width == probe.image.width)) return probe;
  const glm::ivec2 size =
      width > 0 ? size_of_width(layout, width) : size_with(layout, texels_per_turn(probe.layout, probe.image.width));
  check_probe_shape(layout, size.x, size.y, "converting a probe");
  // Several directions across each new texel are averaged, more where it is larger than the old ones: no light between them is
  // lost.
  const double ratio = texels_per_turn(probe.layout, probe.image.width) / texels_per_turn(layout, size.x);
  const int taps = std::clamp(static_cast<int>(std::ceil(2 * ratio - 0.01)), 2, 64);
  Probe result{Image(size.x, size.y), layout};
  parallel_for(size.y, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.x; ++x) {
      if (!direction_from_texel(layout, size.x, size.y, x, y)) continue;
      glm::dvec3 sum(0);
      int count = 0;
      for (int tap = 0; tap < taps * taps; ++tap) {
        const double dx = (tap % taps + 0.5) / taps - 0.5, dy = (tap / taps + 0.5) / taps - 0.5;
        if (const auto direction = direction_from_texel(layout, size.x, size.y, x + dx, y + dy)) {
          sum += glm::dvec3(sample(probe, *direction));
          ++count;
        }
      }
      for (int c = 0; c < 3; ++c) result.image.pixel(x, y)[c] = static_cast<float>(sum[c] / std::max(count, 1));
    }
  });
  weld_seams(result);
  return result;
}

glm::dmat3 tag_from_probe(UpAxis up, double yaw_deg) {
  const double yaw = yaw_deg * kPi / 180;
  // Columns: where probe +x, +y and +z go. The yaw turns about probe +y, counter-clockwise seen from above.
  const glm::dmat3 turned(glm::dvec3(std::cos(yaw), 0, -std::sin(yaw)), glm::dvec3(0, 1, 0),
                          glm::dvec3(std::sin(yaw), 0, std::cos(yaw)));
  const glm::dmat3 table(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
  return up == UpAxis::z ? table * turned : turned;
}

}  // namespace catchlight::render
