// `catchlight tune`: the footage with its objects, and everything that can be turned.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/session/recording.hpp"
#include "app/window/editing/settings_history.hpp"
#include "app/window/panels/light_panel.hpp"
#include "app/window/panels/live_panel.hpp"
#include "app/window/panels/panels.hpp"
#include "app/window/panels/parameter_controls.hpp"
#include "app/window/panels/render_panel.hpp"
#include "app/window/panels/save_as.hpp"
#include "app/window/picture/picture_hands.hpp"
#include "app/window/picture/picture_view.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/playing/transport.hpp"
#include "app/window/start/opening_screen.hpp"
#include "app/window/start/tune_state.hpp"
#include "app/window/surface/gui_items.hpp"
#include "app/window/surface/gui_pace.hpp"
#include "app/window/surface/gui_surface.hpp"
#include "app/window/surface/window_layout.hpp"
#include "app/window/ui_script.hpp"

namespace catchlight::app {

class TuneWindow final : public ScriptTarget {
 public:
  /// Keeps a reference. `wanted` without a location: a window that says what can be opened.
  TuneWindow(GuiSurface& surface, const OpenedRecording& wanted, TuneState state);

  /// What is to be remembered, as it is now.
  TuneState state() const;

  /// One frame of the window. Never waits for what the player does.
  void frame();

  /// Whether the window may go: it was closed, and what would be lost was asked about.
  bool is_done() const { return is_done_; }

  /// How long the window need not be drawn again, but for input and news of the player, which end the surface's rest.
  double rest_s();

  /// The frame of the footage that the window shows; null before the first.
  const std::shared_ptr<const DrawnFrame>& shown() const { return shown_; }

  void open(const std::string& location) override { open({location, opened_.overrides}); }
  void drop(const std::string& file) override;
  void seek(std::int64_t position) override { playhead_.go_to(position); }
  void set(const std::string& key, const std::string& text) override;
  std::string value_of(const std::string& key) const override;
  void screenshot(const std::string& path) override { screenshot_ = path; }
  void picture(const std::string& path) override;
  void save(const std::string& path) override;
  void quit() override { is_done_ = true; }
  bool is_idle() const override;
  const GuiItems& items() const override { return items_; }

 private:
  void ask_player();
  FrameWish wanted() const;
  bool is_new(const FrameWish& wish) const;
  void open(const OpenedRecording& wanted);
  void leave_for(std::optional<OpenedRecording> next);
  void leave();
  bool is_live() const { return player_ && player_->live(); }
  std::string message() const;
  void take_keys();
  bool button(const char* name, bool is_possible, const char* help);
  bool write_scene(const std::string& to);
  void save_as(const std::string& path);
  void draw_top();
  void draw_picture();
  void draw_side();
  void draw_bottom();
  void draw_progress();
  void draw_status();
  void draw_questions();
  std::string scene_file() const;
  void take_screenshot();

  GuiSurface& surface_;
  OpenedRecording opened_;
  TuneState state_;  ///< of last time, but for the recordings
  OpeningScreen opening_;
  std::optional<OpenedRecording> next_;  ///< what is opened when the question is answered; none: the window goes
  std::optional<Recording> recording_;
  std::optional<SettingsHistory> history_;  ///< there is one where there is a recording
  std::unique_ptr<ShotPlayer> player_;
  std::shared_ptr<const DrawnFrame> shown_;
  std::optional<FrameWish> wished_;  ///< what the player was asked for last
  Playhead playhead_;
  PictureView picture_view_;
  ParameterControls controls_;
  Panels panels_;
  GuiItems items_;
  WindowLayout layout_;
  GuiPace pace_;
  PictureHands hands_;
  LightPanel light_panel_;
  SaveAs save_as_;
  RenderPanel render_panel_;
  LivePanel live_panel_;
  std::string message_, screenshot_;
  bool is_done_ = false, asks_to_leave_ = false, shows_help_ = false;
};

}  // namespace catchlight::app
