#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <string_view>
#include <system_error>
#include <thread>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/pending_file.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::render {
namespace {

constexpr float kHalfMax = 65504.0f;
constexpr std::int64_t kMaxTexels = std::int64_t{1} << 29;

/// The colour of these chromaticities with X + Y + Z = 1; y may be 0, as it is for the primaries of XYZ itself.
glm::dvec3 xyz_from_xy(const Imath::V2f& xy) {
  return {xy.x, xy.y, 1.0 - xy.x - xy.y};
}

glm::dvec3 white_xyz(const Imf::Chromaticities& primaries) {
  return xyz_from_xy(primaries.white) / static_cast<double>(primaries.white.y);
}

/// Not where all primaries lie on a line, or white is none.
bool are_usable(const Imf::Chromaticities& primaries) {
  const glm::dmat3 columns(xyz_from_xy(primaries.red), xyz_from_xy(primaries.green), xyz_from_xy(primaries.blue));
  return std::abs(glm::determinant(columns)) > 1e-6 && primaries.white.y > 1e-6f;
}

glm::dmat3 xyz_from_rgb(const Imf::Chromaticities& primaries) {
  const glm::dmat3 columns(xyz_from_xy(primaries.red), xyz_from_xy(primaries.green), xyz_from_xy(primaries.blue));
  const glm::dvec3 scale = glm::inverse(columns) * white_xyz(primaries);
  return {columns[0] * scale.x, columns[1] * scale.y, columns[2] * scale.z};
}

// Bradford's cone responses (Lam 1985): white of one goes to white of the other.
glm::dmat3 adapted_white(const glm::dvec3& to_xyz, const glm::dvec3& from_xyz) {
  const glm::dmat3 cone = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 gain = (cone * to_xyz) / (cone * from_xyz);
  const glm::dmat3 diagonal(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z);
  return glm::inverse(cone) * diagonal * cone;
}

/// Whether there was anything to convert.
bool convert_to_rec709(Image& image, const Imf::Chromaticities& from) {
  const Imf::Chromaticities rec709;  // the library's default
  const auto same = [](const Imath::V2f& a, const Imath::V2f& b) { return (a - b).length() < 1e-4f; };
  if (same(from.red, rec709.red) && same(from.green, rec709.green) && same(from.blue, rec709.blue) &&
      same(from.white, rec709.white)) {
    return false;
  }
  const glm::dmat3 matrix =
      glm::inverse(xyz_from_rgb(rec709)) * adapted_white(white_xyz(rec709), white_xyz(from)) * xyz_from_rgb(from);
  for (std::size_t i = 0; i < image.data.size(); i += image.channels) {
    const glm::dvec3 rgb = matrix * glm::dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
    for (int c = 0; c < 3; ++c) image.data[i + c] = static_cast<float>(rgb[c]);
  }
  return true;
}

/// Inflating a large picture takes most of the time of reading it; for a small one, starting threads would.
void use_all_cores_for_large(const std::string& path) {
  constexpr std::uintmax_t kLarge = std::uintmax_t{4} << 20;
  std::error_code missing;
  const std::uintmax_t bytes = std::filesystem::file_size(path, missing);
  if (!missing && bytes > kLarge) Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
}

std::vector<std::string> channels_to_read(const std::string& path, const Imf::ChannelList& list) {
  std::vector<std::string> names;
  if (list.findChannel("R") && list.findChannel("G") && list.findChannel("B")) {
    names = {"R", "G", "B"};
    if (list.findChannel("A")) names.emplace_back("A");
  } else if (list.findChannel("Y") && !list.findChannel("RY")) {
    names = {"Y"};
  } else {
    std::string found;
    for (auto it = list.begin(); it != list.end(); ++it) found += (found.empty() ? "" : ", ") + std::string(it.name());
    throw Error(path + ": expected channels R, G, B or Y alone, found " + (found.empty() ? "none" : found));
  }
  for (const std::string& name : names) {
    if (list[name.c_str()].xSampling != 1 || list[name.c_str()].ySampling != 1) {
      throw Error(path + ": channel " + name + " is subsampled; save it at full resolution");
    }
  }
  return names;
}

struct Size {
  int width, height;
};

Size size_of(const std::string& path, const Imath::Box2i& window) {
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > kMaxTexels || height > kMaxTexels / width)
    throw Error(path + ": " + std::to_string(width) + " x " + std::to_string(height) + " pixels are out of range");
  return {static_cast<int>(width), static_cast<int>(height)};
}

ExrPicture read(const std::string& path) {
  use_all_cores_for_large(path);
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const auto [width, height] = size_of(path, window);
  const std::vector<std::string> names = channels_to_read(path, header.channels());
  const int channels = std::max<int>(3, static_cast<int>(names.size()));
  ExrPicture picture;
  picture.image = Image(width, height, channels);
  const std::size_t pixel_bytes = sizeof(float) * channels, row_bytes = pixel_bytes * width;
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < names.size(); ++c) {
    char* first = reinterpret_cast<char*>(picture.image.data.data() + c);
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first, window, pixel_bytes, row_bytes));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (names.size() == 1) {
    for (std::size_t i = 0; i < picture.image.data.size(); i += 3)
      picture.image.data[i + 1] = picture.image.data[i + 2] = picture.image.data[i];
  } else if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities& primaries = Imf::chromaticities(header);
    picture.has_unusable_primaries = !are_usable(primaries);
    picture.has_other_primaries = !picture.has_unusable_primaries && convert_to_rec709(picture.image, primaries);
  }
  const Imath::Box2i display = header.displayWindow();
  const Size whole = size_of(path, display);
  picture.display = {display.min.x - window.min.x, display.min.y - window.min.y, whole.width, whole.height};
  if (Imf::hasEnvmap(header)) picture.envmap = Imf::envmap(header) == Imf::ENVMAP_CUBE ? ExrEnvmap::cube : ExrEnvmap::latlong;
  if (const auto* layout = header.findTypedAttribute<Imf::StringAttribute>(kProbeLayout)) picture.probe_layout = layout->value();
  return picture;
}

