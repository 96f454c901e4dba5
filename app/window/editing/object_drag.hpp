// Moves, turns and scales an object by its picture.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::app {

/// The place of the plane z = 0 of the tag frame that a pixel sees; empty where it sees none, or its back.
std::optional<glm::dvec2> seen_place_m(const CameraModel& camera, const RigidTransform& camera_from_tag, const glm::dvec2& pixel);

enum class DragKind {
  move,  ///< along the receiver: the place that was taken hold of stays under the pointer
  turn,  ///< about the receiver's normal, around the object's origin
  scale  ///< by the distance from the object's origin
};

/// A drag from where it began.
class ObjectDrag {
 public:
  /// Takes hold of the object at a place of the receiver.
  ObjectDrag(SceneSettings start, std::size_t object, DragKind kind, const glm::dvec2& place_m);

  /// The settings with the pointer at another place.
  SceneSettings at(const glm::dvec2& place_m) const;

  /// The key that is changed, and its value as numbers beside the pointer.
  std::string key() const;
  static std::string text(const SceneSettings& settings, std::size_t object, DragKind kind);

 private:
  SceneSettings start_;
  std::size_t object_;
  DragKind kind_;
  glm::dvec2 from_m_;
};

}  // namespace catchlight::app
