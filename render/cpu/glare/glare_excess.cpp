#include "render/cpu/glare/glare_excess.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr float kBrightestPixel = 1e9f;
constexpr float kBinomial[2 * kGateReach + 1] = {0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f};

double bspline_weight(double d) {
  const double x = std::abs(d), y = std::max(2 - x, 0.0);
  return x < 1 ? (4 - 6 * x * x + 3 * x * x * x) / 6 : y * y * y / 6;
}

/// The part of a highlight's light that its gate lets through: shaders/glare_bright.frag says why.
float gate(float highest, float mean, float threshold, float brightest) {
  const float t = std::clamp((highest - threshold) / (0.5f * threshold), 0.0f, 1.0f);
  return t * t * (3 - 2 * t) / (1 + mean / brightest);
}

float used_threshold(const GlareSettings& settings) {
  return std::max(static_cast<float>(settings.threshold), 1e-6f);
}

}  // namespace

GlareExcess::AxisFilter::AxisFilter(int texels, double texel_px) : taps(static_cast<int>(std::floor(4 * texel_px)) + 1) {
  for (int texel = 0; texel < texels; ++texel) {
    const double middle = texel - GLARE_MARGIN + 0.5;
    first.push_back(static_cast<int>(std::ceil((middle - kFilterReach) * texel_px - 0.5)));
    for (int t = 0; t < taps; ++t)
      weights.push_back(static_cast<float>(bspline_weight((first.back() + t + 0.5) / texel_px - middle) / texel_px));
  }
}

void GlareExcess::resize(const GlareGrid& grid) {
  grid_ = grid;
  across_ = AxisFilter(grid.columns, grid.texel_px);
  down_ = AxisFilter(grid.rows, grid.texel_px);
  for (GlarePicture* picture : {&light_, &all_}) *picture = GlarePicture(grid.columns, grid.rows);
  reflected_ = emitted_ = GlarePicture();
  for (std::vector<float>* plane : {&peaks_, &highest_, &means_}) plane->assign(at(0, grid.rows), 0.0f);
  gate_.assign(static_cast<std::size_t>(grid.columns), 0.0f);
}

bool GlareExcess::find(const Image& object, const Image* emission, const PixelRect& rect) {
  const Pixels pixels{object, emission, rect};
  if (!find_tiles(pixels)) return false;
  light_.clear();
  for (const PixelRect& each : tiles_.texels_around(kLightReach, kLightReach)) {
    const PixelRect r = intersect(each, grid_.all());
    for (int y = r.y; y < r.y + r.height; ++y) filter_row(pixels, y, {r.x, r.x + r.width});
  }
  is_divided_ = emission && settings_.emitter_directions != 0;
  if (is_divided_ && reflected_.rows() == 0) reflected_ = emitted_ = GlarePicture(grid_.columns, grid_.rows);
  for (GlarePicture* picture : {&all_, &reflected_, &emitted_}) picture->clear();
  const std::vector<PixelRect> open = tiles_.texels_around(kExcessReach, kExcessReach);
  light_rect_ = intersect(around(open), grid_.all());
  // The outermost texels lie further from the picture than the filter reaches.
  const PixelRect inner{kGateReach, kGateReach, grid_.columns - 2 * kGateReach, grid_.rows - 2 * kGateReach};
  bool any = false;
  for (const PixelRect& each : open) {
    const PixelRect r = intersect(each, inner);
    for (int y = r.y; y < r.y + r.height; ++y) {
      gate_row(y, {r.x, r.x + r.width});
      any |= divide_row(y, {r.x, r.x + r.width});
    }
  }
  return any;
}

bool GlareExcess::find_tiles(const Pixels& pixels) {
  const PixelRect& rect = pixels.rect;
  const float threshold = used_threshold(settings_);
  std::vector<std::uint8_t> bright_rows(static_cast<std::size_t>(std::max(rect.height, 0)));
  for (int y = 0; y < rect.height; ++y)
    bright_rows[static_cast<std::size_t>(y)] = any_above(pixels.object.pixel(0, y), rect.width, threshold);
  if (std::find(bright_rows.begin(), bright_rows.end(), 1) == bright_rows.end()) return false;

  tiles_.columns = tiles_in(grid_.columns), tiles_.rows = tiles_in(grid_.rows);
  tiles_.marked.assign(static_cast<std::size_t>(tiles_.columns) * static_cast<std::size_t>(tiles_.rows), 0);
  const int last_pixel = static_cast<int>(std::ceil(GLARE_TILE * grid_.texel_px)) - 1;
  // First and last of a tile's pixels along an axis, in the object's picture.
  const auto pixels_under = [&](int tile, int first_pixel, int count) {
    const int first = static_cast<int>(std::ceil((tile * GLARE_TILE - GLARE_MARGIN) * grid_.texel_px - 0.5)) - first_pixel;
    return Span{std::clamp(first, 0, count - 1), std::clamp(first + last_pixel, 0, count - 1) + 1};
  };
  const PixelRect texels = grid_.texels(rect, 0);
  bool any = false;
  for (int v = texels.y / GLARE_TILE; v < tiles_in(texels.y + texels.height); ++v) {
    const Span rows = pixels_under(v, rect.y, rect.height);
    for (int y = rows.begin; y < rows.end; ++y) {
      if (!bright_rows[static_cast<std::size_t>(y)]) continue;
      for (int u = texels.x / GLARE_TILE; u < tiles_in(texels.x + texels.width); ++u) {
        std::uint8_t& mark = tiles_.marked[static_cast<std::size_t>(v * tiles_.columns + u)];
        const Span columns = pixels_under(u, rect.x, rect.width);
        if (mark || !any_above(pixels.object.pixel(columns.begin, y), columns.end - columns.begin, threshold)) continue;
        mark = 1;
        any = true;
      }
    }
  }
  return any;
}

