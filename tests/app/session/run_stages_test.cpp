// A shot with several frames on their way at once comes to what one frame after the other comes to.
#include "app/session/run_stages.hpp"

#include <filesystem>
#include <thread>

#include "tests/app/session/session_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;

/// What came of a shot.
struct Result {
  std::vector<std::int64_t> numbers;
  std::vector<Composite> composites;
  std::vector<TrackRow> rows;
  Report report;
};

class StagesTest : public SessionTest {
 protected:
  /// A few frames that adapt to the ones before them, from the second frame on.
  static Recording adapting() { return with({{"exposure.mode", "auto"}}); }
  static SessionOptions options() { return {.range = {1, 5}, .track_file = kRecording + "/poses.csv", .keeps_track = true}; }

  static void add(Result& result, const FrameJob& job) {
    result.numbers.push_back(job.image.number());
    result.composites.push_back(job.result);
  }

  Result on_one_thread(Recording recording, SessionOptions options) {
    Session session(std::move(recording), std::move(options), log_);
    Result result;
    while (std::optional<FrameJob> job = session.decode()) {
      session.track(*job);
      if (job->is_before_range) {
        session.skip(*job);
        continue;
      }
      session.render(*job);
      add(result, *job);
    }
    result.rows = session.track_rows();
    result.report = session.report();
    return result;
  }

  Result on_many(Recording recording, SessionOptions options, std::size_t queue_length) {
    Session session(std::move(recording), std::move(options), log_);
    Result result;
    run_stages(session, [&](const FrameJob& job) { add(result, job); }, {.queue_length = queue_length});
    result.rows = session.track_rows();
    result.report = session.report();
    return result;
  }
};

void expect_same_shot(const Result& a, const Result& b) {
  EXPECT_EQ(a.numbers, b.numbers);
  ASSERT_EQ(a.composites.size(), b.composites.size());
  for (std::size_t i = 0; i < a.composites.size(); ++i) expect_same(a.composites[i], b.composites[i]);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].camera_from_tag.translation_m, b.rows[i].camera_from_tag.translation_m);
    EXPECT_EQ(a.rows[i].exposure, b.rows[i].exposure);
  }
  EXPECT_EQ(a.report.frames, b.report.frames);
  EXPECT_EQ(a.report.glare_frames, b.report.glare_frames);
}

TEST_F(StagesTest, FramesAreTheSameAsOneAfterTheOther) {
  const Result wanted = on_one_thread(adapting(), options());
  EXPECT_EQ(wanted.numbers, (std::vector<std::int64_t>{1, 2, 3, 4}));
  for (const std::size_t length : {1, 2, 4}) expect_same_shot(on_many(adapting(), options(), length), wanted);
}

TEST_F(StagesTest, CausallyTrackedFramesAreTheSameToo) {
  SessionOptions causal = options();
  causal.track_file.clear();
  causal.is_causal = true;
  expect_same_shot(on_many(recording(), causal, 2), on_one_thread(recording(), causal));
}

