#include "tracking/camera/exposure.hpp"

namespace catchlight::tracking {

TagReading read_exposure(const TagPhotometry& photometry, const TagAlbedo& albedo) {
  TagReading reading;
  for (int c = 0; c < 3; ++c) {
    const double white_cell = photometry.white_linear[c], black_cell = photometry.black_linear[c];
    double white = (white_cell - black_cell) / (albedo.white - albedo.black);
    double black = black_cell - white * albedo.black;
    ExposureSource source = ExposureSource::tag;
    if (photometry.is_clipped[c]) {
      white = albedo.black > 0 ? black_cell / albedo.black : 0;
      black = 0;
      source = ExposureSource::black;
    } else if (black < 0) {  // blacks crushed by the camera: only the white cells still tell the gain
      white = white_cell / albedo.white;
      black = 0;
    }
    if (!(white > 0)) continue;
    reading.exposure.white[c] = white;
    reading.exposure.black[c] = black;
    reading.sources[static_cast<std::size_t>(c)] = source;
  }
  return reading;
}

}  // namespace catchlight::tracking
