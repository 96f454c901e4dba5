// Draws the frames of a shot that a person looks at, on a thread of its own: the newest wish counts.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "app/session/corner_residuals.hpp"
#include "app/session/plan.hpp"
#include "app/session/recording.hpp"
#include "app/settings/parameter_kinds.hpp"
#include "app/support/log.hpp"
#include "app/window/playing/file_watch.hpp"
#include "app/window/playing/frame_extras.hpp"
#include "app/window/playing/frame_light.hpp"
#include "app/window/playing/layer_picture.hpp"
#include "app/window/playing/live_feed.hpp"
#include "app/window/playing/pose_errors.hpp"
#include "app/window/surface/rgb_picture.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "render/pass_time.hpp"
#include "render/transfer/plane_rect.hpp"

namespace catchlight::app {

struct FrameJob;
class Session;

/// How well a frame is drawn.
enum class Rung {
  full,   ///< as `overlay` draws it
  quick,  ///< with fewer rays and samples, where full quality could not follow what moves
  rough   ///< from a rough bake, while something moves that bakes are made from
};
constexpr auto names_of(Rung) {
  return std::array{"full quality", "fewer rays and samples while it moves", "roughly baked while it moves"};
}

/// A frame that somebody wants to see.
struct FrameWish {
  SceneSettings settings;
  std::int64_t position = 0;  ///< among the shot's frames, from 0
  bool moves = false;         ///< a hand or the footage: a lower rung will do where full quality would not be smooth
  FrameExtras extras = {};
};

/// One frame as it was drawn.
struct DrawnFrame {
  std::int64_t position = 0;  ///< among the shot's frames, from 0
  std::int64_t number = 0;    ///< the frame's own
  double time_s = 0;
  Rung rung = Rung::full;
  std::uint64_t wish = 0;  ///< the wish that it fulfils; 0: the footage alone, before anything could be drawn
  RgbPicture plate;
  RgbPicture composite;                       ///< as `overlay` writes it
  RgbPicture truth;                           ///< empty where the recording has none for the frame
  std::optional<Frame> image, composited;     ///< what both were made of
  std::optional<LayerPicture> layer;          ///< where one was asked for
  std::vector<double> light_shares;           ///< of the light on the receiver that each of the probe's lights gives
  std::optional<FrameMasks> masks;            ///< as `layer`
  std::vector<CornerResiduals> corners;       ///< as `layer`; of tags that the frame shows
  std::optional<render::PlaneRect> receiver;  ///< where the receiver's shadow is known; none: there is no receiver
  TagTarget target;
  TrackRow track;
  CameraModel camera;
  FrameLight light;
  std::vector<render::PassTime> pass_times;
  double draw_ms = 0;  ///< by the clock
};

/// What the player is at.
struct PlayerStatus {
  std::string stage;  ///< "track", "bake", ...; empty: nothing but frames
  double share = 0;   ///< of that stage
  std::optional<std::string> error;
  std::vector<std::string> warnings;
  std::int64_t frame_count = 0;  ///< 0 while it is not known
  double frame_rate = 24;
  std::vector<PlanEntry> plan;
  std::optional<std::string> damage;                          ///< why the footage ends early, where it does
  std::optional<ChangeCost> redoing;                          ///< the dearest part of what is being redone
  std::map<ChangeCost, double> took_s;                        ///< from the last change of that cost to its picture
  std::shared_ptr<const std::vector<PoseError>> pose_errors;  ///< of all frames, once the shot is tracked
};

/// Recorded footage is drawn a frame for each wish. Of what can be read only once (cameras, streams, stdin) one frame after the
/// other is drawn by the last wish; its position means nothing then.
///
/// Where a file that is drawn from was saved anew, or a shader of --shader-dir, what was wished for last is drawn again.
class ShotPlayer {
 public:
  /// Opens the recording on the player's thread. Until the shot is tracked and baked, its frames are shown as they are read.
  /// An error becomes part of the status. `tell` is called on any thread when there is something new to show.
  explicit ShotPlayer(
      Recording recording, std::function<void()> tell = [] {});
  /// Gives up what is going on: tracking and a bake end at their next step.
  ~ShotPlayer();
  ShotPlayer(const ShotPlayer&) = delete;
  ShotPlayer& operator=(const ShotPlayer&) = delete;

  /// Asks for a frame. What was asked for before and has not begun is left out. The number of the wish.
  std::uint64_t ask(FrameWish wish);

  /// How live footage comes in; null for recorded footage.
  LiveFeed* live() const { return live_.get(); }

  /// The newest frame drawn; null before the first.
  std::shared_ptr<const DrawnFrame> newest() const;

  PlayerStatus status() const;

  /// Whether the last wish is fulfilled, or has failed.
  bool is_idle() const;

 private:
  void run(const std::stop_token& stop);
  void open(const std::stop_token& stop);
  std::optional<FrameWish> next_wish(const std::stop_token& stop);
  std::optional<FrameJob> frame_at(std::int64_t position);
  void note_lost(const std::string& why, const std::stop_token& stop);
  void see_changes();
  void watch_files(const SceneSettings& settings);
  bool asks_otherwise(const FrameWish& wish) const;
  Rung apply(const FrameWish& wish);
  void draw(const FrameWish& wish);
  void render(FrameJob& job, const std::shared_ptr<DrawnFrame>& drawn);
  void note_time(Rung rung);
  void draw_extras(const FrameExtras& extras, const FrameJob& job, const Frame& plate, DrawnFrame& drawn);
  RgbPicture truth_of(const Frame& frame) const;
  void see_decoded(const Frame& frame);
  void note_pose_errors();
  void note_redoing(const std::set<ChangeCost>& costs);
  void publish(std::shared_ptr<const DrawnFrame> frame);
  void finish(std::uint64_t wish, const std::optional<std::string>& error);

  Recording recording_;
  std::function<void()> tell_;
  std::unique_ptr<LiveFeed> live_;
  Log log_;
  std::chrono::steady_clock::time_point previewed_;  ///< the thread's that decodes
  // The player thread's.
  std::unique_ptr<Session> session_;
  FrameLightMaker light_maker_;
  bool tracks_anew_ = true;   ///< since the pose errors were noted
  bool is_repeated_ = false;  ///< wish_ is fulfilled once more, by the next frame of live footage
  FrameWish wish_;            ///< the last one
  std::uint64_t wish_number_ = 0;
  bool is_rough_ = false;  ///< the session's bake
  int drawn_version_ = 0;  ///< of the scene that was drawn last
  double full_ms_ = 0;     ///< what a frame of full quality takes to draw once its scene is built
  FileWatch watch_;
  std::set<std::string> changed_;  ///< files, since the last wish
  std::vector<std::string> shader_problems_;
  mutable std::mutex mutex_;  ///< of all that follows
  std::condition_variable_any wished_;
  std::optional<FrameWish> next_;
  std::uint64_t last_wish_ = 0, finished_ = 0;
  std::shared_ptr<const DrawnFrame> newest_;
  PlayerStatus status_;
  std::jthread thread_;
};

}  // namespace catchlight::app
