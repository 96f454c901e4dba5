// Reads what `overlay -o %04d.exr` wrote, channel by channel, by OpenEXR alone.
#pragma once

#include <string>
#include <vector>

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::tests {

struct LayersFile {
  Layers layers;
  Image rgba, matte;  ///< channels R G B A and matte.A
};

/// Throws what OpenEXR does where a channel is missing.
LayersFile read_layers(const std::string& path);

/// Channels by their whole names. Throws as read_layers.
Image read_channels(const std::string& path, const std::vector<std::string>& names);

/// The attributes of a frame of a shot; those that the file lacks are empty.
render::ExrAttributes read_attributes(const std::string& path);

}  // namespace catchlight::tests
