// Pictures on the glare grid and its halvings, and the one operation that glare is made of: a row added to another.
#pragma once

#include <vector>

#include "render/math/float4.hpp"

namespace catchlight::render {

/// Texels of a row, half-open.
struct Span {
  int begin = 0, end = 0;
  bool empty() const { return begin >= end; }
};

inline Span intersect(const Span& a, const Span& b) {
  return {a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end};
}

/// A picture that is black outside of one span a row, where nothing is stored and nothing computed.
class GlarePicture {
 public:
  GlarePicture() = default;
  GlarePicture(int columns, int rows);

  int columns() const { return columns_; }
  int rows() const { return static_cast<int>(lit_.size()); }
  Span all_columns() const { return {0, columns_}; }

  /// Makes all of it black.
  void clear();

  /// The span of a row that need not be black; empty beyond the picture.
  Span lit(int y) const;

  /// The row's texels; only those of its span may be read.
  const Float4* row(int y) const { return &texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_)]; }
  /// The row's texels, its span grown to hold `span` too, which lies within the picture.
  Float4* widen(int y, const Span& span);

  /// Adds `weight` times a row of another picture to a row of this one, moved by so many texels to the right, within a span.
  void add(int y, const GlarePicture& from, int from_y, int right, Float4 weight, const Span& within);

 private:
  int columns_ = 0;
  std::vector<Span> lit_;
  std::vector<Float4> texels_;
};

}  // namespace catchlight::render
