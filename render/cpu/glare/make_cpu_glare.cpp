#include "render/cpu/glare/make_cpu_glare.hpp"

#include "render/cpu/glare/aperture_glare.hpp"
#include "render/cpu/glare/grid_glare.hpp"

namespace catchlight::render {

std::unique_ptr<CpuGlare> make_cpu_glare(const GlareSettings& settings) {
  if (settings.method == GlareMethod::fft) return std::make_unique<ApertureGlare>(settings);
  return std::make_unique<GridGlare>(settings);
}

}  // namespace catchlight::render
