// Glare on processors against the passes that a card draws: excess, spread and look-up, of whatever is dealt out by chance.
#include <algorithm>
#include <cmath>
#include <random>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/cpu/glare/grid_glare.hpp"
#include "render/glare/glare_kernel.hpp"
#include "render/settings.hpp"
#include "tests/support/glare_fixture.hpp"

namespace catchlight::render::test {
namespace {

class GridGlareGl : public GlTest {};

struct Frame {
  const char* name;
  int width, height;
  PixelRect rect;  ///< of the object
  int hot_pixels;
};

/// Dim light with holes, and some pixels far above white, alone and in blots.
Image object_of(const Frame& frame, unsigned seed) {
  Image object(frame.rect.width, frame.rect.height, 4);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  for (int y = 0; y < object.height; ++y)
    for (int x = 0; x < object.width; ++x) {
      float* rgba = object.pixel(x, y);
      if (share(random) < 0.3f) continue;
      for (int c = 0; c < 3; ++c) rgba[c] = 0.9f * share(random);
      rgba[3] = 1;
    }
  for (int i = 0; i < frame.hot_pixels; ++i) {
    const int size = std::min({1 + static_cast<int>(3 * share(random)), object.width, object.height});
    const int left = static_cast<int>(share(random) * static_cast<float>(object.width - size));
    const int top = static_cast<int>(share(random) * static_cast<float>(object.height - size));
    const float light = std::exp2(3 + 9 * share(random));
    for (int y = top; y < top + size; ++y)
      for (int x = left; x < left + size; ++x)
        for (int c = 0; c < 3; ++c) object.pixel(x, y)[c] = light * share(random);
  }
  return object;
}

/// A part of the object's light that it emits.
Image emission_of(const Image& object, unsigned seed) {
  Image emission(object.width, object.height, 3);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(-0.5f, 1);
  for (int y = 0; y < object.height; ++y)
    for (int x = 0; x < object.width; ++x) {
      const float emitted = std::max(share(random), 0.0f);
      for (int c = 0; c < 3; ++c) emission.pixel(x, y)[c] = emitted * object.pixel(x, y)[c];
    }
  return emission;
}

GlTexture uploaded(const Image& image) {
  GlTexture texture = make_texture_2d("picture", GL_RGBA32F, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, image.channels == 4 ? GL_RGBA : GL_RGB, GL_FLOAT,
                      image.data.data());
  return texture;
}

/// Everything near the peak, in shares of it.
void expect_alike(const Image& ours, const Image& theirs, const std::string& what) {
  ASSERT_EQ(ours.data.size(), theirs.data.size());
  const double peak = *std::max_element(theirs.data.begin(), theirs.data.end());
  double most = 0, sum = 0;
  for (std::size_t i = 0; i < ours.data.size(); ++i) {
    const double difference = std::abs(static_cast<double>(ours.data[i]) - theirs.data[i]);
    most = std::max(most, difference), sum += difference;
  }
  EXPECT_GT(peak, 0) << what;
  EXPECT_LT(most / peak, 3e-5) << what;  // GLSL rounds the places of pixels on the grid
  EXPECT_LT(sum / static_cast<double>(ours.data.size()) / peak, 1e-7) << what;
}

Image rows_read(const GridGlare& glare, const Frame& frame) {
  Image picture(frame.width, frame.height, 3);
  for (int y = 0; y < frame.height; ++y) glare.read_row(0, y, frame.width, picture.pixel(0, y));
  return picture;
}

void compare(const GlareSettings& settings, const Frame& frame, const std::string& what, bool with_emission = false) {
  const Image object = object_of(frame, 7), emission = emission_of(object, 8);
  ShaderLibrary shaders;
  GlarePass pass(settings, shaders);
  GridGlare ours(settings);
  const GlTexture drawn = uploaded(object), emitted = uploaded(emission);
  ASSERT_TRUE(pass.extract(drawn, with_emission ? &emitted : nullptr, frame.rect, frame.width, frame.height));
  ASSERT_TRUE(ours.extract(object, with_emission ? &emission : nullptr, frame.rect, frame.width, frame.height));
  const PixelRect reach = pass.spread();
  EXPECT_EQ(ours.spread({}), reach) << what;
  const std::string name = what + ", " + frame.name;
  expect_alike(ours.read_excess(), pass.read_excess(), "excess, " + name);
  expect_alike(ours.read_glare(), pass.read_glare(), "glare, " + name);
  Image looked_up = at_frame_pixels(pass.read_glare(), pass.grid(), frame.width, frame.height);
  for (float& value : looked_up.data) value = std::max(value, 0.0f);
  expect_alike(rows_read(ours, frame), looked_up, "rows, " + name);
}

const std::vector<Frame> kFrames{
    {"whole frame", 640, 480, {0, 0, 640, 480}, 40},       {"odd size", 961, 541, {333, 101, 217, 311}, 20},
    {"upper left corner", 1280, 720, {0, 0, 301, 203}, 3}, {"lower right corner", 1279, 719, {1000, 600, 279, 119}, 3},
    {"small frame", 161, 119, {20, 3, 90, 116}, 5},        {"one pixel", 1920, 1080, {901, 503, 1, 1}, 1},
    {"upright", 405, 719, {11, 300, 381, 290}, 30}};

TEST_F(GridGlareGl, IsThatOfTheCard) {
  for (const Frame& frame : kFrames) compare({}, frame, "defaults");
}

TEST_F(GridGlareGl, IsThatOfTheCardWithEverySetting) {
  const auto with = [](auto change) {
    GlareSettings settings;
    change(settings);
    return settings;
  };
  const std::vector<std::pair<const char*, GlareSettings>> all{
      {"turned", with([](GlareSettings& s) { s.streak_rotation_deg = 20; })},
      {"upright star", with([](GlareSettings& s) { s.streak_rotation_deg = 0, s.streak_directions = 6; })},
      {"thin streaks", with([](GlareSettings& s) { s.streak_width = 0.001, s.streak_rotation_deg = 70; })},
      {"wide streaks", with([](GlareSettings& s) { s.streak_width = 0.02, s.streak_directions = 3; })},
      {"dispersion", with([](GlareSettings& s) { s.streak_dispersion = 1, s.streak_attenuation = 0.97; })},
      {"two passes", with([](GlareSettings& s) { s.streak_passes = 2, s.streak_attenuation = 0.5; })},
      {"bloom alone", with([](GlareSettings& s) { s.streak_strength = 0; })},
      {"streaks alone", with([](GlareSettings& s) { s.bloom_strength = 0; })},
      {"fine grid", with([](GlareSettings& s) { s.grid_rows = 333; })},
      {"coarse grid", with([](GlareSettings& s) { s.grid_rows = 50; })},
      {"low threshold", with([](GlareSettings& s) { s.threshold = 0.3, s.brightest = 2; })}};
  for (const auto& [name, settings] : all)
    for (const Frame& frame : {kFrames[1], kFrames[4]}) compare(settings, frame, name);
}

TEST_F(GridGlareGl, IsThatOfTheCardForLightThatIsEmitted) {
  GlareSettings settings;
  settings.emitter_strength = 0.3;
  for (const int directions : {0, 6}) {
    settings.emitter_directions = directions;
    for (const Frame& frame : {kFrames[0], kFrames[3]}) compare(settings, frame, "emission", true);
  }
}

}  // namespace
}  // namespace catchlight::render::test
