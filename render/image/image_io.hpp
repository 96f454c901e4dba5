// Float images on disk: OpenEXR (also with layers) and Radiance RGBE.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

enum class ExrEnvmap { latlong, cube };  ///< OpenEXR's standard attribute "envmap"

struct ExrPicture {
  Image image;  ///< 3 channels (R G B, or Y three times), 4 where the file has A
  std::optional<ExrEnvmap> envmap;
  PixelRect display =
      {};  ///< the picture as a whole, in pixels of `image`: more than that where the file is a crop, less for overscan
  bool has_other_primaries = false;     ///< than Rec. 709, to which it was converted: colours beyond those are negative
  bool has_unusable_primaries = false;  ///< chromaticities that span no colours: the values are taken as Rec. 709
  std::string probe_layout;             ///< as write_exr or write_hdr wrote it; empty where the file does not say
};

/// Reads the data window of the first part, colours converted to Rec. 709 where the file names other primaries (white point
/// adapted by Bradford's method). Throws Error naming the file: unreadable, damaged, no R G B or Y, subsampled, over 2^29 texels.
ExrPicture read_exr_picture(const std::string& path);

/// Reads the image alone.
Image read_exr(const std::string& path);

/// One group of channels: channel k of `image` is written as `channels[k]`, or `name.channels[k]` where `name` is not empty.
struct ExrLayer {
  std::string name;
  const Image* image = nullptr;
  std::vector<std::string> channels;
  bool as_float = false;  ///< 32 bits (depth, positions); else half, with values beyond +-65504 held there
};

/// The name under which files keep how a light probe's directions lie in them, where OpenEXR's envmap has no word for it.
inline constexpr const char* kProbeLayout = "catchlightProbeLayout";

/// OpenEXR's standard attributes of a frame of a shot, and the program's own. What is empty, or 0, is not written.
struct ExrAttributes {
  std::string software = {};
  double frames_per_second = 0;
  std::string time_code = {};                        ///< HH:MM:SS:FF, or with a ; before FF for drop frame
  std::optional<glm::dmat4> camera_from_world = {};  ///< "worldToCamera": the camera's y up, looking along its -z
  std::optional<glm::dmat4> clip_from_world = {};    ///< "worldToNDC": -1 to 1 across the picture, y up
  std::string probe_layout = {};                     ///< kProbeLayout
};

/// Writes layers, all of one size. The file is a PendingFile until it is whole; ZIP; attribute chromaticities = Rec. 709.
/// Throws Error naming the file where it cannot be written.
void write_exr(const std::string& path, const std::vector<ExrLayer>& layers, std::optional<ExrEnvmap> envmap = {},
               const ExrAttributes& attributes = {});

/// Reads Radiance .hdr (RGBE), any of the eight orientations, with its EXPOSURE lines divided out. Throws Error naming the file.
ExrPicture read_hdr_picture(const std::string& path);

/// Reads the image alone.
Image read_hdr(const std::string& path);

/// Writes Radiance .hdr: relative error up to 1/256 of the brightest channel; negative values become 0. The file is a PendingFile
/// until it is whole. Throws Error.
void write_hdr(const std::string& path, const Image& image, const std::string& probe_layout = {});

}  // namespace catchlight::render
