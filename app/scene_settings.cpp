#include "app/scene_settings.hpp"

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

namespace catchlight::app {

glm::dmat4 SceneSettings::Object::tag_from_object() const {
  if (matrix) return *matrix;
  glm::dmat4 placed = glm::translate(glm::dmat4(1.0), translation_m);
  placed = glm::rotate(placed, glm::radians(rotation_deg.z), glm::dvec3(0, 0, 1));
  placed = glm::rotate(placed, glm::radians(rotation_deg.y), glm::dvec3(0, 1, 0));
  placed = glm::rotate(placed, glm::radians(rotation_deg.x), glm::dvec3(1, 0, 0));
  return glm::scale(placed, glm::dvec3(scale));
}

std::string SceneSettings::resolve(const std::string& path) const {
  return (std::filesystem::path(folder) / path).string();
}

}  // namespace catchlight::app
