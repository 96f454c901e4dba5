// What the media tests share: a folder that vanishes, the `ffmpeg` command to make inputs and to check outputs, and frames made
// by hand.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/media/ffmpeg_handles.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "app/media/read/source.hpp"
#include "app/media/write/sink.hpp"

namespace catchlight::app::testing {

class MediaTest : public ::testing::Test {
 protected:
  MediaTest();
  ~MediaTest() override;

  /// A path in the test's own folder.
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Names of the files in the folder, hidden ones too, sorted.
  std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
};

/// Runs a command with the shell; its stdout. Fails the test (with what it printed) unless it exits 0.
std::string run_command(const std::string& command);

/// `ffmpeg -i ...` quietly; arguments are the shell's.
void ffmpeg(const std::string& arguments);

/// What ffprobe says of `entries`, one line a packet or stream, comma-separated.
std::string ffprobe(const std::string& file, const std::string& arguments);

std::vector<std::uint8_t> bytes_of(const std::string& file);
void write_bytes(const std::string& file, const std::vector<std::uint8_t>& bytes);

/// Every frame; throws what the source throws.
std::vector<Frame> read_all(MediaSource& source);
std::vector<Frame> read_all(const std::string& location);

/// Copies frames numbered from `begin` to before `end` unchanged.
void pass_through(const std::string& input, const std::string& output, const SinkOptions& options = {}, std::int64_t begin = 0,
                  std::int64_t end = INT64_MAX);

/// A frame of pseudo-random samples (the same for the same seed).
FramePtr noise_frame(AVPixelFormat format, int width, int height, unsigned seed);

/// All samples of a frame, without row padding.
std::vector<std::uint8_t> samples_of(const AVFrame& picture);

/// The message of the error that `statement` throws.
template <class Exception, class Statement>
std::string message_of(Statement statement) {
  try {
    statement();
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing of the expected type was thrown";
  return "";
}

}  // namespace catchlight::app::testing
