#include "app/window/editing/settings_history.hpp"

#include <utility>

namespace catchlight::app {

void SettingsHistory::change(SceneSettings settings, const std::string& key) {
  if (saved_ && *saved_ > at_) saved_.reset();
  steps_.resize(at_ + 1);
  const bool goes_on = in_gesture_ && at_ > 0 && steps_[at_].key == key && saved_ != at_;
  if (goes_on)
    steps_[at_].settings = std::move(settings);
  else
    steps_.push_back({std::move(settings), key}), ++at_;
  in_gesture_ = true;
}

void SettingsHistory::undo() {
  if (can_undo()) --at_;
  end_gesture();
}

void SettingsHistory::redo() {
  if (can_redo()) ++at_;
  end_gesture();
}

void SettingsHistory::take(std::size_t slot) {
  if (!slots_[slot]) return;
  end_gesture();
  change(*slots_[slot], slot == 0 ? "A" : "B");
  end_gesture();
}

}  // namespace catchlight::app
