// Footage in: videos, numbered image sequences, cameras and streams, through FFmpeg's libraries.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "app/media/pixels/frame.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"

struct AVStream;

namespace catchlight::app {

struct SourceInfo {
  int width_px = 0, height_px = 0;          ///< display orientation
  std::optional<std::int64_t> frame_count;  ///< where the container or the folder says
  std::int64_t first_number = 0;            ///< number of the first frame
  double frame_rate = 0;                    ///< average
  bool is_sequence = false;
  bool is_live = false;        ///< a camera or stream, which does not wait: read() gives the newest frame
  bool is_one_pass = false;    ///< it cannot be read a second time; see is_one_pass()
  bool is_interlaced = false;  ///< as the first frame says
  std::string start_timecode;  ///< of the first frame, HH:MM:SS:FF; empty where the footage says none, as the next two
  std::string title, creation_time;
  std::string codec, pixel_format;
};

/// What the owner of a source wants to have a say in while it waits and decodes.
struct SourceHooks {
  std::stop_token stop;                       ///< ends all waiting for data, while the source is opened as well
  std::function<void(const Frame&)> decoded;  ///< sees each frame as it is decoded, on the thread that does so; of live footage
                                              ///< those too that are left out for newer ones
};

/// Whether what is there can be read once only: a camera, an address or stdin.
bool is_one_pass(const std::string& location);

/// Whether it names numbered image files: `shot.%04d.png`, `shot.####.png`.
bool names_sequence(const std::string& location);

/// The footage broke off or is damaged; frames before the damage were delivered.
struct DamagedMedia : Error {
  using Error::Error;
};

/// Decodes strictly in order; never seeks.
class MediaSource {
 public:
  /// `location`: a file, a `%04d` or `####` pattern (from any number), a camera (`camera:0` or `/dev/video0`), an address
  /// (`rtsp://`, `http://`, ...), or `-` for stdin. `sequence_fps`: how fast image files follow each other; without, EXR's
  /// framesPerSecond says so, else it is 24. Throws Error: no such file, no video stream in it, a gap in a sequence (number
  /// named); DamagedMedia: not even one frame can be decoded. UsageError: `sequence_fps` for what is no sequence, or not above 0.
  /// `response` is the camera's, where the stream does not say it.
  static std::unique_ptr<MediaSource> open(const std::string& location, std::optional<double> sequence_fps = {},
                                           std::shared_ptr<const CameraResponse> response = {}, SourceHooks hooks = {});
  virtual ~MediaSource() = default;

  virtual const SourceInfo& info() const = 0;

  /// The next frame, or none at the end. Throws DamagedMedia where the data is truncated or corrupt, or where the pictures change
  /// size; the frames before have been delivered, and the next call finds the end. (Cameras and streams: broken frames are
  /// skipped instead.)
  virtual std::optional<Frame> read() = 0;

  /// The stream whose audio and timing a sink carries over; null for sequences.
  virtual const AVStream* video_stream() const = 0;

  /// Frames of live footage that nobody took before a newer one came.
  virtual std::int64_t dropped_frames() const { return 0; }

  /// Ends a read() that waits for a stream, and all that follow. May be called from another thread.
  virtual void stop() {}
};

}  // namespace catchlight::app
