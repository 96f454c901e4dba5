#include "app/window/editing/object_drag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "app/settings/parameters.hpp"
#include "catchlight/projection.hpp"

namespace catchlight::app {
namespace {

constexpr const char* kGroup = "object.tag_from_object.";

std::string name_of(DragKind kind) {
  return kind == DragKind::move ? "translation_m" : kind == DragKind::turn ? "rotation_deg" : "scale";
}

/// As the parameter table takes it: within its range, and noted as set by hand.
void set(SceneSettings& settings, std::size_t object, DragKind kind, const ParameterValue& value) {
  set_parameter(settings, *find_parameter(kGroup + name_of(kind)), value, object);
}

double angle_deg(const glm::dvec2& v) {
  return std::atan2(v.y, v.x) * 180 / glm::pi<double>();
}

}  // namespace

std::optional<glm::dvec2> seen_place_m(const CameraModel& camera, const RigidTransform& camera_from_tag,
                                       const glm::dvec2& pixel) {
  const DistortionLimit limit = distortion_limit(camera);
  const auto ideal_px = undistort_px(camera, pixel, &limit);
  if (!ideal_px) return {};
  const glm::dvec3 ray((ideal_px->x - camera.cx_px) / camera.fx_px, (ideal_px->y - camera.cy_px) / camera.fy_px, 1);
  const RigidTransform tag_from_camera = inverse(camera_from_tag);
  const glm::dvec3 eye_m = tag_from_camera.translation_m, direction = tag_from_camera.rotation * ray;
  if (!(eye_m.z > 0 && direction.z < 0)) return {};
  return glm::dvec2(eye_m - eye_m.z / direction.z * direction);
}

ObjectDrag::ObjectDrag(SceneSettings start, std::size_t object, DragKind kind, const glm::dvec2& place_m)
    : start_(std::move(start)), object_(object), kind_(kind), from_m_(place_m) {}

SceneSettings ObjectDrag::at(const glm::dvec2& place_m) const {
  constexpr double kMinDistance_m = 1e-4, kMinScale = 1e-3, kMaxScale = 1e3;
  SceneSettings settings = start_;
  const SceneSettings::Object& object = start_.objects[object_];
  const glm::dvec2 origin_m(object.translation_m), from = from_m_ - origin_m, to = place_m - origin_m;
  switch (kind_) {
    case DragKind::move:
      set(settings, object_, kind_, object.translation_m + glm::dvec3(place_m - from_m_, 0));
      break;
    case DragKind::turn: {
      glm::dvec3 turned_deg = object.rotation_deg;
      turned_deg.z = std::remainder(turned_deg.z + angle_deg(to) - angle_deg(from), 360.0);
      set(settings, object_, kind_, turned_deg);
      break;
    }
    case DragKind::scale: {
      const double ratio = glm::length(to) / std::max(glm::length(from), kMinDistance_m);
      set(settings, object_, kind_, object.scale * std::clamp(ratio, kMinScale, kMaxScale));
      break;
    }
  }
  return settings;
}

std::string ObjectDrag::key() const {
  return kGroup + name_of(kind_);
}

std::string ObjectDrag::text(const SceneSettings& settings, std::size_t object, DragKind kind) {
  const SceneSettings::Object& o = settings.objects[object];
  char text[64];
  if (kind == DragKind::move)
    std::snprintf(text, sizeof text, "%.1f, %.1f mm", 1e3 * o.translation_m.x, 1e3 * o.translation_m.y);
  else if (kind == DragKind::turn)
    std::snprintf(text, sizeof text, "%.1f°", o.rotation_deg.z);
  else
    std::snprintf(text, sizeof text, "× %.3f", o.scale);
  return text;
}

}  // namespace catchlight::app
