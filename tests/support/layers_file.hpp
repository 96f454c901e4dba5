// Reads what `overlay -o %04d.exr` wrote, channel by channel, by OpenEXR alone.
#pragma once

#include <string>

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"

namespace catchlight::tests {

struct LayersFile {
  Layers layers;
  Image rgba, matte;  ///< channels R G B A and matte.A
};

/// Throws what OpenEXR does where a channel is missing.
LayersFile read_layers(const std::string& path);

}  // namespace catchlight::tests