// The planes that one layer contributes: OpenEXR reads them as the file is written, so they live until then.
struct Plane {
  std::string channel;
  std::vector<half> halves;  ///< empty: floats straight from the image
  const float* first;
  int channels;
};

std::vector<Plane> planes_of(const std::vector<ExrLayer>& layers) {
  std::vector<Plane> planes;
  for (const ExrLayer& layer : layers) {
    const Image& image = *layer.image;
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
      Plane plane{layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c],
                  {},
                  image.data.data() + c,
                  image.channels};
      if (!layer.as_float) {
        plane.halves.reserve(image.data.size() / image.channels);
        for (std::size_t i = c; i < image.data.size(); i += image.channels) {
          plane.halves.emplace_back(std::clamp(image.data[i], -kHalfMax, kHalfMax));
        }
      }
      planes.push_back(std::move(plane));
    }
  }
  return planes;
}

Imath::M44f row_vector_matrix(const glm::dmat4& matrix) {
  Imath::M44f transposed;  // OpenEXR multiplies rows by matrices
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) transposed[column][row] = static_cast<float>(matrix[column][row]);
  return transposed;
}

void add_attributes(const ExrAttributes& attributes, Imf::Header& header) {
  if (!attributes.software.empty()) header.insert("software", Imf::StringAttribute(attributes.software));
  if (!attributes.probe_layout.empty()) header.insert(kProbeLayout, Imf::StringAttribute(attributes.probe_layout));
  if (attributes.frames_per_second > 0) Imf::addFramesPerSecond(header, Imf::guessExactFps(attributes.frames_per_second));
  int hours, minutes, seconds, frame;
  char before_frame;
  if (std::sscanf(attributes.time_code.c_str(), "%d:%d:%d%c%d", &hours, &minutes, &seconds, &before_frame, &frame) == 5)
    Imf::addTimeCode(header, Imf::TimeCode(hours, minutes, seconds, frame, before_frame == ';'));
  if (attributes.camera_from_world) Imf::addWorldToCamera(header, row_vector_matrix(*attributes.camera_from_world));
  if (attributes.clip_from_world) Imf::addWorldToNDC(header, row_vector_matrix(*attributes.clip_from_world));
}

void write(const std::string& path, const std::vector<ExrLayer>& layers, std::optional<ExrEnvmap> envmap,
           const ExrAttributes& attributes) {
  const int width = layers.front().image->width, height = layers.front().image->height;
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());
  if (envmap) Imf::addEnvmap(header, *envmap == ExrEnvmap::cube ? Imf::ENVMAP_CUBE : Imf::ENVMAP_LATLONG);
  add_attributes(attributes, header);
  const std::vector<Plane> planes = planes_of(layers);
  Imf::FrameBuffer frame;
  for (const Plane& plane : planes) {
    const bool is_half = !plane.halves.empty();
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    const std::size_t step = is_half ? sizeof(half) : sizeof(float) * plane.channels;
    // OpenEXR's slices are for reading and writing alike, hence not const.
    char* first = const_cast<char*>(is_half ? reinterpret_cast<const char*>(plane.halves.data())
                                            : reinterpret_cast<const char*>(plane.first));
    header.channels().insert(plane.channel, Imf::Channel(type));
    frame.insert(plane.channel, Imf::Slice(type, first, step, step * width));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(height);
}

}  // namespace

ExrPicture read_exr_picture(const std::string& path) {
  try {
    return read(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    if (!std::filesystem::is_regular_file(path)) throw Error(path + ": no such file");
    const bool is_cut_short = std::string_view(error.what()).find("end of file") != std::string_view::npos;
    throw Error(path + (is_cut_short
                            ? ": is cut short; write or copy it again"
                            : ": is damaged, or an OpenEXR file of a kind that is not read; write it again as scan lines of "
                              "half or float"));
  }
}

Image read_exr(const std::string& path) {
  return read_exr_picture(path).image;
}

void write_exr(const std::string& path, const std::vector<ExrLayer>& layers, std::optional<ExrEnvmap> envmap,
               const ExrAttributes& attributes) {
  if (layers.empty()) throw std::invalid_argument("write_exr: no layers for " + path);
  for (const ExrLayer& layer : layers) {
    const Image& image = *layer.image;
    if (image.width != layers.front().image->width || image.height != layers.front().image->height ||
        static_cast<int>(layer.channels.size()) > image.channels) {
      throw std::invalid_argument("write_exr: layer \"" + layer.name + "\" of " + path + " has another size or too few channels");
    }
  }
  PendingFile file(path);
  try {
    write(file.pending_path(), layers, envmap, attributes);
  } catch (const std::exception& error) {
    throw Error(path + ": cannot be written: " + error.what());
  }
  file.commit();
}

}  // namespace catchlight::render
