#include "app/session/absent_tag.hpp"

#include <algorithm>

#include "catchlight/util/text.hpp"
#include "tracking/detection/tag_census.hpp"

namespace catchlight::app {
namespace {

using tracking::CountedTag;
using tracking::TagCensus;

std::string name_of_tag(const std::string& family, int id) {
  return family + " #" + std::to_string(id);
}

std::string how_often(const CountedTag& tag, std::size_t pictures) {
  if (tag.pictures == pictures) return pictures == 1 ? "in the picture" : "in every frame that was looked at";
  return "in " + std::to_string(tag.pictures) + " of " + std::to_string(pictures) + " frames that were looked at";
}

bool is_wanted(const TagTarget& target, const CountedTag& seen) {
  return std::ranges::any_of(target.tags(),
                             [&](const BundledTag& tag) { return tag.family == seen.family && tag.id == seen.id; });
}

std::string advice(const TagTarget& target, const CountedTag& seen, bool is_mirrored) {
  if (is_mirrored) return ", as in a mirror: flip the footage (ffmpeg -vf hflip)";
  if (is_wanted(target, seen)) return ", but no pose fits it: check the camera file or --fov";
  const std::string family = seen.family == target.family ? "" : "--tag.family " + seen.family + " ";
  return ": give " + family + "--tag.id " + std::to_string(seen.id);
}

/// The tags that are there nearly as often as the first.
std::string list_of(const TagCensus& census) {
  constexpr std::size_t kMaxNamed = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMaxNamed, census.tags.size()); ++i) {
    const CountedTag& tag = census.tags[i];
    if (2 * tag.pictures < census.tags[0].pictures) break;
    const std::string name = name_of_tag(tag.family, tag.id);
    text += i == 0 ? name + " is " + how_often(tag, census.pictures) : ", " + name + " in " + std::to_string(tag.pictures);
  }
  return text;
}

}  // namespace

std::string what_is_there(const TagTarget& target, const std::vector<LumaView>& pictures) {
  const TagCensus census = tracking::count_tags(pictures);
  if (census.tags.empty())
    return "no tag of any family is there; it must be sharp, at least 20 px wide, with white around its print";
  return list_of(census) + advice(target, census.tags[0], census.is_mirrored);
}

void AbsentTag::add(const Frame& frame, bool is_found) {
  is_found_ |= is_found;
  ++count_;
  if (is_found_)
    frames_ = {};
  else
    frames_.add(frame);
}

std::string AbsentTag::text(const TagTarget& target) const {
  std::vector<LumaView> pictures;
  for (const Frame& frame : frames_.values()) pictures.push_back(frame.luma());
  return "the tag was never found in " + counted(count_, "frame") + "; " + name_of_tag(target.family, target.id) +
         " was looked for, and " + what_is_there(target, pictures);
}

}  // namespace catchlight::app
