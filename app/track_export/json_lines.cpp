#include <nlohmann/json.hpp>

#include "app/track_export/formats.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/enum_names.hpp"

namespace catchlight::app {
namespace {

using Json = nlohmann::ordered_json;

Json rows_of(const RigidTransform& transform) {
  Json matrix = Json::array();
  for (int row = 0; row < 3; ++row)
    matrix.push_back(
        {transform.rotation[0][row], transform.rotation[1][row], transform.rotation[2][row], transform.translation_m[row]});
  matrix.push_back({0.0, 0.0, 0.0, 1.0});
  return matrix;
}

Json covariance_or_null(const TrackRow& row) {
  if (!row.found || !row.pose_covariance) return nullptr;
  Json matrix = Json::array();
  for (std::size_t i = 0; i < 6; ++i) {
    const double* line = row.pose_covariance->data() + 6 * i;
    matrix.push_back(std::vector<double>(line, line + 6));
  }
  return matrix;
}

Json rgb_or_null(const TrackRow& row, const glm::dvec3& rgb) {
  return row.has_exposure ? Json{rgb.r, rgb.g, rgb.b} : Json(nullptr);
}

}  // namespace

std::string json_lines_text(const std::vector<TrackRow>& rows) {
  std::string text;
  for (const TrackRow& row : rows) {
    const Json line{{"frame", row.frame},
                    {"time_s", row.time_s},
                    {"state", name_of(row.state)},
                    {"camera_from_tag", row.found ? rows_of(row.camera_from_tag) : Json(nullptr)},
                    {"pose_covariance", covariance_or_null(row)},
                    {"exposure", rgb_or_null(row, row.exposure)},
                    {"black", rgb_or_null(row, row.black)},
                    {"corner_sigma_px", row.corner_sigma_px},
                    {"ambiguity", row.ambiguity}};
    text += line.dump() + '\n';
  }
  return text;
}

}  // namespace catchlight::app
