#include "app/window/playing/shot_player.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "app/session/session.hpp"
#include "app/settings/change_cost.hpp"
#include "app/settings/parameters.hpp"
#include "render/image/picture_file.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {
namespace {

/// How often is looked whether files were saved anew.
constexpr auto kWatchInterval = std::chrono::milliseconds(300);

/// Thrown out of what takes long when nobody waits for it any more: the window is closed, or other settings are wanted.
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

ShotPlayer::ShotPlayer(Recording recording, std::function<void()> tell)
    : recording_(std::move(recording)), tell_(std::move(tell)) {
  if (is_one_pass(recording_.footage)) live_ = std::make_unique<LiveFeed>(recording_);
  log_.set_quiet(true);
  thread_ = std::jthread([this](const std::stop_token& stop) {
    constexpr int kNiceness = 5;
    [[maybe_unused]] const int niceness = nice(kNiceness);  // this thread's and its workers': the controls go before the picture
    run(stop);
    session_.reset();  // its OpenGL context is this thread's
  });
}

ShotPlayer::~ShotPlayer() = default;

std::uint64_t ShotPlayer::ask(FrameWish wish) {
  const std::lock_guard lock(mutex_);
  next_ = std::move(wish);
  wished_.notify_one();
  return ++last_wish_;
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
  status_.redoing.reset();
  status_.warnings = log_.warnings();
}

/// The newest frame of what is still being opened, tracked or baked; some a second are enough.
void ShotPlayer::see_decoded(const Frame& frame) {
  constexpr auto kInterval = std::chrono::milliseconds(100);
  if (live_) live_->see(frame);
  const auto has_drawn = [&] { return newest_ && newest_->wish != 0; };
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (has_drawn() || now - previewed_ < kInterval) return;
  }
  previewed_ = now;
  auto shown = std::make_shared<DrawnFrame>();
  shown->number = frame.number(), shown->time_s = frame.time_s();
  shown->plate = shown->composite = rgb_of(frame);
  shown->image = shown->composited = frame;
  {
    const std::lock_guard lock(mutex_);
    if (!has_drawn()) newest_ = std::move(shown);
  }
  tell_();
}

/// Whether a bake for the session's settings is of no use to the wish.
bool ShotPlayer::asks_otherwise(const FrameWish& wish) const {
  return !is_rough_ && session_->renderer().builder().needs_bake(wish.settings);
}

