// Fast glare against the convolution with the kernel that it stands for: error and cost by passes, directions, resolutions and
// kernels, as CSV. Errors are in per cent of the reference's peak. Times are medians of runs that take turns; on Mesa's software
// rasteriser processor time of all threads, which other work on the machine disturbs least. Whole against
// whole: GlarePass against ApertureGlarePass, each from the drawn object to the texture that the composite reads; and what they
// do with the same excess: GlarePass::spread() against FftConvolution::convolve(). Neither counts the making of the kernel.
// The classic look's glare has a kernel of its own: it is scaled to the reference's energy, and what is left is its shape.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/util/statistics.hpp"
#include "render/glare/glare_kernel.hpp"
#include "render/math/fft_convolution.hpp"
#include "render/passes/glare/aperture_glare_pass.hpp"
#include "render/passes/glare/classic_glare.hpp"
#include "render/settings.hpp"
#include "tests/support/glare_fixture.hpp"
#include "tests/support/glare_scenes.hpp"

namespace catchlight::render {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRuns = 7;

/// The time that the work takes until the GPU is done.
template <typename Work>
double time_ms(const Work& work) {
  static const bool is_software = gl_info().renderer.find("llvmpipe") != std::string::npos;
  glFinish();
  const auto start = Clock::now();
  const std::clock_t processor_start = std::clock();
  work();
  glFinish();
  return is_software ? 1000.0 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC
                     : std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Times {
  double fast_ms, spread_ms, reference_ms, convolve_ms;
};

Times time_in_turns(const GlareSettings& settings, GlarePass& fast, const Image& picture, const FftConvolution& convolution,
                    const Image& excess) {
  const int width = picture.width, height = picture.height;
  const PixelRect whole{0, 0, width, height};
  const CameraModel camera{.width_px = width, .height_px = height, .fx_px = 1.0 * width, .fy_px = 1.0 * width};
  const GlTexture object = test::upload(picture);
  ApertureGlarePass reference(settings);
  if (reference.extract(object, whole, width, height)) reference.spread(camera);  // makes the kernel
  std::vector<double> fast_ms, spread_ms, reference_ms, convolve_ms;
  for (int run = 0; run < kRuns; ++run) {
    const double extract_ms = time_ms([&] { fast.extract(object, nullptr, whole, width, height); });
    spread_ms.push_back(time_ms([&] { fast.spread(); }));
    fast_ms.push_back(extract_ms + spread_ms.back());
    reference_ms.push_back(time_ms([&] {
      reference.extract(object, whole, width, height);
      reference.spread(camera);
    }));
    convolve_ms.push_back(time_ms([&] { convolution.convolve(excess); }));
  }
  return {median(fast_ms), median(spread_ms), median(reference_ms), median(convolve_ms)};
}

struct Result {
  double largest, mean;
  Times times;
};

Result compared(const Image& glare, const Image& reference, const Times& times) {
  Result result{0, 0, times};
  const double peak = *std::max_element(reference.data.begin(), reference.data.end());
  for (std::size_t i = 0; i < glare.data.size(); ++i) {
    const double d = std::abs(glare.data[i] - reference.data[i]);
    result.largest = std::max(result.largest, 100 * d / peak);
    result.mean += 100 * d / peak / static_cast<double>(glare.data.size());
  }
  return result;
}

/// `excess_rows`: grid whose excess the reference is made from; 0: the fast passes' own.
Result measure(const GlareSettings& settings, const Image& picture, int excess_rows = 0) {
  const int width = picture.width, height = picture.height;
  ShaderLibrary shaders;
  GlarePass pass(settings, shaders);
  const test::Glared fast = test::glared(pass, picture);
  GlareSettings finer = settings;
  if (excess_rows > 0) finer.grid_rows = excess_rows;
  const test::Glared source = excess_rows > 0 ? test::glared(finer, picture) : fast;
  const Image excess = at_frame_pixels(source.excess, source.grid, width, height),
              glare = at_frame_pixels(fast.glare, fast.grid, width, height);
  GlareSettings whole = settings;
  whole.streak_passes = 0;
  const FftConvolution convolution(glare_kernel(whole, height, 2 * width - 1, 2 * height - 1), width, height);
  const Image reference = convolution.convolve(excess);
  return compared(glare, reference, time_in_turns(settings, pass, picture, convolution, excess));
}

/// A square texture stretched over the picture, bilinearly; adds `weight` of it.
void add_stretched(const GlTexture& texture, int size, double weight, Image& picture) {
  Image square(size, size, 3);
  glGetTextureImage(texture.id(), 0, GL_RGB, GL_FLOAT, static_cast<GLsizei>(square.data.size() * sizeof(float)),
                    square.data.data());
  const auto at = [&](double place, double pixels) { return std::clamp((place + 0.5) / pixels * size - 0.5, 0.0, size - 1.0); };
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double u = at(x, picture.width), v = at(y, picture.height);
      const int left = static_cast<int>(u), top = static_cast<int>(v);
      const int right = std::min(left + 1, size - 1), bottom = std::min(top + 1, size - 1);
      for (int c = 0; c < 3; ++c) {
        const double above = std::lerp(square.pixel(left, top)[c], square.pixel(right, top)[c], u - left);
        const double below = std::lerp(square.pixel(left, bottom)[c], square.pixel(right, bottom)[c], u - left);
        picture.pixel(x, y)[c] += static_cast<float>(weight * std::lerp(above, below, v - top));
      }
    }
}

/// The classic look's glare, against the default kernel's.
Result measure_classic(const Image& picture) {
  const int width = picture.width, height = picture.height;
  GlareSettings settings;
  ShaderLibrary shaders;
  GlarePass pass(settings, shaders);
  const test::Glared fast = test::glared(pass, picture);
  const Image excess = at_frame_pixels(fast.excess, fast.grid, width, height);
  settings.streak_passes = 0;
  const FftConvolution convolution(glare_kernel(settings, height, 2 * width - 1, 2 * height - 1), width, height);
  const Image reference = convolution.convolve(excess);
  const GlTexture object = test::upload(picture);
  ClassicLook look(shaders);
  std::vector<double> classic_ms, reference_ms;
  for (int run = 0; run < kRuns; ++run) {
    classic_ms.push_back(time_ms([&] { look.draw(object, width, height, 1, 0.9); }));
    reference_ms.push_back(time_ms([&] { convolution.convolve(excess); }));
  }
  Image glare(width, height);
  add_stretched(look.bloom(), 512, 1, glare);
  add_stretched(look.streaks(), 128, 1, glare);
  double energy = 0, wanted = 0;
  for (std::size_t i = 0; i < glare.data.size(); ++i) energy += glare.data[i], wanted += reference.data[i];
  for (float& value : glare.data) value = static_cast<float>(value * wanted / energy);
  return compared(glare, reference, {median(classic_ms), median(classic_ms), median(reference_ms), median(reference_ms)});
}

class Table {
 public:
  explicit Table(std::ostream& out) : out_(out) {
    out_ << "ladder,scene,value,rows,largest_%,mean_%,fast_ms,reference_ms,spread_ms,convolve_ms\n";
  }
  void add(const char* ladder, const std::string& scene, double value, int rows, const Result& result) {
    out_ << ladder << ',' << scene << ',' << value << ',' << rows << ',' << result.largest << ',' << result.mean << ','
         << result.times.fast_ms << ',' << result.times.reference_ms << ',' << result.times.spread_ms << ','
         << result.times.convolve_ms << std::endl;
  }

