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
      return read_hdr_picture(path);
    case FileKind::display:
      throw Error(path + ": a light probe needs high dynamic range; expected OpenEXR or Radiance HDR, found an 8-bit picture");
    case FileKind::unknown:
      break;
  }
  throw Error(path +
              ": is neither OpenEXR nor Radiance HDR, whatever its name says; expected a light probe of one of these kinds");
}

/// The end of a message that asks for the layout, by the options that say it.
std::string name_it() {
  return "name it: " + quoted_list(name_list<ProbeLayout>()) + " (probe.layout of a scene, --layout-in of `catchlight probe`)";
}

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height) + " texels";
}

/// Faces side by side, as many programs write them: a cross that lies (-x +z +x -z, with +y above and -y below +z), or a row of
/// OpenGL's faces. Faces of another shape are none of these.
bool is_lying_cross(const Image& image) {
  return image.width % 4 == 0 && image.width / 4 * 3 == image.height;
}
bool is_row_of_faces(const Image& image) {
  return image.width == 6 * image.height;
}

/// The same faces where ProbeLayout::cube_cross has them.
Image standing_cross(const Image& faces) {
  constexpr std::array<glm::ivec2, 6> kLying{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};
  const bool is_row = is_row_of_faces(faces);
  const int size = is_row ? faces.height : faces.height / 3;
  Image cross(3 * size, 4 * size, faces.channels);
  for (int i = 0; i < 6; ++i) {
    const CubeFace& face = faces_of(ProbeLayout::cube_cross)[i];
    const glm::ivec2 from = is_row ? glm::ivec2(i, 0) : kLying[i];
    const bool is_turned = face.right != gl_cube_faces()[i].right;  // by half a turn: -z, so that the column folds down
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const int source_x = is_turned ? size - 1 - x : x, source_y = is_turned ? size - 1 - y : y;
        std::copy_n(faces.pixel(from.x * size + source_x, from.y * size + source_y), faces.channels,
                    cross.pixel(face.column * size + x, face.row * size + y));
      }
  }
  return cross;
}

/// The picture as its file says that it is seen: a crop is filled up with black, overscan cut off. With an envmap attribute the
/// file's own pixels are the panorama (ImfEnvmap.h).
Image displayed(const std::string& path, ExrPicture&& picture, const WarningHandler& warn) {
  Image& image = picture.image;
  const PixelRect& display = picture.display;
  if (picture.envmap || (display.x == 0 && display.y == 0 && display.width == image.width && display.height == image.height))
    return std::move(image);
  Image whole(display.width, display.height, image.channels);
  int held = 0;
  for (int y = 0; y < display.height; ++y)
    for (int x = 0; x < display.width; ++x) {
      const int from_x = x + display.x, from_y = y + display.y;
      if (from_x < 0 || from_y < 0 || from_x >= image.width || from_y >= image.height) continue;
      std::copy_n(image.pixel(from_x, from_y), image.channels, whole.pixel(x, y));
      ++held;
    }
  if (held < display.width * display.height && warn)
    warn(path + ": holds " + size_text(image) + " of the panorama's " + std::to_string(display.width) + " x " +
         std::to_string(display.height) + "; the rest is black");
  return whole;
}

ProbeLayout layout_by_shape(const std::string& path, const Image& image) {
  if (image.width == 2 * image.height) return ProbeLayout::latlong;
  if (image.width % 3 == 0 && image.width / 3 * 4 == image.height) return ProbeLayout::cube_cross;
  if (is_lying_cross(image) || is_row_of_faces(image)) return ProbeLayout::cube_cross;
  if (image.height == 6 * image.width) return ProbeLayout::cube;
  throw Error(path + ": the layout of " + size_text(image) + " is not clear; " + name_it());
}

ProbeLayout layout_of(const std::string& path, const ExrPicture& picture, const ProbeLoadOptions& options) {
  const Image& image = picture.image;
  // What is square is hardly a panorama: drawn out to twice its width, a ball or an angular map lights from wrong directions.
  if (options.layout == ProbeLayout::latlong && image.width == image.height && !picture.envmap &&
      value_named<ProbeLayout>(picture.probe_layout) != ProbeLayout::latlong)
    throw Error(path + ": " + size_text(image) +
                " are square, as \"angular\", \"angular-inside\" and \"mirror-ball\" are, and a " +
                "latlong is twice as wide as high; " + name_it() + ", or scale the picture to 2:1");
  if (options.layout) return *options.layout;
  if (const auto layout = value_named<ProbeLayout>(picture.probe_layout)) return *layout;
  if (picture.envmap) return *picture.envmap == ExrEnvmap::cube ? ProbeLayout::cube : ProbeLayout::latlong;
  return layout_by_shape(path, image);
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
  if (picture.has_unusable_primaries && warn)
    warn(path + ": its chromaticities span no colours; the values are taken as Rec. 709");
  // A colour beyond Rec. 709 is no damage: it becomes the nearest that there is.
  for (float& value : picture.image.data)
    if (picture.has_other_primaries && std::isfinite(value)) value = std::max(value, 0.0f);
  picture.image = displayed(path, std::move(picture), warn);
  const ProbeLayout layout = layout_of(path, picture, options);
  if (layout == ProbeLayout::cube_cross && (is_lying_cross(picture.image) || is_row_of_faces(picture.image)))
    picture.image = standing_cross(picture.image);
  check_probe_shape(layout, picture.image.width, picture.image.height, path);
  Probe probe{rgb_of(std::move(picture.image)), layout};
  clean_texels(path, probe, options.strict, warn);
  weld_seams(probe);
  return probe;
}

void save_probe(const std::string& path, const Probe& probe, ExrPrecision precision) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension == ".hdr" || extension == ".pic") return write_hdr(path, probe.image, name_of(probe.layout));
  if (extension != ".exr") throw UsageError(path + ": expected a name that ends in .exr or .hdr");
  std::optional<ExrEnvmap> envmap;
  if (probe.layout == ProbeLayout::latlong) envmap = ExrEnvmap::latlong;
  if (probe.layout == ProbeLayout::cube) envmap = ExrEnvmap::cube;
  // Half holds at most 65504: a sun beyond it keeps its power in float.
  const bool beyond_half = std::any_of(probe.image.data.begin(), probe.image.data.end(), [](float v) { return v > 65504.0f; });
  write_exr(path, {{"", &probe.image, {"R", "G", "B"}, precision == ExrPrecision::full || beyond_half}}, envmap,
            {.probe_layout = envmap ? "" : name_of(probe.layout)});
}

}  // namespace catchlight::render
