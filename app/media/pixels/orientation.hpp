// Turns pictures upright by the rotation that a file's metadata asks for. Private to app/media.
#pragma once

#include <memory>
#include <string>

extern "C" {
#include <libavfilter/avfilter.h>
}

#include "app/media/ffmpeg_handles.hpp"

namespace catchlight::app {

/// Quarter turns and mirrorings by libavfilter: samples are moved, not interpolated. (4:2:2 turned by 90 degrees becomes 4:4:4,
/// for want of a common format with chroma halved vertically.) The library is loaded with the first picture that is to be turned.
class Orientation {
 public:
  /// `matrix`: FFmpeg's display matrix (9 fixed-point numbers), or null. Throws Error for angles that are no quarter turns.
  explicit Orientation(const std::int32_t* matrix);

  bool is_upright() const { return filters_.empty(); }

  /// The picture in display orientation; keeps timestamps and tags.
  FramePtr apply(FramePtr picture);

 private:
  struct FilterLibrary;
  struct FreeGraph {
    void operator()(AVFilterGraph* graph) const;
  };
  void build(const AVFrame& picture);

  std::string filters_;  // libavfilter's notation
  std::unique_ptr<AVFilterGraph, FreeGraph> graph_;
  AVFilterContext *input_ = nullptr, *output_ = nullptr;
};

}  // namespace catchlight::app