/// An address is taken for live footage: none of its frames is left out.
TEST_F(StagesTest, LiveFootageIsDrawnWhole) {
  Recording live = recording();
  live.footage = "file://" + std::filesystem::absolute(live.footage).string();
  const Result result = on_many(live, {.range = {0, 4}}, 4);
  EXPECT_EQ(result.numbers, (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(result.report.tracked_frames, 4);
}

TEST_F(StagesTest, FramesThatAreNotWantedAreSkippedInTheirPlace) {
  const auto drawn_last = [&](const std::function<bool(const FrameJob&)>& wants) {
    Session session(adapting(), options(), log_);
    Composite last;
    run_stages(session, [&](FrameJob& job) { last = job.result; }, {.wants = wants});
    return last;
  };
  // The exposure adapts to skipped frames as to drawn ones.
  expect_same(drawn_last([](const FrameJob& job) { return job.image.number() == 4; }),
              drawn_last([](const FrameJob&) { return true; }));
}

TEST_F(StagesTest, WhatFailsInAnyStepFailsTheShot) {
  int written = 0;
  const auto run = [&](const std::string& track, const StageOptions& stages, int fails_at) {
    written = 0;
    SessionOptions shot = options();
    shot.track_file = track;
    Session session(recording(), shot, log_);
    run_stages(
        session,
        [&](const FrameJob& job) {
          if (job.image.number() == fails_at) throw Error("the disk is full");
          ++written;
        },
        stages);
  };
  const std::string poses = kRecording + "/poses.csv";
  EXPECT_EQ(message_of<Error>([&] { run(poses, {}, 3); }), "the disk is full");
  EXPECT_EQ(written, 2);
  const StageOptions cannot_draw{.wants = [](const FrameJob& job) -> bool {
    if (job.image.number() == 3) throw Error("cannot be drawn");
    return true;
  }};
  EXPECT_EQ(message_of<Error>([&] { run(poses, cannot_draw, 99); }), "cannot be drawn");
  EXPECT_EQ(written, 2);
  // The frame that fails first is the earlier one, though it fails in a later step.
  EXPECT_EQ(message_of<Error>([&] { run(poses, cannot_draw, 2); }), "the disk is full");
  EXPECT_THAT(message_of<Error>([&] { run(cache_->path("none.csv"), {}, 99); }), HasSubstr("none.csv"));
}

TEST_F(StagesTest, DrawingIsDoneOnTheCallingThreadAndWritingIsNot) {
  Session session(recording(), options(), log_);
  std::thread::id drawing, writing;
  run_stages(session, [&](const FrameJob&) { writing = std::this_thread::get_id(); },
             {.wants = [&](const FrameJob&) { return drawing = std::this_thread::get_id(), true; }});
  EXPECT_EQ(drawing, std::this_thread::get_id());
  EXPECT_NE(writing, drawing);
}

// --- footage that is tracked as a whole -------------------------------------------------------------------------------

std::string footage_choice(const Report& report) {
  for (const PlanEntry& entry : report.plan)
    if (entry.choice == "footage") return entry.value + ": " + entry.reason;
  return "";
}

TEST_F(StagesTest, FramesThatAreKeptFromTrackingAreTheSameAsDecodedOnesAndTheReportSaysWhich) {
  const SessionOptions kept{.range = {2, 5}, .keeps_track = true};
  SessionOptions not_kept = kept;
  not_kept.kept_bytes = 1'000'000;
  const Result once = on_many(recording(), kept, 2), twice = on_many(recording(), not_kept, 2);
  expect_same_shot(once, twice);
  EXPECT_THAT(footage_choice(once.report), HasSubstr("decoded once: tracking leaves its frames in memory"));
  EXPECT_THAT(footage_choice(twice.report), HasSubstr("decoded twice: "));
}

TEST_F(StagesTest, DamageEndsKeptFramesWhereItEndsDecodedOnes) {
  Recording damaged = recording();
  damaged.footage = cache_->path("damaged.mkv");
  ASSERT_EQ(std::system(("ffmpeg -v error -nostdin -y -i " + kRecording + "/video.mp4 -c copy " + damaged.footage).c_str()), 0);
  std::filesystem::resize_file(damaged.footage, std::filesystem::file_size(damaged.footage) / 8);
  std::vector<std::string> damages;
  std::vector<std::vector<std::int64_t>> numbers(2);
  for (const bool keeps : {true, false}) {
    Session session(damaged, {.kept_bytes = keeps ? kept_frames_budget() : 0}, log_);
    run_stages(session, [&](const FrameJob& job) { numbers[keeps].push_back(job.image.number()); });
    ASSERT_TRUE(session.damage());
    damages.push_back(*session.damage());
  }
  EXPECT_EQ(damages[0], damages[1]);
  EXPECT_EQ(numbers[0], numbers[1]);
  EXPECT_THAT(numbers[0], ::testing::Not(IsEmpty()));
}

TEST_F(StagesTest, NothingIsBuiltForAShotWithoutAnythingVirtualInSight) {
  Session session(with({{"tag.id", "17"}}), {.range = {0, 3}}, log_);
  int frames = 0;
  run_stages(session, [&](const FrameJob& job) {
    EXPECT_TRUE(job.result.rect.empty());
    ++frames;
  });
  EXPECT_EQ(frames, 3);
  EXPECT_EQ(session.renderer().builder().times_made(ScenePart::transfer), 0);
  EXPECT_THAT(footage_choice(session.report()), HasSubstr("decoded once"));
}

}  // namespace
}  // namespace catchlight::app::testing