 private:
  std::ostream& out_;
};

void run(std::ostream& out) {
  Table table(out);
  for (const test::NamedScene& scene : test::glare_scenes()) {
    for (const int rows : {480, 720, 1080})
      table.add("size", scene.name, rows, rows, measure({}, scene.make(rows * 4 / 3, rows)));
  }
  for (const test::NamedScene& scene : test::glare_scenes()) {
    const Image picture = scene.make(640, 480);
    table.add("classic", scene.name, 0, 480, measure_classic(picture));
    GlareSettings settings;
    for (settings.streak_passes = 1; settings.streak_passes <= 4; ++settings.streak_passes)
      table.add("passes", scene.name, settings.streak_passes, 480, measure(settings, picture));
    settings = {};
    for (const int directions : {1, 2, 4, 6, 8}) {
      settings.streak_directions = directions;
      table.add("directions", scene.name, directions, 480, measure(settings, picture));
    }
    settings = {};
    for (const int rows : {60, 120, 240, 480}) {
      settings.grid_rows = rows;
      table.add("grid", scene.name, rows, 480, measure(settings, picture, 480));
    }
    settings = {};
    for (const double attenuation : {0.6, 0.8, 0.92, 0.98}) {
      settings.streak_attenuation = attenuation;
      table.add("kernel", scene.name, attenuation, 480, measure(settings, picture));
    }
  }
}

}  // namespace
}  // namespace catchlight::render

int main(int argc, char** argv) {
  try {
    const auto context = catchlight::render::make_headless_context();
    if (argc == 3 && std::string(argv[1]) == "--csv") {
      std::ofstream file(argv[2]);
      if (!file) throw catchlight::Error(std::string("cannot write ") + argv[2]);
      catchlight::render::run(file);
    } else if (argc == 1) {
      catchlight::render::run(std::cout);
    } else {
      std::cerr << "usage: glare_accuracy [--csv FILE]\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << "glare_accuracy: " << error.what() << '\n';
    return 1;
  }
}
