#include "render/passes/reflection_texture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/scene_check.hpp"

namespace catchlight::render {
namespace {

constexpr int kFaces = 6;

/// Level count of a full mip chain under faces of this size.
int mip_count(int face_size) {
  return static_cast<int>(std::floor(std::log2(face_size))) + 1;
}

/// Faces of `size` texels: averages of the source's texels where it shrinks, their nearest where it grows.
Image with_face_size(const Image& level, int size) {
  Image result(size, kFaces * size);
  const double scale = static_cast<double>(level.width) / size;
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < size; ++x) {
      const int x0 = static_cast<int>(x * scale), y0 = static_cast<int>(y * scale);
      const int x1 = std::max(x0 + 1, static_cast<int>((x + 1) * scale)),
                y1 = std::max(y0 + 1, static_cast<int>((y + 1) * scale));
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int v = y0; v < y1; ++v) {
          for (int u = x0; u < x1; ++u) sum += level.pixel(u, v)[c];
        }
        result.pixel(x, y)[c] = static_cast<float>(sum / ((x1 - x0) * (y1 - y0)));
      }
    }
  }
  return result;
}

/// NaN, infinite and negative texels become 0: bilinear filtering would spread them.
void make_finite(Image& level) {
  for (float& value : level.data) value = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
}

}  // namespace

GlTexture make_reflection_texture(const ReflectionMap& reflections) {
  check_cubes(reflections);
  std::vector<Image> levels = reflections.levels;
  if (levels.empty()) levels.emplace_back(1, kFaces);
  int face_size = levels.front().width;
  // GL's chain ends at one texel: a coarser map with many levels is enlarged.
  while (mip_count(face_size) < static_cast<int>(levels.size())) face_size *= 2;

  GLint limit = 0;
  glGetIntegerv(GL_MAX_CUBE_MAP_TEXTURE_SIZE, &limit);
  if (face_size > limit)
    throw Error("reflection faces of " + std::to_string(face_size) + " texels exceed this OpenGL's " + std::to_string(limit));

  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_CUBE_MAP, 1, &id);
  GlTexture texture(id);
  glObjectLabel(GL_TEXTURE, id, -1, "reflections");
  glTextureStorage2D(id, static_cast<GLsizei>(levels.size()), GL_RGB32F, face_size, face_size);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const int size = face_size >> k;
    Image level = levels[k].width == size ? std::move(levels[k]) : with_face_size(levels[k], size);
    make_finite(level);
    glTextureSubImage3D(id, static_cast<GLint>(k), 0, 0, 0, size, size, kFaces, GL_RGB, GL_FLOAT, level.data.data());
  }
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  return texture;
}

GlTexture make_brdf_texture() {
  constexpr int size = 64;
  static const Image table = environment_brdf_table(size);  // the same for every scene
  GlTexture texture = make_texture_2d("environment BRDF", GL_RG32F, size, size, GL_LINEAR);
  glTextureSubImage2D(texture.id(), 0, 0, 0, size, size, GL_RG, GL_FLOAT, table.data.data());
  return texture;
}

}  // namespace catchlight::render
