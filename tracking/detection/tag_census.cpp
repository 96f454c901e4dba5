#include "tracking/detection/tag_census.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"

namespace catchlight::tracking {
namespace {

using Tag = std::pair<std::size_t, int>;  ///< index into tag_families(), and id

/// A quarter of the pixels shows large tags, all of them show small ones.
std::set<Tag> tags_in(Detector& detector, const LumaView& luma) {
  std::set<Tag> found;
  for (const double decimate : {2.0, 1.0}) {
    for (const Detection& detection : detector.detect(luma, decimate)) found.emplace(detection.family, detection.id);
    if (!found.empty()) break;
  }
  return found;
}

std::vector<std::uint8_t> mirrored(const LumaView& luma) {
  std::vector<std::uint8_t> codes;
  codes.reserve(static_cast<std::size_t>(luma.width_px) * static_cast<std::size_t>(luma.height_px));
  for (int row = 0; row < luma.height_px; ++row) {
    const std::uint8_t* first = luma.data + static_cast<std::ptrdiff_t>(row) * luma.stride;
    codes.insert(codes.end(), std::reverse_iterator(first + luma.width_px), std::reverse_iterator(first));
  }
  return codes;
}

std::vector<CountedTag> most_frequent_first(const std::map<Tag, std::size_t>& counts, std::size_t pictures) {
  std::vector<CountedTag> tags;
  for (const auto& [tag, count] : counts)
    if (count > 1 || pictures == 1) tags.push_back({tag_families()[tag.first], tag.second, count});
  std::stable_sort(tags.begin(), tags.end(), [](const auto& a, const auto& b) { return a.pictures > b.pictures; });
  return tags;
}

}  // namespace

TagCensus count_tags(const std::vector<LumaView>& pictures) {
  TrackerOptions exact;
  exact.max_hamming = 0;
  Detector detector(tag_families(), exact);
  TagCensus census;
  census.pictures = pictures.size();
  for (const bool is_mirrored : {false, true}) {
    std::map<Tag, std::size_t> counts;
    for (const LumaView& picture : pictures) {
      const std::vector<std::uint8_t> codes = is_mirrored ? mirrored(picture) : std::vector<std::uint8_t>{};
      LumaView seen = picture;
      if (is_mirrored) seen.data = codes.data(), seen.stride = seen.width_px;
      for (const Tag& tag : tags_in(detector, seen)) ++counts[tag];
    }
    census.tags = most_frequent_first(counts, pictures.size());
    census.is_mirrored = is_mirrored && !census.tags.empty();
    if (!census.tags.empty()) break;
  }
  return census;
}

}  // namespace catchlight::tracking
