// Bloom and streaks, computed on a grid of few rows that is fixed to the frame: the same picture as GlarePass draws.
#pragma once

#include <vector>

#include "render/cpu/glare/cpu_glare.hpp"
#include "render/cpu/glare/glare_excess.hpp"
#include "render/cpu/glare/glare_spreader.hpp"
#include "render/glare/spline_samples.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

class GridGlare : public CpuGlare {
 public:
  explicit GridGlare(const GlareSettings& settings) : grid_rows_(settings.grid_rows), excess_(settings), spreader_(settings) {}

  bool extract(const Image& object, const Image* emission, const PixelRect& rect, int frame_width, int frame_height) override;
  /// The same for every camera.
  PixelRect spread(const CameraModel& camera) override;
  void read_row(int x, int y, int count, float* rgb) const override;

  const GlareGrid& grid() const { return grid_; }
  /// Excess and glare on the grid with its margins, RGB.
  Image read_excess() const;
  Image read_glare() const;

 private:
  void resize(int frame_width, int frame_height);

  int grid_rows_;
  GlareGrid grid_{};
  int frame_width_ = 0, frame_height_ = 0;
  GlareExcess excess_;
  GlareSpreader spreader_;
  std::vector<SplineSamples> columns_, rows_;  ///< where the frame's pixels lie on the grid
};

}  // namespace catchlight::render