void ShotPlayer::open(const std::stop_token& stop) {
  log_.set_task_handler([this, stop](const std::string& stage, double share) {
    const std::lock_guard lock(mutex_);
    if (stop.stop_requested() || (stage == "bake" && next_ && session_ && asks_otherwise(*next_))) throw GivenUp{};
    status_.stage = stage, status_.share = share;
  });
  tracks_anew_ = true;
  session_.reset();
  recording_.scene = wish_.settings;
  const SourceHooks hooks{stop, [this](const Frame& frame) { see_decoded(frame); }};
  const auto make_session = [&] {
    session_ = std::make_unique<Session>(recording_, SessionOptions{.is_revisited = true, .hooks = hooks}, log_);
    return session_->footage().info();
  };
  const SourceInfo info = live_ ? live_->open(make_session) : make_session();
  const std::lock_guard lock(mutex_);
  status_.frame_count = live_ ? 0 : info.frame_count.value_or(0);
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

void ShotPlayer::note_pose_errors() {
  std::vector<TrackRow> truth;
  if (recording_.poses_csv) truth = tracking::read_track_file(*recording_.poses_csv).rows;
  auto errors = std::make_shared<const std::vector<PoseError>>(
      pose_errors(session_->known_rows(), truth, session_->camera(), session_->settings().tag.size_m));
  const std::lock_guard lock(mutex_);
  status_.pose_errors = std::move(errors);
}

/// What is looked at beside the composite, over the plate as it was before that.
void ShotPlayer::draw_extras(const FrameExtras& extras, const FrameJob& job, const Frame& plate, DrawnFrame& drawn) {
  if (extras.corners) drawn.corners = corner_residuals(plate, job.track, drawn.camera, session_->settings());
  const FrameJob again{.image = plate, .track = job.track, .view = job.view};
  const bool shows_light = extras.layer == View::light, shows_layer = extras.layer && !shows_light;
  if (shows_light) {
    Image share = session_->light_share(again, extras.light > 0 ? std::optional<std::size_t>(extras.light - 1) : std::nullopt);
    RgbPicture picture = light_picture(share, plate.color());
    drawn.layer = LayerPicture{View::light, std::move(share), std::move(picture), extras.light};
  }
  if (!shows_layer && !extras.masks) return;
  const Layers layers = session_->layers(again);
  if (shows_layer) drawn.layer = picture_of_layer(layers, *extras.layer, plate.color());
  if (extras.masks) drawn.masks = masks_of(layers);
}

/// All that is read more than once. Not the footage: it is too large to be read anew whenever it grows.
void ShotPlayer::watch_files(const SceneSettings& settings) {
  std::vector<std::string> files{word_or_path(settings, "probe.image"), word_or_path(settings, "glare.aperture"),
                                 word_or_path(settings, "exposure.response"), recording_.camera_file.value_or("")};
  for (const SceneSettings::Object& object : settings.objects) files.push_back(settings.resolve(object.mesh));
  if (session_)
    for (const std::string& file : session_->renderer().builder().mesh_files()) files.push_back(file);
  std::error_code missing;
  if (!settings.shader_folder.empty())
    for (const auto& shader : std::filesystem::directory_iterator(settings.shader_folder, missing))
      files.push_back(shader.path().string());
  watch_.watch(files);
}

/// The scene's files are read anew where they are asked for; what the session was opened with, only by opening it again.
void ShotPlayer::see_changes() {
  const SceneSettings& settings = wish_.settings;
  const std::string& shaders = settings.shader_folder;
  const auto is_shader = [&](const std::string& file) { return file.starts_with(shaders); };
  if (!shaders.empty() && session_ && std::ranges::any_of(changed_, is_shader)) shader_problems_ = session_->reload_shaders();
  if (changed_.contains(word_or_path(settings, "exposure.response")) || changed_.contains(recording_.camera_file.value_or("")))
    session_.reset();
}

/// Where nothing can be drawn, the footage is shown: but a frame that was drawn before stays.
void ShotPlayer::render(FrameJob& job, const std::shared_ptr<DrawnFrame>& drawn) {
  try {
    session_->render(job);
  } catch (const std::exception&) {
    const std::shared_ptr<const DrawnFrame> before = newest();
    drawn->wish = 0;
    if (!before || before->wish == 0 || before->position != drawn->position) publish(drawn);
    throw;
  }
}

/// While something moves that bakes are made from, rough ones are enough, until it rests. Live footage always moves: there, when
/// a frame passes without a new wish.
Rung ShotPlayer::apply(const FrameWish& wish) {
  constexpr double kSmooth_ms = 1000.0 / 15;
  is_rough_ = wish.moves && !is_repeated_ && (is_rough_ || session_->renderer().builder().needs_bake(wish.settings));
  const bool is_quick = wish.moves && full_ms_ > kSmooth_ms;
  session_->apply(is_quick ? quicker(wish.settings) : wish.settings, is_rough_ ? BakeFineness::rough : BakeFineness::full);
  return is_rough_ ? Rung::rough : is_quick ? Rung::quick : Rung::full;
}

/// The first frame of a scene takes longer than those that follow.
void ShotPlayer::note_time(Rung rung) {
  const int version = session_->renderer().builder().scene().version;
  const bool is_typical = rung == Rung::full && version == std::exchange(drawn_version_, version);
  if (!is_typical) return;
  full_ms_ = 0;
  for (const render::PassTime& pass : session_->renderer().pass_times()) full_ms_ += pass.ms;
}

void ShotPlayer::note_redoing(const std::set<ChangeCost>& costs) {
  const std::lock_guard lock(mutex_);
  status_.redoing = costs.empty() ? std::nullopt : std::optional(*costs.rbegin());
}

/// The footage may be shorter than it says.
std::optional<FrameJob> ShotPlayer::frame_at(std::int64_t position) {
  const std::optional<std::int64_t> count = session_->frame_count();
  if (count) {
    position = std::clamp(position, std::int64_t{0}, std::max(*count - 1, std::int64_t{0}));
    const std::lock_guard lock(mutex_);
    status_.frame_count = *count;
    status_.damage = session_->damage();
  }
  session_->seek(position);
  std::optional<FrameJob> job = session_->decode();
  if (job) session_->track(*job);
  return job;
}

void ShotPlayer::draw(const FrameWish& wish) {
  const auto start = std::chrono::steady_clock::now();
  const std::set<ChangeCost> costs = costs_of_change(session_->settings(), wish.settings);
  if (costs.contains(ChangeCost::track) || costs.contains(ChangeCost::footage)) tracks_anew_ = true;
  note_redoing(costs);
  const Rung rung = apply(wish);
  std::optional<FrameJob> job = live_ ? live_->next(*session_) : frame_at(wish.position);
  if (!job) return;
  if (std::exchange(tracks_anew_, false)) note_pose_errors();
  auto drawn = std::make_shared<DrawnFrame>();
  drawn->position = live_ ? job->image.number() : wish.position;
  drawn->wish = wish_number_, drawn->rung = rung;
  drawn->number = job->image.number(), drawn->time_s = job->image.time_s();
  drawn->plate = drawn->composite = rgb_of(job->image);
  drawn->truth = truth_of(job->image);
  drawn->image = drawn->composited = job->image;
  drawn->track = job->track;
  drawn->camera = session_->camera();
  drawn->target = session_->settings().tag.target();
  render(*job, drawn);
  note_time(rung);
  drawn->composited = job->image.with_composite(job->result);
  if (!job->result.rect.empty()) drawn->composite = rgb_of(*drawn->composited);
  const BuiltScene& built = session_->renderer().builder().scene();
  const render::ReceiverGrid& grid = built.scene.transfer.grid;
  const glm::vec2 foot_m(built.tag_from_scene.translation_m);
  if (grid.columns >= 2) drawn->receiver = {grid.min_m + foot_m, grid.max_m + foot_m};
  drawn->light = light_maker_.light_of(*job, session_->settings(), session_->renderer().builder());
  if (job->track.found) drawn->light_shares = session_->renderer().plane_shares(*job);
  drawn->pass_times = session_->renderer().pass_times();
  draw_extras(wish.extras, *job, *drawn->image, *drawn);
  drawn->draw_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const double took_s = drawn->draw_ms / 1000;
  publish(std::move(drawn));
  std::vector<PlanEntry> plan = session_->plan();
  const std::lock_guard lock(mutex_);
  status_.plan = std::move(plan);
  if (status_.redoing && rung == Rung::full) status_.took_s[*status_.redoing] = took_s;
}

/// Waits for a wish, or for a file that is saved: the last wish is fulfilled anew then. Where live footage goes on, the last wish
/// is for its next frame. None where the player is to end.
std::optional<FrameWish> ShotPlayer::next_wish(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    changed_ = watch_.take_changed();
    std::unique_lock lock(mutex_);
    const bool goes_on = live_ && live_->goes_on() && wish_number_ != 0;
    if (changed_.empty() && !goes_on) wished_.wait_for(lock, stop, kWatchInterval, [&] { return next_.has_value(); });
    is_repeated_ = !next_ && changed_.empty() && goes_on;
    if (is_repeated_) return wish_;
    if (!next_ && changed_.empty()) continue;
    wish_number_ = next_ ? last_wish_ : ++last_wish_;
    return next_ ? std::exchange(next_, std::nullopt) : wish_;
  }
  return {};
}