/// Sums the pixel rows under a row of texels; the pixels of the frame that were summed.
Span GlareExcess::sum_rows(const Pixels& pixels, int y, const Span& texels) {
  const PixelRect& rect = pixels.rect;
  const Span columns = intersect({across_.first[static_cast<std::size_t>(texels.begin)],
                                  across_.first[static_cast<std::size_t>(texels.end) - 1] + across_.taps},
                                 {rect.x, rect.x + rect.width});
  if (columns.empty()) return columns;
  const int count = columns.end - columns.begin;
  pixel_line_.assign(static_cast<std::size_t>(count), Float4{});
  const int first = down_.first[static_cast<std::size_t>(y)];
  const Span rows = intersect({first, first + down_.taps}, {rect.y, rect.y + rect.height});
  for (int row = rows.begin; row < rows.end; ++row) {
    const float weight = down_.weights_of(y)[row - first];
    if (weight == 0) continue;
    const float* object = pixels.object.pixel(columns.begin - rect.x, row - rect.y);
    // What the object emits of it comes along in place of the coverage.
    const Float4 most{kBrightestPixel, kBrightestPixel, kBrightestPixel, 0};
    if (!pixels.emission) {
      for (int i = 0; i < count; ++i)
        pixel_line_[static_cast<std::size_t>(i)] += weight * at_most(positive(load(object + 4 * i)), most);
      continue;
    }
    const float* emission = pixels.emission->pixel(columns.begin - rect.x, row - rect.y);
    for (int i = 0; i < count; ++i, emission += pixels.emission->channels) {
      const Float4 emitted = at_most(positive(Float4{emission[0], emission[1], emission[2], 0}), most);
      Float4 light = at_most(positive(load(object + 4 * i)), most);
      light[3] = emitted[0] + emitted[1] + emitted[2];
      pixel_line_[static_cast<std::size_t>(i)] += weight * light;
    }
  }
  return columns;
}

/// Brings the object's light onto a row of texels.
void GlareExcess::filter_row(const Pixels& pixels, int y, const Span& texels) {
  const Span columns = sum_rows(pixels, y, texels);
  Float4* light = light_.widen(y, texels);
  for (int x = texels.begin; x < texels.end; ++x) {
    const int first = across_.first[static_cast<std::size_t>(x)];
    const float* weights = across_.weights_of(x);
    Float4 sum{};
    const Span under = intersect({first, first + across_.taps}, columns);
    for (int i = under.begin; i < under.end; ++i)
      sum += weights[i - first] * pixel_line_[static_cast<std::size_t>(i - columns.begin)];
    light[x] = sum;
    peaks_[at(x, y)] = std::max({sum[0], sum[1], sum[2]});
  }
  look_along_row(y, texels);
}

void GlareExcess::look_along_row(int y, const Span& texels) {
  static_assert(kGateReach == 2);
  const float* peaks = &peaks_[at(0, y)];
  float *highest = &highest_[at(0, y)], *means = &means_[at(0, y)];
  for (int x = texels.begin + 2; x < texels.end - 2; ++x) {
    const float outer = std::max(peaks[x - 2], peaks[x + 2]), inner = std::max(peaks[x - 1], peaks[x + 1]);
    highest[x] = std::max(std::max(outer, inner), peaks[x]);
    means[x] =
        kBinomial[0] * (peaks[x - 2] + peaks[x + 2]) + kBinomial[1] * (peaks[x - 1] + peaks[x + 1]) + kBinomial[2] * peaks[x];
  }
}

/// Finds how much of a row's light its gate lets through.
void GlareExcess::gate_row(int y, const Span& texels) {
  const float threshold = used_threshold(settings_), brightest = static_cast<float>(settings_.brightest);
  const float *highest = &highest_[at(0, y)], *means = &means_[at(0, y)];
  const std::ptrdiff_t row = grid_.columns;
  for (int x = texels.begin; x < texels.end; ++x) {
    float most = highest[x], mean = kBinomial[2] * means[x];
    for (int d = 1; d <= kGateReach; ++d) {
      most = std::max(most, std::max(highest[x - d * row], highest[x + d * row]));
      mean += kBinomial[2 + d] * (means[x - d * row] + means[x + d * row]);
    }
    gate_[static_cast<std::size_t>(x)] = gate(most, mean, threshold, brightest);
  }
}

/// Writes a row of the excess, and of its parts; whether there is any.
bool GlareExcess::divide_row(int y, const Span& texels) {
  const Float4* light = light_.row(y);
  Float4* all = all_.widen(y, texels);
  Float4* reflected = is_divided_ ? reflected_.widen(y, texels) : nullptr;
  Float4* emitted = is_divided_ ? emitted_.widen(y, texels) : nullptr;
  const Float4 rgb{1, 1, 1, 0};
  const auto strength = static_cast<float>(settings_.emitter_strength);
  auto found = rgb > rgb;
  for (int x = texels.begin; x < texels.end; ++x) {
    const Float4 kept = gate_[static_cast<std::size_t>(x)] * rgb * light[x];
    // What rounding takes of light that is all emitted must not count as reflected.
    const float sum = std::max(light[x][0] + light[x][1] + light[x][2], 1e-30f);
    const float share = std::clamp(light[x][3] / sum * (1 + 1e-6f), 0.0f, 1.0f);
    const Float4 from_reflection = (1 - share) * kept, from_emission = strength * share * kept;
    all[x] = from_reflection + from_emission;
    if (is_divided_) reflected[x] = from_reflection, emitted[x] = from_emission;
    found |= all[x] > 0;
  }
  return (found[0] | found[1] | found[2]) != 0;
}

}  // namespace catchlight::render
