#include "render/mesh_file/texture_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "render/image/picture_file.hpp"

namespace catchlight::render {

TextureLevel decode_texture(std::span<const std::uint8_t> file, const std::string& name, const WarningHandler& warn) {
  const ClearPicture picture = decode_clear_picture(file, kMaxTextureSide);
  TextureLevel level{picture.bgra.cols, picture.bgra.rows, {}};
  level.rgba.resize(4 * static_cast<std::size_t>(level.width) * level.height);
  cv::Mat rgba(level.height, level.width, CV_8UC4, level.rgba.data());
  cv::cvtColor(picture.bgra, rgba, cv::COLOR_BGRA2RGBA);
  if (warn && std::max(picture.file_size.width, picture.file_size.height) > kMaxTextureSide) {
    const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
    warn(name + ": the texture of " + size(picture.file_size.width, picture.file_size.height) + " is scaled down to " +
         size(level.width, level.height) + " pixels");
  }
  return level;
}

std::shared_ptr<const Texture> read_texture(const std::string& path, const TextureUse& use, const WarningHandler& warn) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path)) throw Error(path + ": is not there; expected a picture");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  try {
    const std::span file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return std::make_shared<Texture>(make_texture(path, decode_texture(file, path, warn), use.is_srgb, use.wrap));
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
}

int TextureList::number_of(const std::string& name, const TextureUse& use, const std::function<TextureLevel()>& decode) {
  const auto [found, is_new] = numbers_.try_emplace({name, use.is_srgb, use.wrap}, static_cast<int>(textures_.size()));
  if (is_new) textures_.push_back(std::make_shared<Texture>(make_texture(name, decode(), use.is_srgb, use.wrap)));
  return found->second;
}

}  // namespace catchlight::render
