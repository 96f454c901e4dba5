#include "render/cpu/plate/plate_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catchlight/response.hpp"
#include "render/receiver_light.hpp"
#include "shaders/noise.h"

namespace catchlight::render {
namespace {

/// Light that moves no code of 8 bits by a quarter, however dark the plate is.
constexpr float kInvisibleGlare = 5e-5f;

/// What is not a number is 0, as is what lies below.
inline float positive(float value) {
  return value > 0 ? value : 0;
}

[[gnu::target_clones("avx2", "default")]] int mark_touched(PlateBlock& block) {
  int any = 0;
  for (int i = 0; i < block.count; ++i) {
    int has_glare = 0, has_shadow = 0;
    for (const Plane& glare : block.glare) has_glare |= glare[i] < kInvisibleGlare ? 0 : 1;
    for (const Plane& ratio : block.ratio) has_shadow |= std::abs(ratio[i] - 1) < kInvisibleShadow ? 0 : 1;
    for (Plane& glare : block.glare) glare[i] = has_glare ? glare[i] : 0;
    for (Plane& ratio : block.ratio) ratio[i] = has_shadow ? ratio[i] : 1;
    block.is_touched[i] = has_glare | has_shadow | (block.coverage[i] > 0 ? 1 : 0);
    any |= block.is_touched[i];
  }
  return any;
}

[[gnu::target_clones("avx2", "default")]] void composite_channel(const PlateLevels& levels, std::size_t c, PlateBlock& block) {
  const auto channel = static_cast<int>(c);
  const float black = levels.black[channel], receiver_light = levels.receiver_light[channel];
  const float clipping_code = levels.clips ? static_cast<float>(kClippingCode) : std::numeric_limits<float>::infinity();
  for (int i = 0; i < block.count; ++i) {
    const float plate = block.background[c][i], coverage = block.coverage[i];
    // Where the plate is clipped the receiver is brighter than it shows, and so is its shadow.
    const float lit = (block.code[c][i] >= clipping_code) & (plate < receiver_light) ? receiver_light : plate;
    // Black is light the lens scatters: no shadow takes it away, and the object stands behind it too.
    const float shadowed = positive(lit - black) * block.ratio[c][i] + (plate < black ? plate : black);
    const float over = block.object[c][i] + coverage * black;
    block.shadowed[c][i] = shadowed;
    block.over[c][i] = over;
    block.light[c][i] = shadowed * (1 - coverage) + over + block.glare[c][i];
  }
}

/// A shadow or a glare of less than a 30th of the light leaves 96 % of the noise's variance: nobody sees what is missing.
[[gnu::target_clones("avx2", "default")]] int mark_lost_noise(PlateBlock& block) {
  constexpr float kFaint = 1.0f / 30;
  int any = 0;
  for (int i = 0; i < block.count; ++i) {
    int faint = 1;
    for (int c = 0; c < 3; ++c) {
      const float change = block.ratio[c][i] - 1;
      faint &=
          (change < kFaint ? 1 : 0) & (-change < kFaint ? 1 : 0) & (block.glare[c][i] <= kFaint * block.background[c][i] ? 1 : 0);
    }
    block.lacks_noise[i] = block.coverage[i] > 0 ? 1 : 1 - faint;
    any |= block.lacks_noise[i];
  }
  return any;
}

[[gnu::target_clones("avx2", "default")]] void fill_noise(glm::ivec2 place, std::uint32_t seed, std::uint32_t stream, int count,
                                                          float* result) {
  for (int i = 0; i < count; ++i) result[i] = shading::gaussian({place.x + i, place.y}, seed, stream);
}

/// Noise of variance 1: two numbers that blocks of pixels share, and one of each pixel's own.
struct UnitNoise {
  Plane shared[2], own;

  UnitNoise(const SensorNoise& noise, const PlateBlock& block) {
    const int first = block.x >> noise.block_shift.x;
    const int shared_count = ((block.x + block.count - 1) >> noise.block_shift.x) - first + 1;
    for (std::uint32_t stream = 0; stream < 2; ++stream) {
      Plane numbers;
      fill_noise({first, block.y >> noise.block_shift.y}, noise.frame, stream, shared_count, numbers.data());
      for (int i = 0; i < block.count; ++i) shared[stream][i] = numbers[((block.x + i) >> noise.block_shift.x) - first];
    }
    fill_noise({block.x, block.y}, noise.frame, 2u, block.count, own.data());
  }
};

[[gnu::target_clones("avx2", "default")]] void add_noise(const SensorNoise& noise, const UnitNoise& unit, std::size_t c,
                                                         PlateBlock& block) {
  const auto channel = static_cast<int>(c);
  const float mix[] = {noise.mix[0][channel], noise.mix[1][channel], noise.mix[2][channel]};
  const float slope = noise.slope[channel], lowest = noise.floor[channel];
  for (int i = 0; i < block.count; ++i) {
    const float number = mix[0] * unit.shared[0][i] + mix[1] * unit.shared[1][i] + mix[2] * unit.own[i];
    const float kept = (1 - block.coverage[i]) * block.ratio[c][i];
    const float wanted = positive(slope * positive(block.light[c][i]) + lowest);
    const float there = kept * kept * positive(slope * positive(block.background[c][i]) + lowest);
    const float missing = std::sqrt(positive(wanted - there)) * number;
    block.light[c][i] += block.lacks_noise[i] ? missing : 0;
  }
}

[[gnu::target_clones("avx2", "default")]] void mark_changed(const PlateLevels& levels, std::size_t c, PlateBlock& block) {
  const float changed_code = levels.changed_code;
  const bool clips = levels.clips;
  for (int i = 0; i < block.count; ++i) {
    const float plate = block.code[c][i], light = block.result[c][i], above_0 = positive(light);
    const float bounded = above_0 < 1 ? above_0 : 1;
    const float code = clips ? bounded : light, change = code - plate;
    // A NaN in the plate compares as changed once something virtual covers it.
    const int differs = (change <= changed_code) & (change >= -changed_code) ? 0 : 1;
    block.is_changed[i] |= differs & block.is_touched[i];
    block.result[c][i] = block.is_touched[i] ? code : plate;
  }
}

}  // namespace

bool find_touched(PlateBlock& block) {
  return mark_touched(block) != 0;
}

void composite_light(const PlateLevels& levels, PlateBlock& block) {
  for (std::size_t c = 0; c < 3; ++c) composite_channel(levels, c, block);
}

void add_missing_noise(const SensorNoise& noise, PlateBlock& block) {
  if (mark_lost_noise(block) == 0) return;
  const UnitNoise unit(noise, block);
  for (std::size_t c = 0; c < 3; ++c) add_noise(noise, unit, c, block);
}

void find_changed(const PlateLevels& levels, PlateBlock& block) {
  std::fill_n(block.is_changed.data(), block.count, 0);
  for (std::size_t c = 0; c < 3; ++c) mark_changed(levels, c, block);
}

}  // namespace catchlight::render
