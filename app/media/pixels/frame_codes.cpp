#include "app/media/pixels/color_tags.hpp"
#include "app/media/pixels/frame.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/code_view.hpp"
#include "catchlight/color.hpp"

extern "C" {
#include <libavutil/frame.h>
}

namespace catchlight::app {
namespace {

SampleView sample_view(const AVFrame& picture, const PixelLayout& layout, int index) {
  const Component& component = layout.components[static_cast<std::size_t>(index)];
  SampleView view;
  view.data = picture.data[component.plane] + component.offset_bytes;
  view.stride_bytes = picture.linesize[component.plane];
  view.step_bytes = component.step_bytes;
  view.shift = component.shift;
  view.mask = (1u << std::min(component.depth, 16)) - 1u;
  using enum SampleView::Kind;
  const bool is_wide = component.depth + component.shift > 8;
  view.kind = layout.is_float ? real : !is_wide ? byte : layout.big_endian ? big_endian : little_endian;
  return view;
}

/// Samples = samples_from_rgb * RGB + zeros. Of grey, each of the three is the luma that is there.
struct Coding {
  glm::dmat3 samples_from_rgb;
  glm::dvec3 zeros;
};

Coding coding_of(const AVFrame& picture, const PixelLayout& layout) {
  const CodeFromRgb code_from_rgb(picture, layout);
  Coding coding{{}, code_from_rgb(glm::dvec3(0))};
  for (int i = 0; i < 3; ++i) {
    glm::dvec3 unit(0);
    unit[i] = 1;
    coding.samples_from_rgb[i] = code_from_rgb(unit) - coding.zeros;
  }
  if (layout.model != ColorModel::gray) return coding;
  const double white = (code_from_rgb(glm::dvec3(1)) - coding.zeros).x;
  return {glm::dmat3(white), glm::dvec3(coding.zeros.x)};
}

/// Codes are rounded to whole ones evenly.
glm::dmat3 rounding_of(const glm::dmat3& rgb_from_samples, ColorModel model) {
  constexpr double kVariance = 1.0 / 12;
  if (model != ColorModel::gray) return rgb_from_samples * glm::transpose(rgb_from_samples) * kVariance;
  const glm::dvec3 step(rgb_from_samples[0][0]);
  return glm::outerProduct(step, step) * kVariance;
}

}  // namespace

CodeView Frame::codes() const {
  const PixelLayout layout = pixel_layout(picture_->format).value();
  const Coding coding = coding_of(*picture_, layout);
  const glm::dmat3 rgb_from_samples = glm::inverse(coding.samples_from_rgb);
  CodeView view;
  view.width_px = picture_->width;
  view.height_px = picture_->height;
  for (int i = 0; i < 3; ++i)
    view.samples[static_cast<std::size_t>(i)] = sample_view(*picture_, layout, layout.model == ColorModel::gray ? 0 : i);
  view.block_shift = {layout.chroma_shift_x, layout.chroma_shift_y};
  view.rgb_from_samples = rgb_from_samples;
  view.rgb_of_zeros = -(rgb_from_samples * coding.zeros);
  const double white = (coding.samples_from_rgb * glm::dvec3(1)).x;
  view.luma_weights = layout.model == ColorModel::rgb ? glm::vec3(kLuminanceWeights / white) : glm::vec3(1 / white, 0, 0);
  view.luma_of_zeros = layout.model == ColorModel::rgb ? 0 : static_cast<float>(-coding.zeros.x / white);
  view.is_real = layout.is_float;
  if (!layout.is_float) view.rounding = rounding_of(rgb_from_samples, layout.model);
  return view;
}

}  // namespace catchlight::app
