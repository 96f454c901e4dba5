// The settings that a person turns, with the way back.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// Undo and redo without end, and two slots to flip between.
class SettingsHistory {
 public:
  /// `file`: the settings as the scene file and the command line give them.
  explicit SettingsHistory(SceneSettings file) : file_(file), steps_{{std::move(file), ""}} {}

  const SceneSettings& now() const { return steps_[at_].settings; }
  /// What the file says; saving makes it what is now.
  const SceneSettings& file() const { return file_; }
  void mark_saved() { file_ = now(), saved_ = at_; }
  bool is_saved() const { return saved_ == at_; }

  /// Takes new settings. Changes of one key that follow each other are one step until the gesture ends, as a slider that is
  /// dragged.
  void change(SceneSettings settings, const std::string& key);
  void end_gesture() { in_gesture_ = false; }

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < steps_.size(); }
  void undo();
  void redo();

  /// Keeps what is now in slot 0 (A) or 1 (B).
  void keep(std::size_t slot) { slots_[slot] = now(); }
  bool has(std::size_t slot) const { return slots_[slot].has_value(); }
  /// Takes what the slot keeps, as a step that can be undone.
  void take(std::size_t slot);

 private:
  struct Step {
    SceneSettings settings;
    std::string key;  ///< that it changed
  };

  SceneSettings file_;
  std::vector<Step> steps_;
  std::size_t at_ = 0;
  std::optional<std::size_t> saved_ = 0;  ///< none: the saved step was left behind by a new change
  bool in_gesture_ = false;
  std::array<std::optional<SceneSettings>, 2> slots_;
};

}  // namespace catchlight::app
