// Thousands of frames of the window with changes of all kinds: memory stays as it was.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/app/window/driven_window.hpp"

namespace catchlight::app::testing {
namespace {

/// Resident memory of this process.
double resident_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (double kilobytes = 0; word == "VmRSS:" && status >> kilobytes) return kilobytes / 1024;
  ADD_FAILURE() << "/proc/self/status names no VmRSS";
  return 0;
}

/// A round of what people do, whose end is as its beginning: scrub, set, drag, undo, every view.
std::string round_of_changes(int number) {
  std::ostringstream script;
  script << "drag picture 0.5 0.55\nclick undo\n";
  for (const char* view : {"plate", "split", "flicker", "difference", "zones", "composite"})
    script << "click view\nclick view " << view << '\n';
  for (int change = 0; change < 4; ++change)
    script << "seek " << (number + change) % 6 << "\nset exposure.ev 0.0" << 1 + change << "\nset glare.bloom_strength 0."
           << 1 + change << "\nclick undo\nclick undo\n";
  script << "drag timeline 0.1 0.9\ndrag exposure.ev 0.4 0.6\nclick undo\nset probe.yaw_deg " << number % 7 + 1
         << "\nwait\nclick undo\nclick play\nclick play\nwait\n";
  return script.str();
}

using WindowMemory = WindowTest;

/// What malloc keeps in its arenas goes up and down by some megabytes. One picture of 225 kB kept for each frame of the window
/// would be hundreds of them, and one for each frame that the player draws about fifty.
TEST_F(WindowMemory, StaysFlat) {
  constexpr int kRounds = 11;
  constexpr double kMaxGrowth_mb = 12;
  DrivenWindow driven(path(""));
  driven.run("wait\nclick search\ntype exposure.ev\nwait\n");
  for (int number = 0; number < 3; ++number) driven.run(round_of_changes(number));
  const int frames_before = driven.frames_drawn();
  const double before_mb = resident_mb();
  for (int number = 0; number < kRounds; ++number) driven.run(round_of_changes(number));
  EXPECT_GT(driven.frames_drawn() - frames_before, 1800);
  EXPECT_LT(resident_mb() - before_mb, kMaxGrowth_mb) << "it was " << before_mb << " MB after " << frames_before << " frames";
}

}  // namespace
}  // namespace catchlight::app::testing
