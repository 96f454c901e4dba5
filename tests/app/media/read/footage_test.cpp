// Real footage by others, where somebody has put it: no false alarms, nothing lost. It is no part of the repository.
#include <cstdlib>

#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

std::filesystem::path footage_folder() {
  if (const char* folder = std::getenv("CATCHLIGHT_FOOTAGE")) return folder;
  return std::filesystem::path(CATCHLIGHT_SOURCE_DIR) / "../shared/footage";
}

class Footage : public MediaTest, public ::testing::WithParamInterface<std::pair<const char*, int>> {};

TEST_P(Footage, IsReadWholeAndItsTimesSurvive) {
  const auto [name, frame_count] = GetParam();
  const std::string clip = (footage_folder() / "clips" / name).string();
  if (!std::filesystem::exists(clip)) GTEST_SKIP() << "no " << clip;
  const auto source = MediaSource::open(clip);
  EXPECT_EQ(source->info().frame_count, frame_count);
  std::vector<double> times;
  SinkOptions quick;
  quick.preset = "ultrafast";
  const auto sink = MediaSink::open(path("out.mp4"), clip, *source, quick);
  while (auto frame = source->read()) {
    times.push_back(frame->time_s());
    sink->write(*frame);
  }
  sink->finish();
  EXPECT_EQ(static_cast<int>(times.size()), frame_count);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  const auto again = MediaSource::open(path("out.mp4"));
  for (const double time_s : times) ASSERT_EQ(again->read()->time_s(), time_s);
  EXPECT_FALSE(again->read());
}

INSTANTIATE_TEST_SUITE_P(Clips, Footage,
                         ::testing::Values(std::pair("desk_orbit.mp4", 93), std::pair("whiteboard.mp4", 516),
                                           std::pair("monitor_same_id_twice.mp4", 148), std::pair("room_stills.mp4", 72)),
                         [](const auto& test) { return std::filesystem::path(test.param.first).stem().string(); });

}  // namespace
}  // namespace catchlight::app::testing
