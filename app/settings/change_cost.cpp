#include "app/settings/change_cost.hpp"

#include <algorithm>

#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

/// Whether the element has another value, or is chosen by hand in one scene and by the program in the other.
bool differs(const SceneSettings& before, const SceneSettings& after, const Parameter& parameter, std::size_t index) {
  const bool names_a_file = std::holds_alternative<PathKind>(parameter.kind);
  return parameter_text(before, parameter, index) != parameter_text(after, parameter, index) ||
         before.is_by_hand(parameter.key) != after.is_by_hand(parameter.key) || (names_a_file && before.folder != after.folder);
}

}  // namespace

std::set<ChangeCost> costs_of_change(const SceneSettings& before, const SceneSettings& after) {
  std::set<ChangeCost> costs;
  for (const Parameter& parameter : parameters()) {
    const std::size_t count = element_count(before, parameter);
    bool is_changed = count != element_count(after, parameter);
    for (std::size_t i = 0; i < count && !is_changed; ++i) is_changed = differs(before, after, parameter, i);
    if (is_changed) costs.insert(parameter.cost);
  }
  // What the files say and no parameter does.
  for (std::size_t i = 0; i < std::min(before.objects.size(), after.objects.size()); ++i)
    if (before.objects[i].matrix != after.objects[i].matrix) costs.insert(ChangeCost::mesh);
  if (before.probe.strict != after.probe.strict) costs.insert(ChangeCost::light);
  return costs;
}

}  // namespace catchlight::app
