#include "app/media/ffmpeg_handles.hpp"

#include <cstdarg>
#include <cstdio>
#include <deque>
#include <mutex>

extern "C" {
#include <libavutil/error.h>
#include <libavutil/log.h>
}

#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

constexpr std::size_t kKeptLines = 2;

struct LogLines {
  std::mutex mutex;  // decoders log from their own threads
  std::deque<std::string> lines;
};

LogLines& log_lines() {
  static LogLines log;
  return log;
}

void keep_error_line(void*, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) return;
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  std::string line(text);
  while (!line.empty() && (line.back() == '\n' || line.back() == ' ' || line.back() == '.')) line.pop_back();
  if (line.empty()) return;
  LogLines& log = log_lines();
  const std::lock_guard lock(log.mutex);
  if (!log.lines.empty() && log.lines.back() == line) return;
  log.lines.push_back(line);
  if (log.lines.size() > kKeptLines) log.lines.pop_front();
}

}  // namespace

void capture_ffmpeg_log() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_callback(keep_error_line); });
}

std::string ffmpeg_reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE];
  av_strerror(code, text, sizeof text);
  std::string reason = text;
  LogLines& log = log_lines();
  const std::lock_guard lock(log.mutex);
  for (const std::string& line : log.lines) reason += "; " + line;
  log.lines.clear();
  return reason;
}

int check_ffmpeg(int code, const std::string& what) {
  if (code < 0) throw Error(what + ": " + ffmpeg_reason(code));
  return code;
}

FramePtr make_frame_like(const AVFrame& like, AVPixelFormat format) {
  FramePtr frame = make_frame();
  frame->format = format;
  frame->width = like.width;
  frame->height = like.height;
  check_ffmpeg(av_frame_get_buffer(frame.get(), 0), "cannot allocate a frame");
  check_ffmpeg(av_frame_copy_props(frame.get(), &like), "cannot copy a frame's properties");
  return frame;
}

}  // namespace catchlight::app
