#include "app/session/focal_check.hpp"

#include <cmath>

#include "catchlight/util/text.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

constexpr double kMaxOff = 0.03;
constexpr double kBeyondDoubt = 2;  ///< standard deviations

}  // namespace

void tell_focal_length(const tracking::FocalEstimate& seen, const CameraModel& camera, const Recording& recording, Log& log) {
  const std::string camera_name = recording.camera_file ? *recording.camera_file : "--fov " + number_text(*recording.fov_deg);
  const std::string says = "focal length: " + std::to_string(seen.looks) + " views of the tag say " + fixed_text(seen.fx_px, 0) +
                           " +- " + fixed_text(seen.deviation_px, 0) + " px, " + camera_name + " says " +
                           fixed_text(camera.fx_px, 0);
  const double off_px = std::abs(camera.fx_px - seen.fx_px);
  if (off_px <= kMaxOff * seen.fx_px || off_px <= kBeyondDoubt * seen.deviation_px) return log.info(says);
  CameraModel better = camera;
  better.fx_px = seen.fx_px;
  log.warn(says + ", which is " + fixed_text(100 * off_px / seen.fx_px, 0) + " % too " +
           (camera.fx_px > seen.fx_px ? "long" : "short") + "; calibrate the camera (docs/calibration.md), or pass --fov " +
           fixed_text(tracking::horizontal_fov_deg(better), 1));
}

}  // namespace catchlight::app