/// Live footage is looked for again in a while; where it cannot come again, what was wished for is not left open.
void ShotPlayer::note_lost(const std::string& why, const std::stop_token& stop) {
  constexpr auto kInterval = std::chrono::seconds(1);
  const bool comes_again = !session_ || session_->footage().info().is_live;
  if (comes_again) session_.reset();
  const bool is_looked_for = live_->lose(why, comes_again);
  if (!is_looked_for) finish(wish_number_, why);
  tell_();
  if (!is_looked_for) return;
  std::unique_lock lock(mutex_);
  wished_.wait_for(lock, stop, kInterval, [] { return false; });
}

void ShotPlayer::run(const std::stop_token& stop) {
  while (std::optional<FrameWish> wish = next_wish(stop)) {
    wish_ = std::move(*wish);
    std::optional<std::string> error;
    try {
      see_changes();
      watch_files(wish_.settings);
      if (live_ && session_ && live_->must_reopen(*session_, wish_.settings)) session_.reset();
      if (!session_) open(stop);
      draw(wish_);
      watch_files(wish_.settings);  // now it is known what the models name
    } catch (const GivenUp&) {
      continue;
    } catch (const LostSource& lost) {
      note_lost(lost.why, stop);
      continue;
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    if (!error && !shader_problems_.empty()) error = shader_problems_.front();
    finish(wish_number_, error);
    tell_();
  }
}

}  // namespace catchlight::app
