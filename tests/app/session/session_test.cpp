// Sessions on a shipped recording, drawn coarsely: what is tested is what is done again and what is the same, not how it looks.
#include "app/session/session.hpp"

#include <gmock/gmock.h>

#include "tests/app/session/session_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::HasSubstr;
using tests::message_of;

int times_made(const Session& session, ScenePart part) {
  return session.renderer().builder().times_made(part);
}

TEST_F(SessionTest, AFrameIsTheSameHoweverTheSessionCameToIt) {
  const Composite alone = drawn_afresh(recording());
  SessionOptions from_the_start = one_frame();
  from_the_start.range = {};
  Session session(recording(), from_the_start, log_);
  session.prepare();
  Composite last;
  for (int i = 0; i <= kFrame; ++i) last = drawn(session);
  expect_same(last, alone);
}

/// The yaw turns the light, and the receiver's albedo, which the probe shows; what the probe was prefiltered to stays.
TEST_F(SessionTest, YawCostsNoPrefilter) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  session.apply(with({{"probe.yaw_deg", "75"}}).scene);
  expect_same(drawn(session), drawn_afresh(with({{"probe.yaw_deg", "75"}})));
  EXPECT_EQ(times_made(session, ScenePart::probe), 1);
  EXPECT_EQ(times_made(session, ScenePart::mesh), 1);
  EXPECT_EQ(times_made(session, ScenePart::reflections), 1);
  EXPECT_EQ(times_made(session, ScenePart::lights), 1);
}

TEST_F(SessionTest, YawCostsNoBakeWhereTheProbeDoesNotShowTheReceiver) {
  Recording plain = with({{"receiver.plane", "none"}});
  Session session(plain, {.track_file = kRecording + "/poses.csv"}, log_);
  drawn(session);
  set_parameter_from_text(plain.scene, "probe.yaw_deg", "75");
  session.apply(plain.scene);
  drawn(session);
  EXPECT_EQ(times_made(session, ScenePart::transfer), 1);
}

TEST_F(SessionTest, ProbeEvCostsNeitherABakeNorAPrefilter) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  const Recording brighter = with({{"probe.ev", "-1.3"}, {"exposure.mode", "fixed"}});
  session.apply(brighter.scene);
  expect_same(drawn(session), drawn_afresh(brighter));
  for (const ScenePart part : {ScenePart::probe, ScenePart::mesh, ScenePart::receiver_albedo, ScenePart::transfer,
                               ScenePart::reflections, ScenePart::lights})
    EXPECT_EQ(times_made(session, part), 1) << static_cast<int>(part);
}

TEST_F(SessionTest, AChangedPartIsMadeAgainAndNoOther) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  const Recording raised = with({{"object.tag_from_object.translation_m", "0.01,0.02,0.01"}});
  session.apply(raised.scene);
  expect_same(drawn(session), drawn_afresh(raised));
  EXPECT_EQ(times_made(session, ScenePart::mesh), 2);
  EXPECT_EQ(times_made(session, ScenePart::transfer), 2);
  EXPECT_EQ(times_made(session, ScenePart::probe), 1);
  EXPECT_EQ(times_made(session, ScenePart::reflections), 1);
}

TEST_F(SessionTest, WhatSlidesOnTheReceiverTakesItsLightAlong) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  const Recording slid = with({{"object.tag_from_object.translation_m", "0.01,0.02,0"}});
  session.apply(slid.scene);
  expect_same(drawn(session), drawn_afresh(slid));
  EXPECT_EQ(times_made(session, ScenePart::mesh) + times_made(session, ScenePart::transfer), 2);
}

TEST_F(SessionTest, SettingsOfTheViewAndOfThePassesMakeNoPartAnew) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  const Recording changed = with({{"exposure.ev", "1"}, {"glare.threshold", "0.3"}, {"lens.noise", "false"}});
  session.apply(changed.scene);
  expect_same(drawn(session), drawn_afresh(changed));
  EXPECT_EQ(times_made(session, ScenePart::mesh) + times_made(session, ScenePart::transfer), 2);
}

TEST_F(SessionTest, AnotherTrackStartsTheFootageAgain) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  for (int i = 0; i < kFrame; ++i) drawn(session);
  session.apply(with({{"tag.white_albedo", "0.5"}}).scene);
  EXPECT_EQ(session.decode().value().image.number(), 0);
}

TEST_F(SessionTest, FootageThatStartsAgainIsCountedAnewAndDrawnTheSame) {
  const Recording adapting = with({{"exposure.mode", "auto"}});
  Session session(adapting, {.track_file = kRecording + "/poses.csv", .keeps_track = true}, log_);
  const Composite first = drawn(session);
  drawn(session);
  session.apply(with({{"exposure.mode", "auto"}, {"tag.white_albedo", "0.5"}}).scene);
  session.apply(adapting.scene);
  expect_same(drawn(session), first);
  EXPECT_EQ(session.report().frames, 1);
  EXPECT_EQ(session.track_rows().size(), 1u);
}

/// A frame that is looked at is the shot's, whatever was looked at before, and under which settings.
TEST_F(SessionTest, AnExposureThatAdaptsHasSeenAllFramesBeforeTheOneThatIsSought) {
  const Recording bright = with({{"exposure.mode", "auto"}, {"exposure.ev", "3"}}),
                  dark = with({{"exposure.mode", "auto"}, {"exposure.ev", "-3"}, {"exposure.key", "0.5"}});
  const auto third = [&](const Recording& shot) {
    Session session(shot, {}, log_);
    drawn(session), drawn(session);
    return drawn(session);
  };
  Session session(bright, {.is_revisited = true}, log_);
  const auto sought = [&](std::int64_t position) {
    session.seek(position);
    return drawn(session);
  };
  sought(5);
  expect_same(sought(2), third(bright));
  session.apply(dark.scene);
  sought(0);
  expect_same(sought(2), third(dark));
}

