#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/core.hpp>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/text.hpp"
#include "render/glare/aperture_picture.hpp"
#include "render/glare/aperture_psf.hpp"
#include "render/image/image_io.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

struct Options {
  std::string aperture, output;
  render::ApertureOptics optics{.aperture_mm = 2, .focal_px = 1000};
  int reach_px = 250;
  double decades = 6;
  bool overwrite = false;
};

/// BGR: each colour at the logarithm of its brightest channel, `decades` below the brightest glare to black.
cv::Mat logarithmic(const Image& psf, double decades) {
  const Image glare = render::glare_of(psf);
  const float top = std::max(*std::max_element(glare.data.begin(), glare.data.end()), 1e-30f);
  cv::Mat result(psf.height, psf.width, CV_8UC3, cv::Scalar::all(0));
  for (int y = 0; y < psf.height; ++y)
    for (int x = 0; x < psf.width; ++x) {
      const float* rgb = psf.pixel(x, y);
      const float peak = std::max({rgb[0], rgb[1], rgb[2]});
      if (!(peak > 0)) continue;
      const double level = std::clamp(1 + std::log10(peak / top) / decades, 0.0, 1.0);
      for (int c = 0; c < 3; ++c) result.at<cv::Vec3b>(y, x)[2 - c] = cv::saturate_cast<uchar>(255 * level * rgb[c] / peak);
    }
  return result;
}

/// The aperture, and right of it what it makes of a point of light.
cv::Mat side_by_side(const Image& aperture, const cv::Mat& psf) {
  cv::Mat result(psf.rows, 2 * psf.cols, CV_8UC3);
  for (int y = 0; y < aperture.height; ++y)
    for (int x = 0; x < aperture.width; ++x)
      result.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(255 * *aperture.pixel(x, y)));
  psf.copyTo(result.colRange(psf.cols, 2 * psf.cols));
  return result;
}

void write_picture(const Options& options, const render::AperturePicture& picture, const Image& psf) {
  // A small file is enlarged by whole pixels.
  Image aperture(psf.width, psf.height, 1);
  const Image drawn = picture.draw(std::min(psf.width, picture.most_px));
  for (int y = 0; y < aperture.height; ++y)
    for (int x = 0; x < aperture.width; ++x)
      *aperture.pixel(x, y) = *drawn.pixel(x * drawn.width / aperture.width, y * drawn.height / aperture.height);
  const std::vector<std::uint8_t> png = render::encode_png(side_by_side(aperture, logarithmic(psf, options.decades)));
  write_text_file(options.output, {reinterpret_cast<const char*>(png.data()), png.size()}, options.overwrite);
}

void show(const Options& options, Log& log) {
  const bool is_exr = options.output.ends_with(".exr");
  if (!is_exr && !options.output.ends_with(".png"))
    throw UsageError(options.output + ": expected a name that ends in .png (to look at) or .exr (the values)");
  check_output_path(options.output, options.overwrite);
  refuse_same_file(options.output, options.aperture);
  const render::AperturePicture picture = render::aperture_picture(options.aperture);
  const render::AperturePlan plan = render::plan_aperture(options.optics, options.reach_px, picture.most_px);
  const render::ApertureFarField field(picture.draw(plan.picture_px), plan.transform_px);
  const Image psf = render::aperture_psf(field, options.optics, plan.reach_px);
  if (is_exr)
    render::write_exr(options.output, {{"", &psf, {"R", "G", "B"}, true}});
  else
    write_picture(options, picture, psf);
  const float* core = psf.pixel(plan.reach_px, plan.reach_px);
  std::string shares;
  for (int c = 0; c < 3; ++c) shares += (c ? ", " : "") + fixed_text(100 * (1 - core[c]), 2) + " %";
  log.info(options.output + ": out to " + std::to_string(plan.reach_px) +
           " px; red, green and blue light that leaves its pixel: " + shares);
}

}  // namespace

void set_up_glare(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  command.footer("The PNG shows the aperture and its glare on a logarithmic scale; docs/glare-aperture.md explains both.");
  command.add_option("--aperture", options->aperture, "blades:N, eyelashes, dust, circle, or the file of a square picture")
      ->required();
  command.add_option("-o,--output", options->output, "picture.png, or values.exr (linear, all adds up to 1)")
      ->type_name("FILE")
      ->required();
  command.add_option("--aperture-mm", options->optics.aperture_mm, "as glare.aperture_mm")
      ->check(CLI::Range(0.05, 100.0))
      ->capture_default_str();
  command.add_option("--focal", options->optics.focal_px, "focal length of the camera in pixels: fx of its camera file")
      ->check(CLI::Range(1.0, 1e5))
      ->capture_default_str();
  command.add_option("--reach", options->reach_px, "how far around the light, in pixels")
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  command.add_option("--decades", options->decades, "powers of ten from black to white in the PNG")
      ->check(CLI::Range(0.1, 12.0))
      ->capture_default_str();
  command.add_flag("-y,--overwrite", options->overwrite, "replace an existing output");
  show_examples(command, {"catchlight glare --aperture blades:6 -o star.png",
                          "catchlight glare --aperture lashes.png --aperture-mm 1.5 --focal 1400 -o lashes.exr"});
  command.callback([options, &context] { show(*options, context.log); });
}

}  // namespace catchlight::app
