// Fast glare against the convolution with the kernel that it stands for: error and cost by passes, directions, resolutions and
// kernels, as CSV. Errors are in per cent of the reference's peak; times are the least of several runs of the same process.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>

#include "render/fft_convolution.hpp"
#include "render/glare_kernel.hpp"
#include "tests/render/glare_fixture.hpp"
#include "tests/render/glare_scenes.hpp"

namespace catchlight::render {
namespace {

using Clock = std::chrono::steady_clock;

template <typename Work>
double least_ms(int runs, const Work& work) {
  double least = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = Clock::now();
    work();
    glFinish();
    least = std::min(least, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return least;
}

struct Result {
  double largest, mean, fast_ms, reference_ms;
};

/// `excess_rows`: grid whose excess the reference is made from; 0: the fast passes' own.
Result measure(const GlareSettings& settings, const Image& picture, int excess_rows = 0) {
  const int width = picture.width, height = picture.height;
  GlarePass pass(settings, "");
  const test::Glared fast = test::glared(pass, picture);
  GlareSettings finer = settings;
  if (excess_rows > 0) finer.grid_rows = excess_rows;
  const test::Glared source = excess_rows > 0 ? test::glared(finer, picture) : fast;
  const Image excess = at_frame_pixels(source.excess, source.grid, width, height),
              glare = at_frame_pixels(fast.glare, fast.grid, width, height);
  GlareSettings whole = settings;
  whole.streak_passes = 0;
  const FftConvolution convolution(glare_kernel(whole, height, 2 * width - 1, 2 * height - 1), width, height);
  Image reference;
  Result result{};
  result.reference_ms = least_ms(3, [&] { reference = convolution.convolve(excess); });
  result.fast_ms = test::least_glare_ms(pass, picture, 3);
  double peak = 0;
  for (const float value : reference.data) peak = std::max<double>(peak, value);
  for (std::size_t i = 0; i < glare.data.size(); ++i) {
    const double d = std::abs(glare.data[i] - reference.data[i]);
    result.largest = std::max(result.largest, 100 * d / peak);
    result.mean += 100 * d / peak / static_cast<double>(glare.data.size());
  }
  return result;
}

class Table {
 public:
  explicit Table(std::ostream& out) : out_(out) { out_ << "ladder,scene,value,rows,largest_%,mean_%,fast_ms,reference_ms\n"; }
  void add(const char* ladder, const std::string& scene, double value, int rows, const Result& result) {
    out_ << ladder << ',' << scene << ',' << value << ',' << rows << ',' << result.largest << ',' << result.mean << ','
         << result.fast_ms << ',' << result.reference_ms << std::endl;
  }

 private:
  std::ostream& out_;
};

void run(std::ostream& out) {
  Table table(out);
  for (const test::NamedScene& scene : test::glare_scenes()) {
    for (const int rows : {480, 720, 1080})
      table.add("size", scene.name, rows, rows, measure({}, scene.make(rows * 4 / 3, rows)));
    const Image picture = scene.make(640, 480);
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
