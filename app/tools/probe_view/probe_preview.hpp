// A picture that shows at once whether a probe is the right way round.
#pragma once

#include <opencv2/core/mat.hpp>

#include "render/probe/probe.hpp"

namespace catchlight::app {

/// Above, the whole probe with the tag's directions and the brightest light marked. Below, a mirror ball and a white matte ball
/// on the tag, seen horizontally by a far camera at tag -y, and a plan: the sky's half laid over the tag as it is read, the
/// zenith in the middle, the horizon on the rim. For a probe with up = "z". Exposed so that the log-average is mid-grey, times
/// 2^ev, and compressed (Reinhard 2002) so that lights keep their colour. CV_8UC3, `width_px` wide.
cv::Mat probe_preview(const render::Probe& probe, double yaw_deg, double ev, int width_px);

}  // namespace catchlight::app
