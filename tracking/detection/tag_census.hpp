// Counts the tags in pictures in which the one that is looked for is not found: what is there instead.
#pragma once

#include <string>
#include <vector>

#include "catchlight/luma_view.hpp"

namespace catchlight::tracking {

struct CountedTag {
  std::string family;
  int id = 0;
  std::size_t pictures = 0;  ///< in how many it is
  bool operator==(const CountedTag&) const = default;
};

struct TagCensus {
  std::size_t pictures = 0;      ///< those looked at
  std::vector<CountedTag> tags;  ///< the most frequent first; none that is in one of several pictures alone, which may be no tag
  bool is_mirrored = false;      ///< they are seen as in a mirror
};

/// Looks for tags of every family, without a wrong bit. Where there are none, looks for them in the mirrored pictures.
TagCensus count_tags(const std::vector<LumaView>& pictures);

}  // namespace catchlight::tracking
