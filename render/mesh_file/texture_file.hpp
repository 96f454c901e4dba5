// Textures from picture files.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "catchlight/error.hpp"
#include "render/mesh/texture.hpp"

namespace catchlight::render {

/// No side of a texture is longer.
inline constexpr int kMaxTextureSide = 8192;

/// The picture in a file that lies in memory: PNG, JPEG or TIFF of any depth and number of channels. One that is larger than
/// kMaxTextureSide is made smaller, with a warning that begins with `name`. Throws Error as decode_picture.
TextureLevel decode_texture(std::span<const std::uint8_t> file, const std::string& name, const WarningHandler& warn);

/// How a texture is used: the same picture may be colour for one material and data for another.
struct TextureUse {
  bool is_srgb = false;
  std::array<TextureWrap, 2> wrap{};
};

/// The texture in a file on disk. Throws Error naming the file.
std::shared_ptr<const Texture> read_texture(const std::string& path, const TextureUse& use, const WarningHandler& warn);

/// A mesh's textures. Each picture is decoded and has its mipmaps made once for each way that it is used.
class TextureList {
 public:
  explicit TextureList(std::vector<std::shared_ptr<const Texture>>& textures) : textures_(textures) {}

  /// The texture's number in the list. `name` tells pictures apart; `decode` is called where the texture is new.
  int number_of(const std::string& name, const TextureUse& use, const std::function<TextureLevel()>& decode);

 private:
  std::vector<std::shared_ptr<const Texture>>& textures_;
  std::map<std::tuple<std::string, bool, std::array<TextureWrap, 2>>, int> numbers_;
};

}  // namespace catchlight::render
