// A camera trajectory to export, and what reading it back takes: rotations and projection that share no code with what is tested.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "app/track_export/track_export.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::app::orbit_test {

inline const glm::dvec3 kCorner_m(0.03, 0.05, 0);  // on the tag, nowhere special
inline const glm::dvec3 kAbove_m(-0.02, 0.01, 0.07);

/// Square pixels, centred: what every one of these programs can have.
inline CameraModel centred_camera() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 600;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  return camera;
}

inline Shot shot(render::UpAxis up = render::UpAxis::z) {
  Shot shot{centred_camera(), {}, false};
  shot.scene.probe.up = up;
  return shot;
}

inline TrackRow row_of(std::int64_t frame, const RigidTransform& camera_from_tag) {
  TrackRow row;
  row.frame = frame;
  row.time_s = static_cast<double>(frame) / 25;
  row.found = true;
  row.state = TrackState::tracking;
  row.camera_from_tag = camera_from_tag;
  row.has_exposure = true;
  return row;
}

/// A camera at `position_m` of the tag's frame looking at the tag's centre, `roll_deg` turned about its axis.
inline RigidTransform looking_at_tag(const glm::dvec3& position_m, double roll_deg) {
  const glm::dvec3 forward = glm::normalize(-position_m);
  const glm::dvec3 aside = std::abs(forward.z) > 0.99999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, aside));
  const glm::dmat3 upright(right, glm::cross(forward, right), forward);
  const glm::dmat3 roll(glm::rotate(glm::dmat4(1.0), glm::radians(roll_deg), glm::dvec3(0, 0, 1)));
  return inverse(RigidTransform{upright * roll, position_m});
}

/// Twice around the tag, rising until it is looked down on, rolling; frames 7, 20 and 21 are lost.
inline std::vector<TrackRow> orbit() {
  std::vector<TrackRow> rows;
  for (int frame = 0; frame < 60; ++frame) {
    const double around = frame * 4 * std::numbers::pi / 60, height = frame * 1.57 / 60;
    const glm::dvec3 direction(std::cos(around) * std::cos(height), std::sin(around) * std::cos(height), std::sin(height));
    TrackRow row = row_of(frame, looking_at_tag(0.6 * direction, 6.0 * frame));
    if (frame == 7 || frame == 20 || frame == 21) {
      row.found = false;
      row.state = TrackState::lost;
    }
    rows.push_back(row);
  }
  return rows;
}

inline std::vector<TrackRow> found_rows(std::vector<TrackRow> rows) {
  std::erase_if(rows, [](const TrackRow& row) { return !row.found; });
  return rows;
}

inline std::string written(const std::string& name, const std::vector<TrackRow>& rows, const Shot& shot) {
  const tests::TemporaryFolder folder;
  write_track(folder.path(name), rows, shot, false, [](const std::string& text) { ADD_FAILURE() << "warned: " << text; });
  EXPECT_EQ(folder.names(), std::vector<std::string>{name});
  return tests::read_text(folder.path(name));
}

inline glm::dvec2 seen_px(const TrackRow& row, const glm::dvec3& point_tag_m) {
  return project_px(centred_camera(), row.camera_from_tag * point_tag_m).value();
}

/// v turned by the quaternion: v + 2 w (u x v) + 2 u x (u x v), u = (x, y, z).
inline glm::dvec3 turned(const glm::dvec4& xyzw, const glm::dvec3& v) {
  const glm::dvec3 u(xyzw);
  return v + 2 * xyzw.w * glm::cross(u, v) + 2.0 * glm::cross(u, glm::cross(u, v));
}

inline glm::dvec3 turned_back(const glm::dvec4& xyzw, const glm::dvec3& v) {
  return turned({-glm::dvec3(xyzw), xyzw.w}, v);
}

/// The place where a camera with y up that looks along -z sees a point: from the picture's middle, in units
/// of the focal length.
inline glm::dvec2 pinhole(const glm::dvec3& point_camera) {
  return glm::dvec2(point_camera.x, -point_camera.y) / -point_camera.z;
}

/// The tag's point in a world whose +y is up, tag on a table.
inline glm::dvec3 on_table(const glm::dvec3& tag) {
  return {tag.x, tag.z, -tag.y};
}

}  // namespace catchlight::app::orbit_test
