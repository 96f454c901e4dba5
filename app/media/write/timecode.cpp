#include "app/media/write/timecode.hpp"

extern "C" {
#include <libavutil/timecode.h>
}

namespace catchlight::app {

std::string timecode_at(const SourceInfo& source, std::int64_t number) {
  const AVRational rate = av_d2q(source.frame_rate, 1001000);
  AVTimecode timecode;
  if (source.start_timecode.empty() || av_timecode_check_frame_rate(rate) < 0 ||
      av_timecode_init_from_string(&timecode, rate, source.start_timecode.c_str(), nullptr) < 0)
    return "";
  char text[AV_TIMECODE_STR_SIZE];
  return av_timecode_make_string(&timecode, text, static_cast<int>(number - source.first_number));
}

}  // namespace catchlight::app
