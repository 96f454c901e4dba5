#include "app/window/playing/shot_player.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "app/session/session.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

/// Thrown out of what takes long when nobody waits for it any more.
struct GivenUp {};

RgbPicture rgb_of(const Frame& frame) {
  RgbPicture picture{frame.width_px(), frame.height_px(), {}};
  const Plate plate = frame.rgb({0, 0, picture.width, picture.height});
  picture.rgb = codes_8_bit(plate);
  return picture;
}

SceneSettings quicker(SceneSettings settings) {
  settings.quality.samples = std::min(settings.quality.samples, 2);
  settings.quality.reflection_rays = std::min(settings.quality.reflection_rays, 8);
  return settings;
}

}  // namespace

ShotPlayer::ShotPlayer(Recording recording) : recording_(std::move(recording)) {
  log_.set_quiet(true);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

ShotPlayer::~ShotPlayer() = default;

std::uint64_t ShotPlayer::wish(const SceneSettings& settings, std::int64_t position, Rung rung, const FrameExtras& extras) {
  const std::lock_guard lock(mutex_);
  next_ = Wish{++last_wish_, settings, position, rung, extras};
  wished_.notify_one();
  return last_wish_;
}

std::shared_ptr<const DrawnFrame> ShotPlayer::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

PlayerStatus ShotPlayer::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool ShotPlayer::is_idle() const {
  const std::lock_guard lock(mutex_);
  return finished_ == last_wish_;
}

void ShotPlayer::publish(std::shared_ptr<const DrawnFrame> frame) {
  const std::lock_guard lock(mutex_);
  newest_ = std::move(frame);
}

void ShotPlayer::finish(std::uint64_t wish, const std::optional<std::string>& error) {
  const std::lock_guard lock(mutex_);
  finished_ = wish;
  status_.error = error;
  status_.stage.clear();
  status_.warnings = log_.warnings();
}

/// The first frame as it is, while the shot is being opened.
void ShotPlayer::show_footage() {
  const std::unique_ptr<MediaSource> source = open_footage(recording_);
  const std::optional<Frame> frame = source->read();
  if (!frame) return;
  auto shown = std::make_shared<DrawnFrame>();
  shown->number = frame->number(), shown->time_s = frame->time_s();
  shown->plate = shown->composite = rgb_of(*frame);
  shown->image = shown->composited = frame;
  publish(std::move(shown));
}

void ShotPlayer::open(const std::stop_token& stop) {
  log_.set_task_handler([this, stop](const std::string& stage, double share) {
    if (stop.stop_requested()) throw GivenUp{};
    const std::lock_guard lock(mutex_);
    status_.stage = stage, status_.share = share;
  });
  show_footage();
  session_ = std::make_unique<Session>(recording_, SessionOptions{.is_revisited = true}, log_);
  const SourceInfo& info = session_->footage().info();
  const std::lock_guard lock(mutex_);
  status_.frame_count = info.frame_count.value_or(0);
  if (info.frame_rate > 0) status_.frame_rate = info.frame_rate;
}

RgbPicture ShotPlayer::truth_of(const Frame& frame) const {
  if (!recording_.truth_folder) return {};
  char name[32];
  std::snprintf(name, sizeof name, "%04lld.png", static_cast<long long>(frame.number()));
  const std::filesystem::path path = std::filesystem::path(*recording_.truth_folder) / name;
  if (!std::filesystem::exists(path)) return {};
  cv::Mat rgb;
  cv::cvtColor(render::read_picture(path.string(), render::PictureDepth::eight_bits), rgb, cv::COLOR_BGR2RGB);
  if (rgb.cols != frame.width_px() || rgb.rows != frame.height_px()) return {};
  return {rgb.cols, rgb.rows, {rgb.datastart, rgb.dataend}};
}

/// What is looked at beside the composite, over the plate as it was before that.
void ShotPlayer::draw_extras(const FrameExtras& extras, const FrameJob& job, const Frame& plate, DrawnFrame& drawn) {
  if (extras.corners) drawn.corners = corner_residuals(plate, job.track, drawn.camera, session_->settings());
  if (!extras.layer && !extras.masks) return;
  const Layers layers = session_->layers({.image = plate, .track = job.track, .view = job.view});
  if (extras.layer) drawn.layer = picture_of_layer(layers, *extras.layer, plate.color());
  if (extras.masks) drawn.masks = masks_of(layers);
}

void ShotPlayer::draw(const Wish& wish) {
  const auto start = std::chrono::steady_clock::now();
  session_->apply(wish.rung == Rung::full ? wish.settings : quicker(wish.settings));
  session_->seek(wish.position);
  std::optional<FrameJob> job = session_->decode();
  if (!job) return;
  session_->track(*job);
  auto drawn = std::make_shared<DrawnFrame>();
  drawn->position = wish.position, drawn->wish = wish.number, drawn->rung = wish.rung;
  drawn->number = job->image.number(), drawn->time_s = job->image.time_s();
  drawn->plate = rgb_of(job->image);
  drawn->truth = truth_of(job->image);
  const Frame plate = job->image;
  session_->render(*job);
  drawn->image = plate;
  drawn->composited = job->image.with_composite(job->result);
  drawn->composite = job->result.rect.empty() ? drawn->plate : rgb_of(*drawn->composited);
  drawn->track = job->track;
  drawn->camera = session_->camera();
  drawn->target = session_->settings().tag.target();
  const render::ReceiverGrid& grid = session_->renderer().builder().scene().scene.transfer.grid;
  if (grid.columns >= 2) drawn->receiver = {grid.min_m, grid.max_m};
  drawn->pass_times = session_->renderer().pass_times();
  draw_extras(wish.extras, *job, plate, *drawn);
  drawn->draw_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  publish(std::move(drawn));
  std::vector<PlanEntry> plan = session_->plan();
  const std::lock_guard lock(mutex_);
  status_.plan = std::move(plan);
}

void ShotPlayer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Wish wish;
    {
      std::unique_lock lock(mutex_);
      if (!wished_.wait(lock, stop, [&] { return next_.has_value(); })) return;
      wish = *std::exchange(next_, std::nullopt);
    }
    std::optional<std::string> error;
    try {
      if (!session_) open(stop);
      draw(wish);
    } catch (const GivenUp&) {
      return;
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    finish(wish.number, error);
  }
}

}  // namespace catchlight::app
