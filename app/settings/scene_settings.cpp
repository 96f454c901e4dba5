#include "app/settings/scene_settings.hpp"

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

namespace catchlight::app {
namespace {

/// Turned about x first, then y, then z; then moved.
glm::dmat4 placed(const glm::dvec3& translation_m, const glm::dvec3& rotation_deg) {
  glm::dmat4 placed = glm::translate(glm::dmat4(1.0), translation_m);
  placed = glm::rotate(placed, glm::radians(rotation_deg.z), glm::dvec3(0, 0, 1));
  placed = glm::rotate(placed, glm::radians(rotation_deg.y), glm::dvec3(0, 1, 0));
  return glm::rotate(placed, glm::radians(rotation_deg.x), glm::dvec3(1, 0, 0));
}

}  // namespace

glm::dmat4 SceneSettings::Object::tag_from_object() const {
  return matrix ? *matrix : glm::scale(placed(translation_m, rotation_deg), glm::dvec3(scale));
}

TagTarget SceneSettings::Tag::target() const {
  TagTarget target{{family, id, size_m}, {}};
  for (const Bundled& tag : bundle) {
    const glm::dmat4 tag_from_this = placed(tag.translation_m, tag.rotation_deg);
    target.bundle.push_back({{tag.family == "same" ? family : tag.family, tag.id, tag.size_m > 0 ? tag.size_m : size_m},
                             {glm::dmat3(tag_from_this), glm::dvec3(tag_from_this[3])}});
  }
  return target;
}

tracking::TrackerOptions SceneSettings::Tag::tracker_options() const {
  tracking::TrackerOptions options;
  options.refinement = refinement;
  return options;
}

CameraModel SceneSettings::Lens::as_drawn(CameraModel camera) const {
  if (distortion == Switch::off) camera.distortion = {};
  if (vignetting == Switch::off) camera.vignetting = glm::dvec3(0.0);
  return camera;
}

std::string SceneSettings::resolve(const std::string& path) const {
  return (std::filesystem::path(folder) / path).string();
}

}  // namespace catchlight::app