TEST_F(SessionTest, AFrameFromBeforeNewSettingsIsTrackedByThem) {
  Session session(recording(), {.track_file = kRecording + "/poses.csv"}, log_);
  FrameJob job = session.decode().value();
  session.apply(with({{"tag.white_albedo", "0.5"}}).scene);
  session.track(job);
  EXPECT_TRUE(job.track.found);
}

TEST_F(SessionTest, SettingsThatCannotBeAppliedLeaveTheSessionAsItWas) {
  Session session(recording(), one_frame(), log_);
  const Recording broken = with({{"exposure.response", cache_->path("none.cube")}});
  EXPECT_THAT(message_of<Error>([&] { session.apply(broken.scene); }), HasSubstr("none.cube"));
  EXPECT_EQ(session.settings().exposure.response, recording().scene.exposure.response);
  expect_same(drawn(session), drawn_afresh(recording()));
}

TEST_F(SessionTest, AFrameThatIsDrawnAgainCountsOnce) {
  Session session(with({{"glare.threshold", "0.05"}}), one_frame(), log_);
  FrameJob job = next_in_range(session);
  session.render(job);
  const Composite first = job.result;
  session.render(job);
  expect_same(job.result, first);
  EXPECT_TRUE(first.glare_drawn);
  EXPECT_EQ(session.report().glare_frames, 1);
}

/// The reference sees a frame as the overlay does: where its object changes nothing it is the plate, and the view is the same.
TEST_F(SessionTest, TheReferenceSeesTheFrameThatIsDrawn) {
  for (const char* mode : {"match", "fixed", "auto"}) {
    Session drawing(with({{"exposure.mode", mode}}), one_frame(), log_),
        tracing(with({{"exposure.mode", mode}}), one_frame(), log_);
    FrameJob overlaid = next_in_range(drawing), traced = next_in_range(tracing);
    drawing.render(overlaid);
    tracing.view(traced);
    EXPECT_EQ(overlaid.view.exposure, traced.view.exposure) << mode;
    EXPECT_EQ(overlaid.view.black, traced.view.black) << mode;
    EXPECT_EQ(overlaid.view.camera_from_tag.translation_m, traced.view.camera_from_tag.translation_m) << mode;
    EXPECT_EQ(overlaid.view.tag_from_light, traced.view.tag_from_light) << mode;
  }
}

TEST_F(SessionTest, RowsAreKeptWhereTheyAreWantedAlone) {
  SessionOptions options = one_frame();
  options.range = {0, 3};
  for (const bool wanted : {true, false}) {
    options.keeps_track = wanted;
    Session session(recording(), options, log_);
    while (std::optional<FrameJob> job = session.decode()) session.track(*job);
    EXPECT_EQ(session.track_rows().size(), wanted ? 3u : 0u);
    EXPECT_EQ(session.report().frames, 3);
  }
}

/// Frames a second count all the time that the frames took: tracking the shot, too. Its decoding is a stage of its own.
TEST_F(SessionTest, FramesASecondCoverTheTrackingPass) {
  Session session(recording(), {.range = {0, 3}}, log_);
  while (std::optional<FrameJob> job = session.decode()) session.track(*job);
  const Report report = session.report();
  double tracking_ms = 0;
  std::vector<std::string> names;
  for (const StageTimer::Summary& stage : report.stages.summaries()) {
    names.push_back(stage.stage);
    if (stage.stage == "track") tracking_ms = stage.median_ms;
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"track decode", "track", "solve", "decode"}));
  // Half of the frames took the median or longer.
  EXPECT_GE(1000 * static_cast<double>(report.frames) / report.fps, tracking_ms * static_cast<double>(report.frames) / 2);
}

/// Frames before the range are looked at, but they are not what was asked for.
TEST_F(SessionTest, ProgressCountsTheFramesOfTheRange) {
  SessionOptions options = one_frame();
  options.range = {kFrame, kFrame + 2};
  log_.set_quiet(false);
  ::testing::internal::CaptureStderr();
  {
    Session session(recording(), options, log_);
    while (std::optional<FrameJob> job = session.decode()) session.track(*job);
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, HasSubstr("1/2 frames\n"));
  EXPECT_THAT(text, HasSubstr("2/2 frames\n"));
}

TEST_F(SessionTest, ARangeBesideTheFootageIsRefusedAtOnce) {
  const auto opened = [&](FrameRange range) { return [this, range] { Session(recording(), {.range = range}, log_); }; };
  EXPECT_THAT(message_of<Error>(opened({99, 100})), HasSubstr("there is no frame 99; it has 36 from 0"));
  EXPECT_THAT(message_of<Error>(opened({40, 90})), HasSubstr("it has 36 from 0"));
}

TEST_F(SessionTest, MissingFilesOfTheSceneAreNoticedBeforeTracking) {
  Recording broken = recording();
  broken.scene.objects.front().mesh = cache_->path("none.glb");
  Session session(broken, {}, log_);
  EXPECT_THAT(message_of<Error>([&] { session.prepare(); }), HasSubstr("none.glb"));
  EXPECT_TRUE(session.report().stages.summaries().empty()) << "something was done before";
}

}  // namespace
}  // namespace catchlight::app::testing
