#include "app/media/pixels/orientation.hpp"

#include <cmath>

extern "C" {
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavutil/display.h>
}

#include "app/media/late_library.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

/// What is needed of libavfilter.
struct Orientation::FilterLibrary {
  LateLibrary library{"libavfilter.so." AV_STRINGIFY(LIBAVFILTER_VERSION_MAJOR)};
#define CATCHLIGHT_FUNCTION(name) decltype(&::name) name = library.function<decltype(&::name)>(#name)
  CATCHLIGHT_FUNCTION(avfilter_graph_alloc);
  CATCHLIGHT_FUNCTION(avfilter_graph_free);
  CATCHLIGHT_FUNCTION(avfilter_graph_alloc_filter);
  CATCHLIGHT_FUNCTION(avfilter_graph_create_filter);
  CATCHLIGHT_FUNCTION(avfilter_graph_parse_ptr);
  CATCHLIGHT_FUNCTION(avfilter_graph_config);
  CATCHLIGHT_FUNCTION(avfilter_get_by_name);
  CATCHLIGHT_FUNCTION(avfilter_init_str);
  CATCHLIGHT_FUNCTION(avfilter_inout_alloc);
  CATCHLIGHT_FUNCTION(avfilter_inout_free);
  CATCHLIGHT_FUNCTION(av_buffersrc_parameters_alloc);
  CATCHLIGHT_FUNCTION(av_buffersrc_parameters_set);
  CATCHLIGHT_FUNCTION(av_buffersrc_add_frame);
  CATCHLIGHT_FUNCTION(av_buffersink_get_frame);
#undef CATCHLIGHT_FUNCTION

  static const FilterLibrary& get() {
    static const FilterLibrary functions;
    return functions;
  }
};

namespace {

// The matrix maps stored to shown coordinates: (x, y) -> (a x + c y, b x + d y), y down; a, b, c, d = entries 0, 1, 3, 4.
// Signs of the four tell the eight orientations apart.
std::string filters_for(const std::int32_t* matrix) {
  if (matrix[0] == 0 && matrix[1] == 0 && matrix[3] == 0 && matrix[4] == 0) return "";  // left blank by its writer
  const auto near_zero = [&](int i, int against) {
    return std::abs(double(matrix[i])) < 0.02 * std::abs(double(matrix[against]));
  };
  if (near_zero(1, 0) && near_zero(3, 4)) {
    std::string filters;
    if (matrix[0] < 0) filters = "hflip";
    if (matrix[4] < 0) filters += filters.empty() ? "vflip" : ",vflip";
    return filters;
  }
  if (near_zero(0, 1) && near_zero(4, 3)) {
    // x' = c y, y' = b x: b > 0 and c < 0 is a quarter turn clockwise.
    if (matrix[1] > 0) return matrix[3] < 0 ? "transpose=clock" : "transpose=cclock_flip";
    return matrix[3] < 0 ? "transpose=clock_flip" : "transpose=cclock";
  }
  const double angle_deg = -av_display_rotation_get(matrix);
  throw Error("its metadata asks for a rotation by " + std::to_string(std::lround(angle_deg)) +
              " degrees; only quarter turns can be applied");
}

}  // namespace

Orientation::Orientation(const std::int32_t* matrix) {
  if (matrix) filters_ = filters_for(matrix);
}

void Orientation::FreeGraph::operator()(AVFilterGraph* graph) const {
  FilterLibrary::get().avfilter_graph_free(&graph);
}

void Orientation::build(const AVFrame& picture) {
  const FilterLibrary& filters = FilterLibrary::get();
  graph_.reset(allocated(filters.avfilter_graph_alloc()));
  graph_->nb_threads = 1;
  input_ = allocated(filters.avfilter_graph_alloc_filter(graph_.get(), filters.avfilter_get_by_name("buffer"), "in"));
  AVBufferSrcParameters* parameters = allocated(filters.av_buffersrc_parameters_alloc());
  parameters->format = picture.format;
  parameters->width = picture.width;
  parameters->height = picture.height;
  parameters->time_base = picture.time_base;
  parameters->sample_aspect_ratio = picture.sample_aspect_ratio;
  const int set = filters.av_buffersrc_parameters_set(input_, parameters);
  av_free(parameters);
  check_ffmpeg(set, "cannot set up the rotation");
  check_ffmpeg(filters.avfilter_init_str(input_, nullptr), "cannot set up the rotation");
  check_ffmpeg(filters.avfilter_graph_create_filter(&output_, filters.avfilter_get_by_name("buffersink"), "out", nullptr, nullptr,
                                                    graph_.get()),
               "cannot set up the rotation");

  AVFilterInOut* from = allocated(filters.avfilter_inout_alloc());
  AVFilterInOut* to = allocated(filters.avfilter_inout_alloc());
  *from = {av_strdup("in"), input_, 0, nullptr};
  *to = {av_strdup("out"), output_, 0, nullptr};
  const int parsed = filters.avfilter_graph_parse_ptr(graph_.get(), filters_.c_str(), &to, &from, nullptr);
  filters.avfilter_inout_free(&from);
  filters.avfilter_inout_free(&to);
  check_ffmpeg(parsed, "cannot set up the rotation");
  check_ffmpeg(filters.avfilter_graph_config(graph_.get(), nullptr), "cannot set up the rotation");
}

FramePtr Orientation::apply(FramePtr picture) {
  if (is_upright()) return picture;
  if (!graph_) build(*picture);
  const FilterLibrary& filters = FilterLibrary::get();
  check_ffmpeg(filters.av_buffersrc_add_frame(input_, picture.get()), "cannot rotate a frame");
  FramePtr turned = make_frame();
  check_ffmpeg(filters.av_buffersink_get_frame(output_, turned.get()), "cannot rotate a frame");
  if (turned->linesize[0] > 0) return turned;
  // vflip only turns the strides round: rows in memory order are what everything else expects.
  FramePtr rows_down = make_frame_like(*turned, static_cast<AVPixelFormat>(turned->format));
  check_ffmpeg(av_frame_copy(rows_down.get(), turned.get()), "cannot rotate a frame");
  return rows_down;
}

}  // namespace catchlight::app
