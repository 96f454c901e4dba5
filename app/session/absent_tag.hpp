// What to say where the tag is never found: what is there instead.
#pragma once

#include <string>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/thinned_sample.hpp"

namespace catchlight::app {

/// "tag36h11 #12 is in every frame that was looked at: give --tag.id 12", where pictures do not show the target.
std::string what_is_there(const TagTarget& target, const std::vector<LumaView>& pictures);

/// Keeps a few frames of a shot, for as long as the tag is found in none.
class AbsentTag {
 public:
  void add(const Frame& frame, bool is_found);

  bool is_absent() const { return !is_found_ && count_ > 0; }

  /// "the tag was never found in 36 frames; ..." with what_is_there().
  std::string text(const TagTarget& target) const;

 private:
  bool is_found_ = false;
  std::size_t count_ = 0;
  ThinnedSample<Frame, 8> frames_;
};

}  // namespace catchlight::app
