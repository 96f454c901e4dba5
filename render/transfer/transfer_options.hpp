// What a bake is asked for.
#pragma once

#include <cstdint>

#include "render/transfer/receiver_albedo.hpp"

namespace catchlight::render {

struct TransferOptions {
  int bands = 6;
  int rays = 512;   ///< rays of a vertex, over the hemisphere
  int bounces = 0;  ///< interreflections within the object, and between it and the receiver
  /// The receiver's albedo counts where `bounces` and a grid are given: its light then reaches the object from its true place,
  /// darkened by the object, and only what lies above the plane counts as sky. Unknown: what is below is lit and as far away as
  /// the sky.
  ReceiverAlbedo receiver_albedo = {};
  std::uint32_t seed = 1;
  int threads = 0;  ///< 0: all cores. The result does not depend on it.
};

}  // namespace catchlight::render
