// `catchlight probe merge` without its command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/support/log.hpp"
#include "app/tools/probe_merge/assemble.hpp"
#include "catchlight/tag.hpp"

namespace catchlight::app {

struct MergeRequest {
  std::vector<std::vector<std::string>> views;  ///< files of each camera position
  std::vector<double> times_s;                  ///< one a photograph, over all views or alike in each; empty: EXIF
  std::string response = "auto";                ///< auto, recover, srgb, linear
  std::vector<BallCircle> balls;                ///< one a view; empty: found
  std::optional<std::string> camera_file;
  std::optional<double> fov_deg;  ///< horizontal, where there is no camera file; neither: rays are parallel

  std::optional<TagTarget> tag;  ///< seen beside the ball in every view; needs a camera
  render::UpAxis up = render::UpAxis::z;
  double yaw_deg = 0;                                ///< the probe's yaw on the tag, as the scene says
  std::vector<double> view_yaw_deg, view_pitch_deg;  ///< instead of a tag; one a view, or empty: 0

  glm::dvec3 reflectance{1};  ///< the ball's
  double photographer_deg = 20;
  render::ProbeLayout layout = render::ProbeLayout::latlong;
  int width_px = 0;  ///< 0: as fine as the ball
};

/// Tells what was found, and warns of what was lost. Throws UsageError for a request that contradicts itself, Error for pictures
/// that cannot be used.
render::Probe merge_probe(const MergeRequest& request, Log& log);

}  // namespace catchlight::app
