#include "render/cpu/glare/glare_picture.hpp"

#include <algorithm>

namespace catchlight::render {

GlarePicture::GlarePicture(int columns, int rows)
    : columns_(columns),
      lit_(static_cast<std::size_t>(rows)),
      texels_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

void GlarePicture::clear() {
  std::fill(lit_.begin(), lit_.end(), Span{});
}

Span GlarePicture::lit(int y) const {
  return y >= 0 && y < rows() ? lit_[static_cast<std::size_t>(y)] : Span{};
}

Float4* GlarePicture::widen(int y, const Span& span) {
  Span& lit = lit_[static_cast<std::size_t>(y)];
  Float4* texels = &texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_)];
  if (lit.empty()) lit = {span.begin, span.begin};
  if (span.begin < lit.begin) std::fill(texels + span.begin, texels + lit.begin, Float4{});
  if (span.end > lit.end) std::fill(texels + lit.end, texels + span.end, Float4{});
  lit = {std::min(lit.begin, span.begin), std::max(lit.end, span.end)};
  return texels;
}

void GlarePicture::add(int y, const GlarePicture& from, int from_y, int right, Float4 weight, const Span& within) {
  const Span source = from.lit(from_y), span = intersect({source.begin + right, source.end + right}, within);
  if (span.empty()) return;
  Float4* to = widen(y, span) + span.begin;
  const Float4* texels = from.row(from_y) + span.begin - right;
  for (int i = 0; i < span.end - span.begin; ++i) to[i] += weight * texels[i];
}

}  // namespace catchlight::render
