// What a script does in the window, line by line: recordings of bugs, and tests.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// A command of a script, and where it stands.
struct ScriptCommand {
  int line = 0;
  std::string verb;
  std::vector<std::string> words;
};

/// What a window lets a script do.
class ScriptTarget {
 public:
  virtual ~ScriptTarget() = default;
  virtual void open(const std::string& recording) = 0;
  virtual void drop(const std::string& file) = 0;
  virtual void seek(std::int64_t position) = 0;
  virtual void set(const std::string& key, const std::string& text) = 0;
  virtual std::string value_of(const std::string& key) const = 0;
  virtual void screenshot(const std::string& path) = 0;  ///< of the whole window
  virtual void picture(const std::string& path) = 0;     ///< the composite that is shown
  virtual void save(const std::string& path) = 0;        ///< empty: the scene file itself
  virtual void quit() = 0;
  virtual bool is_idle() const = 0;
  virtual const GuiItems& items() const = 0;
};

/// Reads a script: a command a line, words separated by spaces, `#` begins a comment. Throws Error "FILE:LINE: ..." for a command
/// that there is not, or too few words.
std::vector<ScriptCommand> read_ui_script(const std::string& path);

/// Plays commands, a step of one each frame of the window.
class UiScript {
 public:
  UiScript(std::string path, std::vector<ScriptCommand> commands);

  /// Before a frame of the window begins: writes the input into ImGui's IO. Throws Error "FILE:LINE: ..." where a control is not
  /// there, or something expected is otherwise.
  void before_frame(ScriptTarget& target);
  /// Whether it waits for what the window is to show.
  bool is_waiting() const { return gestures_.empty() && next_ < commands_.size() && commands_[next_].verb == "wait"; }
  bool is_done() const { return next_ == commands_.size() && gestures_.empty(); }

 private:
  using Gesture = std::function<void(ImGuiIO&)>;
  void begin(ScriptTarget& target, const ScriptCommand& command);
  bool is_reached(const ScriptTarget& target, const ScriptCommand& command) const;
  bool holds(const ScriptTarget& target, const ScriptCommand& command) const;
  float number(const ScriptCommand& command, std::size_t word) const;
  GuiItems::Rect rect_of(const ScriptTarget& target, const std::string& control) const;
  ImVec2 middle_of(const ScriptTarget& target, const std::string& control) const;
  void click(const ImVec2& at);
  void drag(const ImVec2& from, const ImVec2& to);
  void drag_along(const ScriptTarget& target, const ScriptCommand& command);
  void turn_wheel(const ImVec2& at, float steps);
  void type(const std::string& text);
  void press(const ScriptCommand& command);
  void hold(const ScriptCommand& command);
  void release();

  std::string path_;
  std::vector<ScriptCommand> commands_;
  std::size_t next_ = 0;
  std::deque<Gesture> gestures_;  ///< of the command that is going on, one a frame
};

}  // namespace catchlight::app
