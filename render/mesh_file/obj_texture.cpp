#include "render/mesh_file/obj_texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "catchlight/util/text.hpp"

namespace catchlight::render {
namespace {

/// Options and how many words follow them at most; those of -s, -o and -t may be fewer.
constexpr std::array<std::pair<std::string_view, std::size_t>, 14> kOptions{{{"-blendu", 1},
                                                                             {"-blendv", 1},
                                                                             {"-boost", 1},
                                                                             {"-mm", 2},
                                                                             {"-o", 3},
                                                                             {"-s", 3},
                                                                             {"-t", 3},
                                                                             {"-texres", 1},
                                                                             {"-clamp", 1},
                                                                             {"-bm", 1},
                                                                             {"-imfchan", 1},
                                                                             {"-type", 1},
                                                                             {"-cc", 1},
                                                                             {"-colorspace", 1}}};

/// A picture of normals points outwards: on the mean it is this blue at least, and half red and green.
constexpr double kMinBlue = 0.7;
constexpr double kMaxTilt = 0.15;

bool takes_numbers(std::string_view option) {
  return option == "-o" || option == "-s" || option == "-t";
}

// Wavefront's v runs up, ours down: v' = s v + o there is 1 - v' = s (1 - v) + o here.
glm::mat3 transform_of(const glm::vec2& scale, const glm::vec2& offset) {
  return {glm::vec3(scale.x, 0, 0), glm::vec3(0, scale.y, 0), glm::vec3(offset.x, 1 - scale.y - offset.y, 1)};
}

/// What kind of picture a bump map is: heights are grey, normals bluish.
bool is_normal_map(const TextureLevel& picture) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    sum += glm::dvec3(picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]);
  const glm::dvec3 mean = sum / (255.0 * static_cast<double>(picture.rgba.size()) / 4);
  return mean.b > kMinBlue && std::abs(mean.r - 0.5) < kMaxTilt && std::abs(mean.g - 0.5) < kMaxTilt;
}

}  // namespace

ObjMap obj_map(const TextLines& lines) {
  const std::vector<std::string_view>& words = lines.words();
  ObjMap map;
  glm::vec2 scale(1), offset(0);
  std::size_t at = 1;
  while (at < words.size()) {
    const auto* const option =
        std::find_if(kOptions.begin(), kOptions.end(), [&](const auto& o) { return o.first == words[at]; });
    if (option == kOptions.end()) break;
    std::size_t count = 0;
    const std::size_t first = ++at;
    while (count < option->second && at + 1 < words.size() &&
           (!takes_numbers(option->first) || real_from_text(words[at]).has_value()))
      ++count, ++at;
    glm::vec2* const pair = option->first == "-s" ? &scale : option->first == "-o" ? &offset : nullptr;
    for (std::size_t i = 0; pair && i < std::min<std::size_t>(count, 2); ++i)
      (*pair)[static_cast<int>(i)] = static_cast<float>(lines.number(first + i));
    if (option->first == "-bm" && count > 0) map.multiplier = static_cast<float>(lines.number(first));
    if (option->first == "-clamp" && count > 0) map.is_clamped = words[first] == "on";
  }
  if (at >= words.size()) lines.refuse("\"" + std::string(words[0]) + "\" names no picture");
  map.file.assign(words[at].data(), words.back().data() + words.back().size());
  map.uv_transform = transform_of(scale, offset);
  return map;
}

std::string path_of_obj_map(const std::string& library, const ObjMap& map) {
  const std::filesystem::path folder = std::filesystem::path(library).parent_path();
  std::string slashed = map.file;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  for (const std::filesystem::path& path :
       {folder / map.file, folder / slashed, folder / std::filesystem::path(slashed).filename()}) {
    if (std::error_code ignored; std::filesystem::is_regular_file(path, ignored)) return path;
  }
  return {};
}

std::optional<TextureLevel> ObjTextureReader::decoded(const ObjMap& map) const {
  const std::string path = path_of_obj_map(library_, map);
  std::string why = "is not there";
  if (!path.empty()) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    try {
      return decode_texture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path, warn_);
    } catch (const Error& error) {
      why = std::string("cannot be decoded: it ") + error.what();
    }
  }
  if (warn_) warn_(library_ + ": its texture \"" + map.file + "\" " + why + "; the surface is drawn without it");
  return std::nullopt;
}

MaterialTexture ObjTextureReader::texture(const ObjMap& map, bool is_srgb, const TextureLevel& picture) {
  MaterialTexture result;
  TextureUse use{is_srgb, {}};
  if (map.is_clamped) use.wrap.fill(TextureWrap::clamp);
  result.texture = textures_.number_of(path_of_obj_map(library_, map), use, [&] { return picture; });
  result.uv_transform = map.uv_transform;
  return result;
}

MaterialTexture ObjTextureReader::read(const TextLines& lines, bool is_srgb) {
  const ObjMap map = obj_map(lines);
  const std::optional<TextureLevel> picture = decoded(map);
  return picture ? texture(map, is_srgb, *picture) : MaterialTexture();
}

MaterialTexture ObjTextureReader::read_normals(const TextLines& lines) {
  const ObjMap map = obj_map(lines);
  const std::optional<TextureLevel> picture = decoded(map);
  if (!picture) return {};
  if (lines.words()[0] != "norm" && !is_normal_map(*picture)) {
    if (warn_) warn_(library_ + ": the bump map \"" + map.file + "\" is one of heights, which are not used; expected normals");
    return {};
  }
  MaterialTexture result = texture(map, false, *picture);
  result.strength = map.multiplier;
  return result;
}

}  // namespace catchlight::render
