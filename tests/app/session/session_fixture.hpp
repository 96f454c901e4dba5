// Sessions on a shipped recording, drawn coarsely.
#pragma once

#include <gmock/gmock.h>

#include <cstdlib>
#include <memory>

#include "app/session/session.hpp"
#include "app/settings/parameters.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::app::testing {

inline const std::string kRecording = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
constexpr int kFrame = 2;

class SessionTest : public ::testing::Test {
 protected:
  SessionTest() { log_.set_quiet(true); }

  /// One cache for all: what one test has baked the next need not.
  static void SetUpTestSuite() {
    cache_ = std::make_unique<tests::TemporaryFolder>();
    setenv("XDG_CACHE_HOME", cache_->path().c_str(), 1);
  }
  static void TearDownTestSuite() { cache_.reset(); }

  /// matte with an object of few rays and bands.
  static Recording recording() {
    RecordingOverrides overrides;
    overrides.parameters = {{"quality.bands", "3"},         {"quality.rays", "32"},           {"quality.bounces", "0"},
                            {"quality.light_samples", "8"}, {"quality.reflection_rays", "0"}, {"quality.receiver_points", "12"},
                            {"quality.samples", "1"}};
    return open_recording(kRecording, overrides);
  }

  /// Frame kFrame alone, at its known pose: tracking has tests of its own.
  static SessionOptions one_frame() {
    return {.range = {kFrame, kFrame + 1}, .track_file = kRecording + "/poses.csv", .keeps_track = true};
  }

  static Recording with(std::vector<std::pair<std::string, std::string>> parameters) {
    Recording changed = recording();
    for (const auto& [key, text] : parameters) set_parameter_from_text(changed.scene, key, text);
    return changed;
  }

  static FrameJob next_in_range(Session& session) {
    while (std::optional<FrameJob> job = session.decode()) {
      session.track(*job);
      if (!job->is_before_range) return std::move(*job);
      session.skip(*job);
    }
    throw Error("the footage ended");
  }

  static Composite drawn(Session& session) {
    FrameJob job = next_in_range(session);
    session.render(job);
    return job.result;
  }

  /// The frame as the commands draw it: by a session of its own.
  Composite drawn_afresh(Recording recording) {
    Session session(std::move(recording), one_frame(), log_);
    return drawn(session);
  }

  static inline std::unique_ptr<tests::TemporaryFolder> cache_;
  Log log_;
};

inline void expect_same(const Composite& a, const Composite& b) {
  EXPECT_EQ(a.rect, b.rect);
  EXPECT_EQ(a.rgba, b.rgba);
  EXPECT_FALSE(a.rect.empty()) << "nothing was drawn";
}

}  // namespace catchlight::app::testing
