// A picture of given light, as the camera's measures look at it.
#pragma once

#include <vector>

#include "catchlight/code_view.hpp"
#include "tracking/camera/pixel_light.hpp"

namespace catchlight::tracking {

/// Linear RGB, row-major; it must outlive its views.
struct Light {
  int width_px = 0, height_px = 0;
  std::vector<glm::vec3> rgb;

  CodeView codes() const {
    CodeView codes;
    codes.width_px = width_px;
    codes.height_px = height_px;
    codes.is_real = true;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      SampleView& samples = codes.samples[channel];
      samples.kind = SampleView::Kind::real;
      samples.data = reinterpret_cast<const std::uint8_t*>(rgb.data()) + channel * sizeof(float);
      samples.step_bytes = sizeof(glm::vec3);
      samples.stride_bytes = width_px * samples.step_bytes;
    }
    return codes;
  }

  PixelLight view(float clipping_linear = 0.955f) const {
    return {codes(), LightTable({TransferFunction::linear}), glm::mat3(1), glm::vec3(clipping_linear)};
  }
};

}  // namespace catchlight::tracking
