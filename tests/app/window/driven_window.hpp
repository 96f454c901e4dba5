// The window in this process, without a screen, on a recording that is small and has something of everything.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/window/tune_window.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::app::testing {

/// Makes a recording in the folder: six frames of 320 x 240 pixels with grain and out of focus, by a lens that bends and darkens;
/// on the tag a ball of rough metal under the sun, and a lamp; a board's further tag, which is never in sight. Little is spent on
/// it.
void make_small_recording(const tests::TemporaryFolder& folder);

/// A window that does what scripts say.
class DrivenWindow {
 public:
  explicit DrivenWindow(const std::string& recording, const RecordingOverrides& overrides = {});

  /// Until the last line is done. Throws Error as the script does.
  void run(const std::string& script);
  /// Draws so many frames.
  void draw(int frames);

  TuneWindow& window() { return *window_; }
  /// What is seen when all that was asked for is.
  std::vector<unsigned char> picture();
  int frames_drawn() const { return frames_; }

 private:
  void frame();

  tests::TemporaryFolder scripts_;
  std::unique_ptr<GuiSurface> surface_;
  std::unique_ptr<TuneWindow> window_;
  int frames_ = 0;
};

/// Windows on one small recording, with a cache of their own.
class WindowTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string path(const std::string& name) { return folder_->path("recording/" + name); }

  static inline std::unique_ptr<tests::TemporaryFolder> folder_;
};

}  // namespace catchlight::app::testing
