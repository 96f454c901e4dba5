// The classic look, stage by stage, against the same chain by loops in double precision.
#include "catchlight/color.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "render/frame_view.hpp"
#include "render/gl/read_back.hpp"
#include "render/gl_compositor.hpp"
#include "render/passes/glare/classic_glare.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace catchlight::render::test {
namespace {

class ClassicLookGl : public GlTest {};

constexpr double kAttenuation = 0.9;

/// A picture of one channel, square or not.
struct Plane {
  int width, height;
  std::vector<double> values;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h) {}
  double& at(int x, int y) { return values[static_cast<std::size_t>(y) * width + x]; }
  double at(int x, int y) const { return values[static_cast<std::size_t>(y) * width + x]; }
  double or_zero(int x, int y) const { return x < 0 || y < 0 || x >= width || y >= height ? 0 : at(x, y); }
};

Plane shrunk(const Plane& source, int factor) {
  Plane result(source.width / factor, source.height / factor);
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) result.at(x / factor, y / factor) += source.at(x, y) / (factor * factor);
  return result;
}

/// The blur with all 15 x 15 taps at once.
double blurred(const Plane& source, int x, int y) {
  double sum = 0, weights = 0;
  for (int j = -7; j <= 7; ++j) {
    for (int i = -7; i <= 7; ++i) {
      const double weight = std::exp(-(i * i + j * j) / 18.0);
      sum += weight * source.or_zero(x + i, y + j);
      weights += weight;
    }
  }
  return sum / weights;
}

/// The value at (u, v) in 0..1 between texels of `value`, clamped to the edge.
double bilinear(int size, double u, double v, const std::function<double(int, int)>& value) {
  const double x = std::clamp(u * size - 0.5, 0.0, size - 1.0), y = std::clamp(v * size - 0.5, 0.0, size - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y), x1 = std::min(x0 + 1, size - 1), y1 = std::min(y0 + 1, size - 1);
  const double s = x - x0, t = y - y0;
  return (value(x0, y0) * (1 - s) + value(x1, y0) * s) * (1 - t) + (value(x0, y1) * (1 - s) + value(x1, y1) * s) * t;
}

double bloom_by_loop(const Plane& bright_512, int x, int y) {
  const double u = (x + 0.5) / 512, v = (y + 0.5) / 512;
  double sum = blurred(bright_512, x, y);
  for (const int size : {256, 64}) {
    const Plane bright = shrunk(bright_512, 512 / size);
    sum += bilinear(size, u, v, [&](int i, int j) { return blurred(bright, i, j); });
  }
  return sum;
}

double streaks_by_loop(const Plane& bright_512, int x, int y) {
  const Plane bright = shrunk(bright_512, 4);
  double sum = 0;
  for (const int dx : {-1, 1})
    for (const int dy : {-1, 1})
      for (int k = 0; k < 64; ++k) sum += 0.25 * std::pow(kAttenuation, k) * bright.or_zero(x - k * dx, y - k * dy);
  return sum;
}

Image read(const GlTexture& texture, int size) {
  const GlFramebuffer framebuffer = make_framebuffer("test");
  glNamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, texture.id(), 0);
  return read_back(framebuffer.id(), 0, size, size, 3);
}

GlTexture texture_of(const Image& image) {
  GlTexture texture = make_texture_2d("test light", GL_RGBA32F, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT, image.data.data());
  return texture;
}

void set(Image& image, int x, int y, const glm::vec3& light) {
  for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = light[c];
}

double sum_of(const Image& image) {
  double sum = 0;
  for (const float value : image.data) sum += value;
  return sum;
}

/// A few highlights on a dim picture of 512 x 512, and what is bright of it with threshold 1.
struct Highlights {
  Image image{512, 512};
  Plane bright{512, 512};

  Highlights() {
    std::fill(image.data.begin(), image.data.end(), 0.8f);
    for (const auto& [x, y, light] : {std::tuple{200, 301, 101.0f}, {203, 300, 11.0f}, {3, 2, 41.0f}, {509, 511, 21.0f}}) {
      set(image, x, y, glm::vec3(light));
      bright.at(x, y) = light - 1;
    }
  }
};

TEST_F(ClassicLookGl, BloomIsThreeGaussiansLaidOverEachOther) {
  const Highlights scene;
  ShaderLibrary shaders;
  ClassicLook look(shaders);
  look.draw(texture_of(scene.image), 512, 512, 1, kAttenuation);
  const Image bloom = read(look.bloom(), 512);
  for (const glm::ivec2& at :
       {glm::ivec2{200, 301}, {207, 301}, {193, 295}, {230, 290}, {255, 255}, {0, 0}, {511, 511}, {2, 30}}) {
    const double expected = bloom_by_loop(scene.bright, at.x, at.y);
    EXPECT_NEAR(bloom.pixel(at.x, at.y)[1], expected, 1e-4 * expected + 1e-7) << at.x << ", " << at.y;
  }
}

TEST_F(ClassicLookGl, StreaksFallAsAPowerAlongTheDiagonals) {
  const Highlights scene;
  ShaderLibrary shaders;
  ClassicLook look(shaders);
  look.draw(texture_of(scene.image), 512, 512, 1, kAttenuation);
  const Image streaks = read(look.streaks(), 128);
  for (int y = 0; y < 128; ++y) {
    for (int x = y % 3; x < 128; x += 3) {
      const double expected = streaks_by_loop(scene.bright, x, y);
      ASSERT_NEAR(streaks.pixel(x, y)[0], expected, 1e-4 * expected + 1e-7) << x << ", " << y;
    }
  }
}

