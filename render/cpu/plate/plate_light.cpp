#include "render/cpu/plate/plate_light.hpp"

#include <algorithm>
#include <utility>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

/// What a graphics card's half floats hold: the plate shows nothing brighter.
constexpr float kBrightest = 6e4f;

}  // namespace

/// Radiance, Rec. 709, by what the response tells of the plate's codes.
Float4 PlateLight::radiance_of(Float4 light) const {
  glm::vec3 result = one_over_exposure_ * (rec709_from_plate_ * glm::max(rgb(light) - black_, 0.0f));
  // A channel without exposure, or a NaN in the plate, shows nothing.
  for (int c = 0; c < 3; ++c) result[c] = result[c] > 0 ? std::min(result[c], kBrightest) : 0;
  return float4(result);
}

Float4 PlateLight::light_of(std::size_t pixel) const {
  if (!radiance_[0].empty()) return ResponseTable::looked_up(radiance_, plate_, pixel);
  return radiance_of(response_->linear(plate_, pixel));
}

void PlateLight::set(Plate plate, const FrameView& view, const ResponseTable& response) {
  plate_ = std::move(plate);
  response_ = &response;
  black_ = view.black;
  for (int c = 0; c < 3; ++c) one_over_exposure_[c] = view.exposure[c] > 0 ? 1 / view.exposure[c] : 0;
  rec709_from_plate_ = glm::inverse(view.color.plate_from_rec709);
  for (auto& radiance : radiance_) radiance.clear();
  if (view.color.plate_from_rec709 == glm::mat3(1)) {
    const ResponseTable::Tables& light = response.linear_of_codes();
    for (std::size_t i = 0; i < light[0].size(); ++i) {
      const Float4 all = radiance_of(Float4{light[0][i], light[1][i], light[2][i], 0});
      for (std::size_t c = 0; c < 3; ++c) radiance_[c].push_back(all[static_cast<int>(c)]);
    }
  }
  levels_.resize(1);
  levels_[0] = {plate_.rect.width, plate_.rect.height, {}};
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

Float4 PlateLight::texel(const Level& level, int x, int y) const {
  const std::size_t at = static_cast<std::size_t>(y) * level.width + x;
  return level.texels.empty() ? light_of(at) : level.texels[at];
}

/// The mean of two by two; an odd last row or column is left out.
PlateLight::Level PlateLight::halved(const Level& level) const {
  Level half{std::max(level.width / 2, 1), std::max(level.height / 2, 1), {}};
  half.texels.resize(static_cast<std::size_t>(half.width) * half.height);
  const auto fill_row = [&](std::size_t row) {
    const int y = static_cast<int>(row), below = std::min(2 * y + 1, level.height - 1);
    for (int x = 0; x < half.width; ++x) {
      const int right = std::min(2 * x + 1, level.width - 1);
      half.texels[row * half.width + x] = splat(0.25f) * (texel(level, 2 * x, 2 * y) + texel(level, right, 2 * y) +
                                                          texel(level, 2 * x, below) + texel(level, right, below));
    }
  };
  parallel_for(static_cast<std::size_t>(half.height), half.height < 64 ? 1 : 0, fill_row);
  return half;
}

Float4 PlateLight::bilinear(const Level& level, const glm::vec2& place) const {
  const glm::vec2 last(level.width - 1, level.height - 1);
  const glm::vec2 at = glm::clamp(place * glm::vec2(level.width, level.height) - 0.5f, glm::vec2(0), last);
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
  const int right = std::min(x + 1, level.width - 1), below = std::min(y + 1, level.height - 1);
  const float across = at.x - static_cast<float>(x);
  return blend(blend(texel(level, x, y), texel(level, right, y), across),
               blend(texel(level, x, below), texel(level, right, below), across), at.y - static_cast<float>(y));
}

glm::vec3 PlateLight::sample(const glm::vec2& place, float level) const {
  return rgb(between_levels(level, levels_.size(), [&](std::size_t number) { return bilinear(levels_[number], place); }));
}

}  // namespace catchlight::render
