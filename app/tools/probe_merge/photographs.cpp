#include "app/tools/probe_merge/photographs.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/exif.hpp"
#include "render/image/image_io.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

std::ifstream opened(const std::string& path) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, ignored))
    throw Error(path + ": cannot be opened; expected a photograph of a mirror ball");
  return in;
}

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream in = opened(path);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  if (bytes.empty()) throw Error(path + ": is empty; expected a photograph of a mirror ball");
  return bytes;
}

bool starts_with(const std::vector<std::uint8_t>& bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::equal(text.begin(), text.end(), bytes.begin(),
                                                   [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

bool is_exr(const std::vector<std::uint8_t>& bytes) {
  return starts_with(bytes, "\x76\x2f\x31\x01");
}

bool is_linear(const std::vector<std::uint8_t>& bytes) {
  return is_exr(bytes) || starts_with(bytes, "#?");
}

cv::Mat decoded(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kExpected = "; expected JPEG, PNG or TIFF with 8 or 16 bits, OpenEXR or Radiance HDR";
  cv::Mat codes;
  try {
    codes = render::decode_picture(bytes, render::PictureDepth::stored);
  } catch (const Error& error) {
    throw Error(path + ": cannot be read: it " + error.what() + kExpected);
  }
  if (codes.depth() == CV_32F) throw Error(path + ": cannot be read: it has floats" + kExpected);
  return codes;
}

std::string size_text(const cv::Mat& codes) {
  return std::to_string(codes.cols) + " x " + std::to_string(codes.rows) + " with " + (codes.depth() == CV_8U ? "8" : "16") +
         " bits";
}

void check_alike(const Bracket& bracket) {
  const Photograph& first = bracket.front();
  for (const Photograph& other : bracket)
    if (other.codes.size() != first.codes.size() || other.codes.depth() != first.codes.depth())
      throw Error(other.path + ": is " + size_text(other.codes) + ", but " + first.path + " is " + size_text(first.codes) +
                  "; a bracket is taken with one camera that does not move");
  for (std::size_t i = 1; i < bracket.size(); ++i)
    if (bracket[i].exposure_s > 0.99 * bracket[i - 1].exposure_s)
      throw Error(bracket[i].path + ": has the same exposure as " + bracket[i - 1].path +
                  "; change only the exposure time between the photographs, or give the times with --times");
}

double exposure_stated(const std::string& path, const std::vector<std::uint8_t>& bytes, bool is_single) {
  const std::optional<double> stated = render::exposure_of(render::exif_tags(bytes));
  if (!stated && !is_single)
    throw Error(path +
                ": its file does not say how long it was exposed (no EXIF); give the times in seconds with --times, such as "
                "--times 1/1000,1/60,1/4");
  return stated.value_or(1);
}

}  // namespace

void check_photographs(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) opened(path);
}

ViewPictures read_view(const std::vector<std::string>& paths, const std::vector<double>& times_s) {
  Bracket bracket;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::vector<std::uint8_t> bytes = bytes_of(paths[i]);
    if (is_linear(bytes)) {
      if (paths.size() > 1)
        throw Error(paths[i] +
                    ": is scene-linear already and stands for a whole view; give it alone, and other views with --view");
      return is_exr(bytes) ? render::read_exr(paths[i]) : render::read_hdr(paths[i]);
    }
    const double exposure_s = times_s.empty() ? exposure_stated(paths[i], bytes, paths.size() == 1) : times_s[i];
    bracket.push_back({paths[i], decoded(paths[i], bytes), exposure_s});
  }
  std::sort(bracket.begin(), bracket.end(), [](const auto& a, const auto& b) { return a.exposure_s > b.exposure_s; });
  check_alike(bracket);
  return bracket;
}

std::vector<double> exposure_times_from_text(const std::string& text) {
  std::vector<double> times_s;
  for (const std::string& field : split(text, ',')) {
    const std::vector<std::string> parts = split(field, '/');
    const auto over = real_from_text(parts.front()), under = real_from_text(parts.size() == 2 ? parts.back() : "1");
    const double time_s = over && under && parts.size() <= 2 ? *over / *under : -1;
    if (!(time_s > 0) || !std::isfinite(time_s))
      throw UsageError("--times has \"" + field + "\"; expected seconds above 0 such as 1/60 or 0.5, with commas between them");
    times_s.push_back(time_s);
  }
  return times_s;
}

}  // namespace catchlight::app
