// Printed tags: what is looked for.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "catchlight/rigid_transform.hpp"

namespace catchlight {

/// A printed tag. `size_m` is the side of the square whose corners detectors return.
struct PrintedTag {
  std::string family = "tag36h11";
  int id = 0;
  double size_m = 0.08;
  bool operator==(const PrintedTag&) const = default;
};

/// A further tag of a board, fixed to the first.
struct BundledTag : PrintedTag {
  RigidTransform tag_from_this;
};

/// What is tracked: a tag, whose frame is the tag frame, alone or as the first of a board.
struct TagTarget : PrintedTag {
  std::vector<BundledTag> bundle;

  /// The first tag (in its own frame) and the bundle.
  std::vector<BundledTag> tags() const;
};

/// The corners of a tag's square in its own frame, counter-clockwise as the tag is read, from the lower left.
std::array<glm::dvec3, 4> tag_corners_m(double size_m);

}  // namespace catchlight
