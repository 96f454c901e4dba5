// The plate as the light that it photographed: what a mirror on the receiver shows of it.
#pragma once

#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "catchlight/plate.hpp"
#include "render/cpu/plate/response_table.hpp"
#include "render/frame_view.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {

class PlateLight {
 public:
  /// Takes over the whole frame's plate. Integer codes stay codes, and become light where they are looked at.
  void set(Plate plate, const FrameView& view, const ResponseTable& response);

  /// Scene-linear radiance, Rec. 709, at a place of the frame (0 to 1 each way), linear within a level and between levels. Level
  /// k is the frame at a 2^k-th of its resolution.
  glm::vec3 sample(const glm::vec2& place, float level) const;

  const Plate& plate() const { return plate_; }

  /// Gives the plate back: from then on there is no light to sample.
  Plate take_plate() { return std::move(plate_); }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Float4> texels;  ///< none for a first level of integer codes
  };

  Float4 radiance_of(Float4 light) const;
  Float4 light_of(std::size_t pixel) const;
  Float4 texel(const Level& level, int x, int y) const;
  Float4 bilinear(const Level& level, const glm::vec2& place) const;
  Level halved(const Level& level) const;

  Plate plate_;
  const ResponseTable* response_ = nullptr;
  glm::vec3 black_{0}, one_over_exposure_{0};
  glm::mat3 rec709_from_plate_{1};
  ResponseTable::Tables radiance_;  ///< of each integer code, where channels do not mix
  std::vector<Level> levels_;
};

}  // namespace catchlight::render
