// The layers of a frame that nothing virtual reached.
#pragma once

#include "app/media/pixels/frame.hpp"
#include "catchlight/composite.hpp"

namespace catchlight::app {

Layers untouched_layers(const Frame& frame);

}  // namespace catchlight::app
