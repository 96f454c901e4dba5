// What the tracker found, as lines and words to draw over a picture.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

using Rgb = std::array<unsigned char, 3>;

/// A line that is drawn from point to point, in pixels of the frame.
struct Stroke {
  std::vector<glm::dvec2> points_px;
  Rgb color;
};

struct SketchLine {
  std::string text;
  Rgb color;
};

/// Where a tag is: its outline (white) through the lens, which may bend it. What is behind the camera, or beyond the field in
/// which the lens model is one to one, has no strokes.
std::vector<Stroke> outline_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m);

/// Half a tag's side of its axes: x red, y green, z blue.
std::vector<Stroke> axis_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m);

/// A cross on each corner, magenta.
std::vector<Stroke> corner_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m,
                                   double arm_px);

/// The outline of a rectangle of the tag's plane.
std::vector<Stroke> plane_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, const glm::dvec2& min_m,
                                  const glm::dvec2& max_m, const Rgb& color);

/// Frame number and state; of a tracked frame residual and ambiguity too.
std::vector<SketchLine> state_lines(const TrackRow& row);

}  // namespace catchlight::app
