// Textures of Wavefront's material libraries.
#pragma once

#include <optional>
#include <string>

#include "render/mesh_file/text_lines.hpp"
#include "render/mesh_file/texture_file.hpp"

namespace catchlight::render {

/// What a line such as `map_Kd -s 2 2 -clamp on wood.png` says.
struct ObjMap {
  std::string file;  ///< the name as it is written
  glm::mat3 uv_transform{1};
  float multiplier = 1;  ///< -bm
  bool is_clamped = false;
};

/// The line that `lines` is at. Throws Error naming file and line.
ObjMap obj_map(const TextLines& lines);

/// Where the library's picture is. Names with folders of another machine are looked for beside the library. Empty: nowhere.
std::string path_of_obj_map(const std::string& library, const ObjMap& map);

/// Reads the textures of a library.
class ObjTextureReader {
 public:
  ObjTextureReader(const std::string& library, TextureList& textures, const WarningHandler& warn)
      : library_(library), textures_(textures), warn_(warn) {}

  /// The texture of the line; none, with a warning, where the picture is not there or cannot be decoded.
  MaterialTexture read(const TextLines& lines, bool is_srgb);

  /// The same of a bump map, where its picture is one of normals (bluish) and not of heights (grey), as `norm` is anyway.
  MaterialTexture read_normals(const TextLines& lines);

 private:
  std::optional<TextureLevel> decoded(const ObjMap& map) const;
  MaterialTexture texture(const ObjMap& map, bool is_srgb, const TextureLevel& picture);

  const std::string& library_;
  TextureList& textures_;
  const WarningHandler& warn_;
};

}  // namespace catchlight::render
