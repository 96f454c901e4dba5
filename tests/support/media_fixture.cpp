#include "tests/support/media_fixture.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>

extern "C" {
#include <libavutil/imgutils.h>
}

namespace catchlight::app::testing {

namespace fs = std::filesystem;

MediaTest::MediaTest() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name() + "." + std::to_string(getpid());
  std::replace(name.begin(), name.end(), '/', '_');
  folder_ = fs::temp_directory_path() / ("catchlight." + name);
  fs::create_directories(folder_);
}

MediaTest::~MediaTest() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::vector<std::string> MediaTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string run_command(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string output;
  char buffer[4096];
  for (std::size_t got; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) output.append(buffer, got);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command + "\n" + output);
  return output;
}

void ffmpeg(const std::string& arguments) {
  run_command("ffmpeg -v error -nostdin -y " + arguments + " 2>&1");
}

std::string ffprobe(const std::string& file, const std::string& arguments) {
  return run_command("ffprobe -v error -of csv=p=0 " + arguments + " '" + file + "' 2>&1");
}

std::vector<std::uint8_t> bytes_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const std::string& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<Frame> read_all(MediaSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.read()) frames.push_back(*frame);
  return frames;
}

std::vector<Frame> read_all(const std::string& location) {
  return read_all(*MediaSource::open(location));
}

void pass_through(const std::string& input, const std::string& output, const SinkOptions& options, std::int64_t begin,
                  std::int64_t end) {
  const auto source = MediaSource::open(input);
  const auto sink = MediaSink::open(output, input, *source, options);
  while (auto frame = source->read()) {
    if (frame->number() >= begin && frame->number() < end) sink->write(*frame);
  }
  sink->finish();
}

FramePtr noise_frame(AVPixelFormat format, int width, int height, unsigned seed) {
  capture_ffmpeg_log();
  FramePtr frame = make_frame();
  frame->format = format;
  frame->width = width;
  frame->height = height;
  check_ffmpeg(av_frame_get_buffer(frame.get(), 0), "noise");
  // Bits above a sample's depth are 0 in every decoder's frames, and swscale counts on it.
  for (const AVBufferRef* buffer : frame->buf) {
    if (buffer) std::memset(buffer->data, 0, buffer->size);
  }
  std::mt19937 random(seed);
  const PixelLayout layout = pixel_layout(format).value();
  const int components = layout.model == ColorModel::gray ? 1 : 3;
  for (int i = 0; i < components; ++i) {
    const bool chroma = layout.model == ColorModel::yuv && i > 0;
    const SamplePlane plane(*frame, layout, i);
    const int columns = chroma ? -(-width >> layout.chroma_shift_x) : width,
              rows = chroma ? -(-height >> layout.chroma_shift_y) : height;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        if (layout.is_float) {
          plane.set_value(x, y, static_cast<float>(random() % 4096) / 1024.0f);
        } else {
          plane.set_code(x, y, static_cast<int>(random() % (1u << layout.depth())));
        }
      }
    }
  }
  return frame;
}

std::vector<std::uint8_t> samples_of(const AVFrame& picture) {
  const auto format = static_cast<AVPixelFormat>(picture.format);
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(av_image_get_buffer_size(format, picture.width, picture.height, 1)));
  av_image_copy_to_buffer(samples.data(), static_cast<int>(samples.size()), picture.data, picture.linesize, format, picture.width,
                          picture.height, 1);
  return samples;
}

}  // namespace catchlight::app::testing
