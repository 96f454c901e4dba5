// The mirror ball in a picture: where it is, and what each point of it reflects.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"

namespace catchlight::app {

struct BallCircle {
  glm::dvec2 centre_px{0.0};
  double radius_px = 0;
};

/// Unit ray in the camera frame. Throws Error where the lens sees no such pixel.
glm::dvec3 ray_through(const CameraModel& camera, const glm::dvec2& px);

/// Points on the silhouette of the most ball-like disc of a scene-linear picture: Hough's circle (cv::HoughCircles), then the
/// steepest edge along each of its radii, then those that agree on one ball. Throws Error where there is none: `what` names the
/// picture.
std::vector<glm::dvec2> find_ball_outline(const Image& radiance, const std::optional<CameraModel>& camera,
                                          const std::string& what);

/// Points on a circle given by hand.
std::vector<glm::dvec2> outline_of(const BallCircle& circle);

/// Least squares (Kåsa 1976).
BallCircle fit_circle(const std::vector<glm::dvec2>& points_px);

/// The place on the ball that shows what comes from one direction.
struct BallSight {
  glm::dvec2 px{0.0};
  double from_camera_rad = 0;  ///< between the direction and the one from the ball to the camera
  double rim = 0;              ///< 0 in the ball's middle, 1 at its silhouette, as sine of the normal's angle
  bool is_behind = false;      ///< the ball hides that direction: `px` is the nearest that it shows
};

/// Light is taken to come from afar: by the same direction all over the ball.
class BallView {
 public:
  /// A camera far away, or unknown: rays are parallel, the silhouette is a circle.
  static BallView orthographic(const std::vector<glm::dvec2>& outline_px);

  /// The silhouette's rays form a circular cone: n · ray = 1 with n = axis / cos(half-angle), a linear fit. Throws Error where
  /// the outline does not lie in the camera's picture.
  static BallView perspective(const CameraModel& camera, const std::vector<glm::dvec2>& outline_px);

  /// `direction_camera`: unit length, from the ball. The normal's angle t from the camera obeys 2t + atan2(sin t, D - cos t) =
  /// angle between direction and camera, D the distance in radii; solved by Newton's method.
  BallSight sight(const glm::dvec3& direction_camera) const;

  const BallCircle& circle() const { return circle_; }
  /// The camera's distance in the ball's radii; infinite where rays are parallel.
  double distance_radii() const { return distance_radii_; }

 private:
  BallView(const BallCircle& circle, const std::optional<CameraModel>& camera, const glm::dvec3& axis, double distance_radii);
  double normal_angle(double from_camera_rad) const;

  BallCircle circle_;
  std::optional<CameraModel> camera_;
  glm::dvec3 axis_;  ///< from the camera to the ball, unit length
  double distance_radii_, largest_normal_rad_;
};

}  // namespace catchlight::app
