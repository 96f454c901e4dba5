// Pixel format conversion by swscale, as `ffmpeg -sws_flags accurate_rnd+full_chroma_int` does it, but for white: between YUV and
// 16-bit RGB, swscale is up to 0.4 % too dark (it shifts codes instead of stretching them); that is put right. Private to
// app/media.
#pragma once

#include "app/media/ffmpeg_handles.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::app {

/// The whole frame. YUV is read by its own matrix and range (untagged: BT.601, limited), RGB becomes limited-range YUV of the
/// matrix `of_rgb`; tags say so.
FramePtr convert(const AVFrame& picture, AVPixelFormat format, AVColorSpace of_rgb = AVCOL_SPC_BT709);

/// A part as RGB of 8 or 16 bits, packed or in planes. `rect` must begin and end on whole chroma samples or at the frame's edge.
FramePtr convert_part(const AVFrame& picture, const PixelRect& rect, AVPixelFormat rgb_format);

/// The one of `formats` (ended by AV_PIX_FMT_NONE) that is `format` or loses least.
AVPixelFormat nearest_format(AVPixelFormat format, const AVPixelFormat* formats);

/// Float scene-linear pictures cannot be shown as they are: 16-bit sRGB codes, tagged so. Others: the same samples.
FramePtr with_display_codes(const AVFrame& picture);

}  // namespace catchlight::app
