#include "render/cpu/glare/grid_glare.hpp"

#include <algorithm>
#include <array>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

Image image_of(const GlarePicture& picture) {
  Image image(picture.columns(), picture.rows(), 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = picture.lit(y).begin; x < picture.lit(y).end; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = picture.row(y)[x][c];
  return image;
}

std::vector<SplineSamples> samples_along(int pixels, double texel_px) {
  std::vector<SplineSamples> samples;
  for (int i = 0; i < pixels; ++i) samples.push_back(spline_at((i + 0.5) / texel_px + GLARE_MARGIN));
  return samples;
}

}  // namespace

void GridGlare::resize(int frame_width, int frame_height) {
  frame_width_ = frame_width, frame_height_ = frame_height;
  grid_ = make_glare_grid(frame_width, frame_height, grid_rows_);
  excess_.resize(grid_);
  spreader_.resize(grid_, frame_height);
  columns_ = samples_along(frame_width, grid_.texel_px);
  rows_ = samples_along(frame_height, grid_.texel_px);
}

bool GridGlare::extract(const Image& object, const Image* emission, const PixelRect& rect, int frame_width, int frame_height) {
  if (frame_width != frame_width_ || frame_height != frame_height_) resize(frame_width, frame_height);
  return excess_.find(object, emission, rect);
}

PixelRect GridGlare::spread(const CameraModel&) {
  return intersect(grid_.pixels(spreader_.spread(excess_)), {0, 0, frame_width_, frame_height_});
}

void GridGlare::read_row(int x, int y, int count, float* rgb) const {
  // A few pixels at a time, so that their texels, no more than pixels but for the spline's, need no memory of their own.
  constexpr int kPixels = 60, kTexels = kPixels + 4;
  const SplineSamples& down = rows_[static_cast<std::size_t>(y)];
  for (int n = 0; count > 0; x += n, count -= n) {
    n = std::min(count, kPixels);
    const SplineSamples* across = &columns_[static_cast<std::size_t>(x)];
    const int first = across[0].first;
    std::array<Float4, kTexels> line{};
    for (int k = 0; k < 4; ++k) {
      const Span texels = intersect(spreader_.glare().lit(down.first + k), {first, across[n - 1].first + 4});
      const Float4* row = texels.empty() ? nullptr : spreader_.glare().row(down.first + k);
      const float weight = down.weights[static_cast<std::size_t>(k)];
      for (int t = texels.begin; t < texels.end; ++t) line[static_cast<std::size_t>(t - first)] += weight * row[t];
    }
    for (int i = 0; i < n; ++i, rgb += 3) {
      const Float4* four = &line[static_cast<std::size_t>(across[i].first - first)];
      const std::array<float, 4>& w = across[i].weights;
      // Catmull and Rom's cubic under the streaks may undershoot by a little.
      const Float4 light = positive(w[0] * four[0] + w[1] * four[1] + w[2] * four[2] + w[3] * four[3]);
      for (int c = 0; c < 3; ++c) rgb[c] = light[c];
    }
  }
}

Image GridGlare::read_excess() const {
  return image_of(excess_.all());
}

Image GridGlare::read_glare() const {
  return image_of(spreader_.glare());
}

}  // namespace catchlight::render
