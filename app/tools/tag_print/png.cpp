#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "app/tools/tag_print/writers.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

constexpr double kMetresPerInch = 0.0254;

/// ISO 3309, as the PNG specification's appendix has it.
std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xEDB88320 ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

std::string phys_chunk(int pixels_per_m) {
  constexpr char kUnitIsMetre = 1;
  const std::string resolution = big_endian(static_cast<std::uint32_t>(pixels_per_m));
  const std::string body = "pHYs" + resolution + resolution + kUnitIsMetre;
  return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(crc32(body));
}

void draw_lines(cv::Mat1b& image, const std::vector<PenLine>& lines, double pixels_per_mm) {
  constexpr int kShift = 4;  // sixteenths of a pixel
  std::vector<std::vector<cv::Point>> points;
  for (const PenLine& line : lines) {
    points.emplace_back();
    for (const glm::dvec2& point : line) {
      const glm::dvec2 px = 16.0 * (point * pixels_per_mm - 0.5);
      points.back().emplace_back(cvRound(px.x), cvRound(px.y));
    }
  }
  const int thickness_px = std::max(1, static_cast<int>(std::lround(kPenMm * pixels_per_mm)));
  cv::polylines(image, points, false, cv::Scalar(0), thickness_px, cv::LINE_AA, kShift);
}

}  // namespace

std::string png_bytes(const Page& page, int pixels_per_m) {
  constexpr double kLongestSidePx = 65535, kMaxPixels = 1 << 30;
  const double pixels_per_mm = pixels_per_m / 1000.0;
  const auto pixels = [&](double mm) { return static_cast<int>(std::lround(mm * pixels_per_mm)); };
  const double width_px = page.width_mm * pixels_per_mm, height_px = page.height_mm * pixels_per_mm;
  if (std::max(width_px, height_px) > kLongestSidePx || width_px * height_px > kMaxPixels)
    throw UsageError("the picture would have " + plain_text(std::round(width_px)) + " x " + plain_text(std::round(height_px)) +
                     " pixels; choose fewer --dpi, a smaller --paper, or PDF or SVG");
  cv::Mat1b image(pixels(page.height_mm), pixels(page.width_mm), std::uint8_t{255});
  for (const ShapeMm& shape : page.shapes)
    for (const RectangleMm& r : shape) {
      const cv::Point from(pixels(r.x), pixels(r.y)), to(pixels(r.x + r.width), pixels(r.y + r.height));
      image(cv::Rect(from.x, from.y, std::max(1, to.x - from.x), std::max(1, to.y - from.y))) = 0;
    }
  draw_lines(image, pen_lines(page), pixels_per_mm);

  const std::vector<std::uint8_t> encoded = render::encode_png(image);
  std::string bytes(encoded.begin(), encoded.end());
  constexpr std::size_t kAfterHeader = 8 + 25;  // signature, IHDR
  return bytes.insert(kAfterHeader, phys_chunk(pixels_per_m));
}

PixelGrid on_pixels(const TagGrid& grid, double dpi) {
  const double cell_m = grid.size_m / tag_reach(grid.family).cells_across;
  PixelGrid result{grid, 0, static_cast<int>(std::lround(cell_m * dpi / kMetresPerInch))};
  if (result.pixels_per_cell < 1)
    throw UsageError("--dpi is " + plain_text(dpi) + ", less than one pixel for a cell of " + metres_text(cell_m) +
                     " m; expected " + plain_text(std::ceil(kMetresPerInch / cell_m)) + " or more");
  result.pixels_per_m = static_cast<int>(std::lround(result.pixels_per_cell / cell_m));
  result.grid.size_m = grid.size_m / cell_m * result.pixels_per_cell / result.pixels_per_m;
  result.grid.spacing_m = std::round(grid.spacing_m * result.pixels_per_m) / result.pixels_per_m;
  return result;
}

}  // namespace catchlight::app
