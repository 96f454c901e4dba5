// The photographs that a probe is merged from.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "catchlight/image.hpp"

namespace catchlight::app {

struct Photograph {
  std::string path;
  cv::Mat codes;          ///< CV_8UC3 or CV_16UC3, blue first, upright as viewers show it
  double exposure_s = 1;  ///< light per unit of radiance, up to a factor common to all

  int max_code() const { return codes.depth() == CV_8U ? 255 : 65535; }
};

/// Pictures of one size and depth with falling exposure; at least one, no two of one exposure.
using Bracket = std::vector<Photograph>;

/// One camera position: a bracket, or a picture that is scene-linear already.
using ViewPictures = std::variant<Bracket, Image>;

/// Throws Error naming a file that cannot be opened.
void check_photographs(const std::vector<std::string>& paths);

/// `times_s`: one for each of `paths`, or empty: as the files' EXIF says; a single photograph needs none. JPEG, PNG or TIFF with
/// 8 or 16 bits; or one OpenEXR or Radiance HDR. Throws Error naming the file: not such a picture, of another size or depth than
/// the first, without an exposure, with that of another.
ViewPictures read_view(const std::vector<std::string>& paths, const std::vector<double>& times_s);

/// "1/1000,1/60,0.5,2": seconds. Throws UsageError.
std::vector<double> exposure_times_from_text(const std::string& text);

}  // namespace catchlight::app
