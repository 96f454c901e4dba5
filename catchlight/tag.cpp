#include "catchlight/tag.hpp"

namespace catchlight {

std::vector<BundledTag> TagTarget::tags() const {
  std::vector<BundledTag> all{{*this, {}}};
  all.insert(all.end(), bundle.begin(), bundle.end());
  return all;
}

std::array<glm::dvec3, 4> tag_corners_m(double size_m) {
  const double h = size_m / 2;
  return {{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}};
}

}  // namespace catchlight
