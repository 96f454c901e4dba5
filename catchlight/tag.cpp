#include "catchlight/tag.hpp"

namespace catchlight {

std::vector<BundledTag> TagTarget::tags() const {
  std::vector<BundledTag> all{{*this, {}}};
  all.insert(all.end(), bundle.begin(), bundle.end());
  return all;
}

}  // namespace catchlight
