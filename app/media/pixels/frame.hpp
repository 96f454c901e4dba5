// One picture of the footage, kept as the decoder gave it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "catchlight/composite.hpp"
#include "catchlight/frame_image.hpp"
#include "catchlight/response.hpp"

struct AVFrame;

namespace catchlight::app {

/// Shares the decoder's samples; copies are cheap. Everything is in display orientation (rotation metadata already applied).
class Frame : public FrameImage {
 public:
  /// `response` stands in for what the stream declares.
  Frame(std::shared_ptr<const AVFrame> picture, std::int64_t number, double time_s,
        std::shared_ptr<const CameraResponse> response = {});

  std::int64_t number() const { return number_; }  ///< index in a video from 0; the file's own number in a sequence
  double time_s() const { return time_s_; }
  std::chrono::steady_clock::time_point decoded_at() const { return decoded_at_; }

  /// The same frame with another number.
  Frame numbered(std::int64_t number) const;

  int width_px() const;
  int height_px() const;
  const AVFrame& picture() const { return *picture_; }
  bool is_float() const;  ///< codes that do not end at 1

  /// The luma plane as it is where it is 8-bit YUV or grey; else made once: deeper planes rounded to 8 bits, RGB weighted by Rec.
  /// 709 on codes, float linear frames coded as sRGB first. Where the response is a curve, its light is coded as sRGB.
  LumaView luma() const override;

  /// RGB codes of a part of the frame, by swscale with the stream's own matrix and range, accurate rounding and full chroma
  /// interpolation: the same values as converting the whole frame.
  Plate rgb(const PixelRect& rect) const;

  CodeView codes() const override;

  /// The primaries that the stream declares, and its transfer function or the response given (unspecified: sRGB, Rec. 709).
  PlateColor color() const override;

  /// log2 of the pixels across and down that share a colour sample: (1, 1) in 4:2:0, (0, 0) where every pixel has its own.
  glm::ivec2 color_block_shift() const;

  /// A frame in the same pixel format whose changed pixels (alpha 1) show the composite; every other sample is the decoder's own.
  /// In subsampled formats a chroma sample whose pixels all changed is the mean of theirs; where some did, it moves by the mean
  /// of the changes.
  Frame with_composite(const Composite& composite) const;

  Frame renumbered(std::int64_t number) const;

 private:
  friend class FrameWriter;

  std::shared_ptr<const AVFrame> picture_;
  std::int64_t number_;
  double time_s_;
  std::chrono::steady_clock::time_point decoded_at_ = std::chrono::steady_clock::now();
  std::shared_ptr<const CameraResponse> response_;
  mutable std::shared_ptr<std::vector<std::uint8_t>> made_luma_;
};

/// Writes into a copy of a frame what comes band by band.
class FrameWriter {
 public:
  explicit FrameWriter(Frame frame);

  /// As with_composite(). Bands as a CompositeSink has them may be written from several threads.
  void write(const Composite& composite) const;

  /// The frame with all that was written.
  Frame finish() &&;

 private:
  Frame frame_;
  std::shared_ptr<AVFrame> written_;
};

}  // namespace catchlight::app
