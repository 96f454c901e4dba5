// An opened shot that can be stepped: footage, track, scene and renderer. Every command that handles frames is written on it.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/media/read/rewindable_source.hpp"
#include "app/session/frame_job.hpp"
#include "app/session/frame_track.hpp"
#include "app/session/recording.hpp"
#include "app/session/report.hpp"
#include "app/session/shot_renderer.hpp"
#include "app/session/solve_shot.hpp"
#include "app/session/track_check.hpp"
#include "app/support/log.hpp"
#include "app/support/progress.hpp"
#include "catchlight/camera.hpp"

namespace catchlight::app {

struct SessionOptions {
  std::string task = "overlay";  ///< what the progress bar calls the work
  FrameRange range = {};
  std::string track_file = {};  ///< poses from there instead of from the pictures
  bool is_causal = false;       ///< track recorded footage as live footage is: each frame knows only those before it
  bool wants_layers = false;    ///< draw layers for compositing packages
  bool wants_frames = false;    ///< render() may write into job.image what else job.result holds
  bool allows_lost = true;      ///< footage in which the tag is never found is not refused, nor a failure
  bool is_revisited = false;    ///< seek() is wanted: frames stay in memory, as far as they fit
  bool keeps_track = false;     ///< track_rows() is wanted: they grow with the footage
  SourceHooks hooks = {};       ///< of the footage
  std::int64_t kept_bytes = kept_frames_budget();  ///< of frames that are kept from tracking, so that they are decoded once
};

/// while (auto job = session.decode()) session.track(*job), session.render(*job), ...
///
/// Recorded footage is tracked as a whole, from its first frame to a second after the range, before the first frame is handed
/// out, so that poses hardly depend on the range; live footage frame by frame. Frames before the range are handed out too
/// (is_before_range), to be tracked and skipped. Once prepared, decode(), track(), render() (or skip()) and measure() may each be
/// called on a thread of its own, a frame by one after the other; see run_stages.hpp. Throws Error as the footage, the camera,
/// the track file and the scene do.
class Session {
 public:
  Session(Recording recording, SessionOptions options, Log& log);

  /// Does at once what otherwise happens when it is first needed: reads the scene's files, tracks recorded footage, and bakes
  /// where there will be something to draw.
  void prepare();

  /// The next frame; none at the end of the range or of the footage, or where the footage is damaged.
  /// Throws where not one frame lies in the range.
  std::optional<FrameJob> decode();

  /// How many frames decode() will give: those that were tracked, where recorded footage is tracked as a whole (it may be shorter
  /// than it says), else what the footage says, if anything.
  std::optional<std::int64_t> frame_count();

  /// decode() goes on at that position among the footage's frames, from 0; where that is beyond the end, there is none. Of
  /// recorded footage, where options.is_revisited. An exposure that adapts has seen all frames before that one then.
  void seek(std::int64_t position);
  void track(FrameJob& job);
  void view(FrameJob& job) { renderer_.view(job); }

  /// A frame may be rendered again, with other settings; it counts once.
  void render(FrameJob& job);

  /// The layers of a frame that render() drew, as compositing packages take them. What is drawn later does not know of it.
  Layers layers(const FrameJob& job) { return renderer_.layers(job); }

  Image light_share(const FrameJob& job, std::optional<std::size_t> light) { return renderer_.light_share(job, light); }

  /// Takes a frame that is not to be drawn: the exposure adapts to it as well.
  void skip(FrameJob& job) { renderer_.skip(job); }

  /// Notes that all is done with a frame: how far live footage is behind. May be called on a thread of its own.
  void finish(const FrameJob& job);

  /// Hands out the track of the whole range without drawing anything. Takes the footage to its end. What can be read only once
  /// is handed out frame by frame.
  void track_range(const std::function<void(const TrackRow&)>& take);
  std::vector<TrackRow> track_range();

  /// Takes new settings for the frames to come, and redoes no more than they ask for. Where the footage itself has to be read
  /// anew (another response), or tracked anew, decode() starts at the first frame again.
  void apply(const SceneSettings& settings, BakeFineness fineness = BakeFineness::full);

  const Recording& recording() const { return recording_; }
  const SceneSettings& settings() const { return recording_.scene; }
  const CameraModel& camera() const { return camera_; }
  const MediaSource& footage() const { return *footage_; }
  const BuiltScene& load_scene() { return renderer_.load(); }
  const ShotRenderer& renderer() const { return renderer_; }

  /// What is to be reported as a failure, though all that could be done is done: damaged footage; a tag that was never found,
  /// where that is not allowed. Known after warn_of_track().
  std::vector<std::string> failures() const;

  /// What to say where the tag is in no frame, as far as that is known.
  const std::optional<std::string>& never_found() const { return never_found_; }

  /// A text on the damage that ended the footage early; empty where none did.
  const std::optional<std::string>& damage() const { return pass_.damage; }

  /// The rows of the range so far, where options.keeps_track.
  const std::vector<TrackRow>& track_rows() const { return pass_.rows; }

  /// The rows of all frames, where they are known beforehand: of recorded footage, and from track files.
  std::vector<TrackRow> known_rows() const { return track_ ? track_->known_rows() : std::vector<TrackRow>{}; }

  /// The choices so far and their reasons; complete after the last frame.
  std::vector<PlanEntry> plan() const;

  /// The report on what was done so far.
  Report report() const;

  /// Warns of what the user should know of the track so far: an exposure that could not be read, frames without the tag.
  void warn_of_track();

  /// As ShotRenderer.
  std::vector<std::string> reload_shaders() { return renderer_.reload_shaders(); }

  /// Runs `work`, e.g. encoding, as a stage of the report.
  template <class Work>
  decltype(auto) measure(const std::string& stage, Work&& work) {
    return pass_.report.stages.measure(stage, std::forward<Work>(work));
  }

 private:
  /// What one pass through the footage has come to so far.
  struct Pass {
    std::int64_t decoded = 0, in_range = 0;
    std::optional<std::int64_t> last_drawn;
    std::optional<std::string> damage;
    std::vector<TrackRow> rows;
    ThinnedSample<TrackRow> typical_rows;  ///< for the plan, as the next two
    std::optional<Frame> last_image;
    TrackRow last_row;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    Report report;
  };

  /// Recorded footage, unless its track is given or is to be made frame by frame.
  bool is_solved_whole() const;
  FrameTrack& opened_track();
  std::unique_ptr<FrameTrack> open_track();
  SolvedShot solve();

  /// Says how large the objects are where the poses are known beforehand, and warns where that is odd.
  void note_scale();

  /// Throws Error with the text where that is not allowed.
  void note_never_found(const std::string& text);
  std::unique_ptr<RewindableSource> open_source(const Recording& recording);
  PlanEntry footage_entry() const;
  std::optional<Frame> next_frame();
  std::string live_state() const;

  Recording recording_;
  SessionOptions options_;
  Log& log_;
  std::unique_ptr<RewindableSource> footage_;
  CameraModel camera_;
  std::unique_ptr<FrameTrack> track_;  ///< null until it is first needed
  ShotRenderer renderer_;
  std::optional<TrackCheck> track_check_;       ///< where there is a track file
  std::optional<std::int64_t> tracked_frames_;  ///< where the footage was tracked as a whole
  std::optional<std::string> never_found_;      ///< what to say where the tag is in no frame
  std::optional<Progress> progress_;
  std::atomic<double> delay_s_ = 0;  ///< from decoding the last frame that is finished to that
  Pass pass_;
};

}  // namespace catchlight::app
