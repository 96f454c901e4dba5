// Pictures on surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace catchlight::render {

enum class TextureWrap { repeat, clamp, mirror };

/// 8-bit RGBA, row-major, the first row at texture coordinate v = 0.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// A picture on a surface with its mipmaps, each half as wide and high as the one before (rounded down), to 1 x 1.
struct Texture {
  std::string name;
  bool is_srgb = false;  ///< its colour; what is data is linear. Opacity is linear.
  std::array<TextureWrap, 2> wrap{};
  std::vector<TextureLevel> levels;
};

/// Makes the mipmaps by means of neighbours, in linear light. `picture` must not be empty.
Texture make_texture(std::string name, TextureLevel picture, bool is_srgb, std::array<TextureWrap, 2> wrap);

/// How texture coordinates change from a pixel of the frame to the next.
struct TextureFootprint {
  glm::vec2 along_x{0}, along_y{0};
};

/// The picture's mean over the footprint at `uv`, linear RGBA: up to kMaxAnisotropy places along the footprint's longer axis,
/// each between four texels of two mipmaps. Coordinates that are not finite give the coarsest level's mean.
glm::vec4 look_up(const Texture& texture, const glm::vec2& uv, const TextureFootprint& footprint);
inline constexpr int kMaxAnisotropy = 16;

/// A texture in a material.
struct MaterialTexture {
  int texture = -1;           ///< in Mesh::textures; -1: none
  int set = 0;                ///< of texture coordinates
  glm::mat3 uv_transform{1};  ///< applied to them first (KHR_texture_transform)
  float strength = 1;         ///< of a normal map's slopes, or of occlusion

  bool is_used() const { return texture >= 0; }
};

}  // namespace catchlight::render
