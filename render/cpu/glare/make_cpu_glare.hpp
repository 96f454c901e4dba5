// The choice of a method of glare.
#pragma once

#include <memory>

#include "render/cpu/glare/cpu_glare.hpp"
#include "render/settings.hpp"

namespace catchlight::render {

/// Bloom and streaks on a grid, or what an aperture diffracts, as settings.method says. Throws Error where settings.aperture
/// cannot be used.
std::unique_ptr<CpuGlare> make_cpu_glare(const GlareSettings& settings);

}  // namespace catchlight::render