TEST_F(ClassicLookGl, BrightPartsAreMeansOverTheirTexel) {
  Image image(641, 479);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> light(0, 8);
  for (float& value : image.data) value = light(random);
  ShaderLibrary shaders;
  ClassicLook look(shaders);
  look.draw(texture_of(image), 641, 479, 1, kAttenuation);
  const Image bright = read(look.bright(), 512);
  for (const glm::ivec2& texel : {glm::ivec2{0, 0}, {511, 511}, {100, 317}, {511, 0}}) {
    const glm::dvec2 scale(641.0 / 512, 479.0 / 512), first = glm::dvec2(texel) * scale, last = first + scale;
    glm::dvec3 sum(0);
    for (int y = 0; y < 479; ++y) {
      for (int x = 0; x < 641; ++x) {
        const double part = std::max(0.0, std::min(x + 1.0, last.x) - std::max<double>(x, first.x)) *
                            std::max(0.0, std::min(y + 1.0, last.y) - std::max<double>(y, first.y));
        const glm::dvec3 value(image.pixel(x, y)[0], image.pixel(x, y)[1], image.pixel(x, y)[2]);
        const double luminance = glm::dot(value, kLuminanceWeights);
        if (part > 0 && luminance > 1) sum += part * (luminance - 1) / luminance * value;
      }
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(bright.pixel(texel.x, texel.y)[c], sum[c] / (scale.x * scale.y), 1e-3) << texel.x << ", " << texel.y;
  }
}

TEST_F(ClassicLookGl, AMovingHighlightKeepsItsEnergy) {
  ShaderLibrary shaders;
  ClassicLook look(shaders);
  double first = 0;
  for (int x = 200; x < 210; ++x) {
    Image image(1920, 1080);
    set(image, x, 500, glm::vec3(51));
    look.draw(texture_of(image), 1920, 1080, 1, kAttenuation);
    const double energy = sum_of(read(look.bloom(), 512));
    if (x == 200) first = energy;
    EXPECT_NEAR(energy / first, 1, 0.001) << x;
  }
}

TEST_F(ClassicLookGl, NothingOverTheThresholdGivesNothing) {
  Image image(64, 48);
  std::fill(image.data.begin(), image.data.end(), 1.0f);
  ShaderLibrary shaders;
  ClassicLook look(shaders);
  look.draw(texture_of(image), 64, 48, 1, kAttenuation);
  EXPECT_EQ(sum_of(read(look.bloom(), 512)), 0);
  EXPECT_EQ(sum_of(read(look.streaks(), 128)), 0);
}

TEST_F(ClassicLookGl, NanAndInfinityStayInTheirPlace) {
  for (const float light : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image image(64, 48);
    set(image, 10, 10, glm::vec3(light));
    ShaderLibrary shaders;
    ClassicLook look(shaders);
    look.draw(texture_of(image), 64, 48, 1, kAttenuation);
    EXPECT_TRUE(std::isfinite(sum_of(read(look.bloom(), 512))));
    EXPECT_TRUE(std::isfinite(sum_of(read(look.streaks(), 128))));
  }
}

/// Through the compositor: scene + 0.2 bloom + 0.2 streaks in linear light, of the plate's highlights too.
TEST_F(ClassicLookGl, TheCompositeAddsBothInLinearLight) {
  const Highlights scene;
  FrameView view = linear_view_from_above();
  view.camera.width_px = view.camera.height_px = 512;
  view.has_pose = false;
  CompositorSettings settings;
  settings.look = Look::classic;
  settings.glare.bloom_strength = settings.glare.streak_strength = 0.2;
  settings.glare.streak_attenuation = std::pow(kAttenuation, 128.0 / 480);
  const PlateReader plate = plate_f32([&](int x, int y) { return glm::vec3(scene.image.pixel(x, y)[0]); });
  const RenderScene nothing = constant_scene({}, Material{}, glm::vec3(1));
  const auto expected = [&](int x, int y) {
    const double streaks =
        bilinear(128, (x + 0.5) / 512, (y + 0.5) / 512, [&](int i, int j) { return streaks_by_loop(scene.bright, i, j); });
    return 0.8 + 0.2 * bloom_by_loop(scene.bright, x, y) + 0.2 * streaks;
  };
  const Composite composite = GlCompositor(nothing, settings).render(view, plate);
  for (const glm::ivec2& at : {glm::ivec2{210, 311}, {190, 311}, {100, 100}, {202, 305}})
    EXPECT_NEAR(pixel_at(composite, at.x, at.y).r, expected(at.x, at.y), 1e-4) << at.x << ", " << at.y;

  settings.tone = {.enabled = true, .key = 0.72, .has_white_point = false};
  const Composite exposed = GlCompositor(nothing, settings).render(view, plate);
  const double light = 0.72 / 0.8 * expected(210, 311);  // few highlights: the log-average is the picture's 0.8
  EXPECT_NEAR(pixel_at(exposed, 210, 311).r, light / (1 + light), 1e-3);
}

}  // namespace
}  // namespace catchlight::render::test
