// How fast the window of `tune` answers: `window_cost FOLDER...` prints "FOLDER WHAT FIGURE". The window is drawn into memory
// sixty times a second, as on a screen, while its player works on the other threads; a frame's time ends when it is drawn.
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>
#include <utility>
#include <vector>

#include "app/window/tune_window.hpp"

namespace {

using namespace catchlight::app;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A window that a person looks at: one frame each sixtieth of a second, or as soon after that as it can.
class WatchedWindow {
 public:
  WatchedWindow(GuiSurface& surface, std::string folder)
      : surface_(surface), folder_(std::move(folder)), window_(surface, {folder_, {}}, {}) {}

  void frame() {
    const auto start = Clock::now();
    if (script_ && !script_->is_done()) script_->before_frame(window_);
    window_.frame();
    glFinish();
    frames_ms_.push_back(1e3 * seconds_since(start));
    std::this_thread::sleep_until(start + std::chrono::duration<double>(1.0 / 60));
  }

  void begin(std::vector<ScriptCommand> commands) { script_.emplace(folder_, std::move(commands)); }
  bool is_busy() const { return (script_ && !script_->is_done()) || !window_.is_idle(); }
  /// As a window does that nobody touches: it is drawn when there is something new.
  void finish() {
    frame();
    while (is_busy()) surface_.rest(window_.rest_s()), frame();
  }
  TuneWindow& window() { return window_; }

  void print(const std::string& what, double figure) const {
    std::printf("%s\t%s\t%.2f\n", folder_.c_str(), what.c_str(), figure);
    std::fflush(stdout);
  }

  /// Median, 95th hundredth and longest of the window's frames since the last call.
  void print_frames(const std::string& what) {
    std::ranges::sort(frames_ms_);
    for (const auto& [name, share] : {std::pair{"median", 0.5}, {"95 %", 0.95}, {"worst", 1.0}})
      print(what + ", " + name + " (ms)",
            frames_ms_[static_cast<std::size_t>(share * static_cast<double>(frames_ms_.size() - 1))]);
    frames_ms_.clear();
  }

 private:
  GuiSurface& surface_;
  std::string folder_;
  TuneWindow window_;
  std::optional<UiScript> script_;
  std::vector<double> frames_ms_;
};

void measure_playing(WatchedWindow& watched) {
  constexpr double kPlayed_s = 5;
  watched.begin({{1, "click", {"play"}}});
  for (int i = 0; i < 60; ++i) watched.frame();  // the rung is found
  watched.print_frames("while it starts to play");
  const auto start = Clock::now();
  int shown = 0;
  std::uint64_t last = 0;
  while (seconds_since(start) < kPlayed_s) {
    watched.frame();
    const auto& frame = watched.window().shown();
    if (frame && std::exchange(last, frame->wish) != frame->wish) ++shown;
  }
  watched.print("frames shown a second while it plays", shown / seconds_since(start));
  watched.print("rung while it plays", static_cast<double>(watched.window().shown()->rung));
  watched.print_frames("while it plays");
  watched.begin({{1, "click", {"play"}}});
  watched.finish();
}

void measure_drags(WatchedWindow& watched) {
  watched.begin({{1, "click", {"search"}}, {2, "type", {"probe.yaw_deg"}}, {3, "click", {"picture"}}});
  watched.finish();
  watched.print_frames("while it rests");
  std::vector<ScriptCommand> drags;
  for (int i = 0; i < 8; ++i) drags.push_back({i, "drag", {"probe.yaw_deg", i % 2 ? "0.7" : "0.5", i % 2 ? "0.5" : "0.7"}});
  watched.begin(drags);
  while (watched.is_busy()) watched.frame();
  watched.print_frames("while a slider is dragged");
  for (ScriptCommand& drag : drags) drag.words = {"picture", drag.line % 2 ? "0.6" : "0.5", drag.line % 2 ? "0.5" : "0.6"};
  watched.begin(drags);
  while (watched.is_busy()) watched.frame();
  watched.print_frames("while the object is dragged");
}

/// From a change to its picture in full quality.
void measure_stills(WatchedWindow& watched) {
  constexpr int kStills = 12;
  const auto measure = [&](const std::string& what, auto change) {
    std::vector<double> took_ms;
    for (int i = 0; i < kStills; ++i) {
      const auto start = Clock::now();
      change(i);
      watched.finish();
      took_ms.push_back(1e3 * seconds_since(start));
    }
    std::ranges::sort(took_ms);
    watched.print(what + ", median (ms)", took_ms[kStills / 2]);
    watched.print(what + ", worst (ms)", took_ms.back());
  };
  measure("still, full quality, other frame", [&](int i) { watched.window().seek(3 * i % 24); });
  measure("still, full quality, exposure.ev", [&](int i) { watched.window().set("exposure.ev", std::to_string(i % 2)); });
  measure("still, full quality, probe.yaw_deg", [&](int i) { watched.window().set("probe.yaw_deg", std::to_string(5 * i)); });
}

void measure(const std::string& folder) {
  const std::unique_ptr<GuiSurface> surface = make_headless_surface({1280, 720}, 1);
  WatchedWindow watched(*surface, folder);
  watched.finish();
  watched.print_frames("while it opens and bakes");
  measure_playing(watched);
  measure_stills(watched);
  measure_drags(watched);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    for (int i = 1; i < count; ++i) measure(arguments[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "window_cost: %s\n", error.what());
    return 1;
  }
  return 0;
}
