#include "app/session/object_scale.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// An object that is seen close by may well be larger than the frame; of one so many times as large hardly anything is seen.
constexpr double kMaxFrames = 2;

constexpr const char* kHint = "; tag_from_object.scale changes its size";
constexpr const char* kLargeHint = ": 0.001 for a model in millimetres";

/// The sides of the box in one unit: "98 × 74 × 83 mm". The largest has two digits at least.
std::string size_text(const render::Bounds& box) {
  const glm::dvec3 size_m = box.max_m - box.min_m;
  const double largest_m = std::max({size_m.x, size_m.y, size_m.z});
  const bool in_metres = largest_m >= 0.9995;
  const double units = in_metres ? 1 : 1000, largest = largest_m * units;
  const int digits = largest >= 9.95 ? 0 : largest >= 0.995 ? (in_metres ? 2 : 1) : 3;
  const auto side = [&](double side_m) { return fixed_text(side_m * units, digits); };
  return side(size_m.x) + " × " + side(size_m.y) + " × " + side(size_m.z) + (in_metres ? " m" : " mm");
}

bool is_inside(const render::Bounds& box, const glm::dvec3& place_m) {
  return glm::all(glm::greaterThan(place_m, glm::dvec3(box.min_m))) && glm::all(glm::lessThan(place_m, glm::dvec3(box.max_m)));
}

}  // namespace

std::string scale_text(const render::Bounds& box, double tag_size_m, const RigidTransform& camera_from_scene) {
  return "object " + size_text(box) + " on a tag of " + length_text(tag_size_m) + ", " +
         fixed_text(glm::length(camera_from_scene.translation_m), 2) + " m away";
}

std::optional<std::string> scale_warning(const render::Bounds& box, const CameraModel& camera,
                                         const RigidTransform& camera_from_scene) {
  const std::string object = "the object, " + size_text(box) + " large, ";
  if (is_inside(box, inverse(camera_from_scene).translation_m))
    return "the camera is inside the object, " + size_text(box) + " large" + kHint + kLargeHint;
  const double away_m = glm::length(camera_from_scene * glm::dvec3(box.middle_m()));
  const double size_px = camera.fx_px * static_cast<double>(box.diagonal_m()) / away_m;
  const double frame_px = std::hypot(camera.width_px, camera.height_px);
  if (size_px < 1) return object + "is smaller than a pixel" + kHint;
  if (size_px > kMaxFrames * frame_px)
    return object + "is more than the frame: " + fixed_text(size_px / frame_px, 0) + " times as large" + kHint + kLargeHint;
  return std::nullopt;
}

}  // namespace catchlight::app
