#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/image_io.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render {
namespace {

enum class FileKind { exr, hdr, display, unknown };

// The kind of a file by its first bytes, as names lie.
FileKind kind_of(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) throw Error(path + ": is a folder, expected an OpenEXR or Radiance HDR file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened; expected a light probe (OpenEXR or Radiance HDR)");
  std::array<char, 4> magic{};
  in.read(magic.data(), magic.size());
  const std::string start(magic.data(), 4);
  if (start == "\x76\x2f\x31\x01") return FileKind::exr;
  if (start.rfind("#?", 0) == 0) return FileKind::hdr;
  if (start == "\x89PNG" || start.rfind("\xff\xd8", 0) == 0 || start == "RIFF" || start.rfind("BM", 0) == 0)
    return FileKind::display;
  return FileKind::unknown;
}

ExrPicture read_picture(const std::string& path) {
  switch (kind_of(path)) {
    case FileKind::exr:
      return read_exr_picture(path);
    case FileKind::hdr:
      return {read_hdr(path), {}};
    case FileKind::display:
      throw Error(path + ": a light probe needs high dynamic range; expected OpenEXR or Radiance HDR, found an 8-bit picture");
    case FileKind::unknown:
      break;
  }
  throw Error(path +
              ": is neither OpenEXR nor Radiance HDR, whatever its name says; expected a light probe of one of these kinds");
}

ProbeLayout layout_by_shape(const std::string& path, const Image& image) {
  if (image.width == 2 * image.height) return ProbeLayout::latlong;
  if (image.width % 3 == 0 && image.width / 3 * 4 == image.height) return ProbeLayout::cube_cross;
  if (image.height == 6 * image.width) return ProbeLayout::cube;
  throw Error(path + ": the layout of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
              " texels is not clear; name it (latlong, angular, mirror-ball, cube-cross or cube)");
}

ProbeLayout layout_of(const std::string& path, const ExrPicture& picture, const ProbeLoadOptions& options) {
  if (options.layout) return *options.layout;
  if (picture.envmap) return *picture.envmap == ExrEnvmap::cube ? ProbeLayout::cube : ProbeLayout::latlong;
  return layout_by_shape(path, picture.image);
}

// Radiance cannot be negative, infinite or undefined. Outside the layout's area anything may stand: it holds no light.
void clean_texels(const std::string& path, Probe& probe, bool strict, const WarningHandler& warn) {
  std::size_t bad = 0, lit = 0;
  std::string first;
  const bool has_outside = is_disc(probe.layout) || probe.layout == ProbeLayout::cube_cross;
  for (int y = 0; y < probe.image.height; ++y) {
    for (int x = 0; x < probe.image.width; ++x) {
      float* value = probe.image.pixel(x, y);
      const bool ok = std::all_of(value, value + 3, [](float v) { return std::isfinite(v) && v >= 0; });
      if (has_outside && !direction_from_texel(probe.layout, probe.image.width, probe.image.height, x, y)) {
        std::fill(value, value + 3, 0.0f);
      } else if (!ok) {
        if (bad++ == 0) first = std::to_string(x) + ", " + std::to_string(y);
        for (int c = 0; c < 3; ++c) value[c] = std::isfinite(value[c]) ? std::max(value[c], 0.0f) : 0.0f;
      }
      lit += std::any_of(value, value + 3, [](float v) { return v > 0; });
    }
  }
  const std::string found = counted(bad, "texel is", "texels are") + " negative, infinite or NaN, the first at (" + first + ")";
  if (bad > 0 && strict) throw Error(path + ": " + found + "; repair the probe or leave out the strict option");
  if (bad > 0 && warn) warn(path + ": " + found + "; those values are taken as 0");
  if (lit == 0 && warn) warn(path + ": the probe is black; nothing will be lit");
}

Image rgb_of(Image image) {
  if (image.channels == 3) return image;
  Image rgb(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::copy_n(image.pixel(x, y), 3, rgb.pixel(x, y));
  }
  return rgb;
}

}  // namespace

Probe load_probe(const std::string& path, const ProbeLoadOptions& options, const WarningHandler& warn) {
  ExrPicture picture = read_picture(path);
  const ProbeLayout layout = layout_of(path, picture, options);
  check_probe_shape(layout, picture.image.width, picture.image.height, path);
  Probe probe{rgb_of(std::move(picture.image)), layout};
  clean_texels(path, probe, options.strict, warn);
  weld_seams(probe);
  return probe;
}

void save_probe(const std::string& path, const Probe& probe, ExrPrecision precision) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension == ".hdr" || extension == ".pic") return write_hdr(path, probe.image);
  if (extension != ".exr") throw UsageError(path + ": expected a name that ends in .exr or .hdr");
  std::optional<ExrEnvmap> envmap;
  if (probe.layout == ProbeLayout::latlong) envmap = ExrEnvmap::latlong;
  if (probe.layout == ProbeLayout::cube) envmap = ExrEnvmap::cube;
  // Half holds at most 65504: a sun beyond it keeps its power in float.
  const bool beyond_half = std::any_of(probe.image.data.begin(), probe.image.data.end(), [](float v) { return v > 65504.0f; });
  write_exr(path, {{"", &probe.image, {"R", "G", "B"}, precision == ExrPrecision::full || beyond_half}}, envmap);
}

}  // namespace catchlight::render
