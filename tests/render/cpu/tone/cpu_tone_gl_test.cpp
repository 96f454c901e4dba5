// Meter, classic glare and tone on processors against a card's, on light that is dealt out by chance.
#include "render/cpu/tone/cpu_tone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catchlight/color.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "render/cpu/glare/classic_glare.hpp"
#include "render/gl/read_back.hpp"
#include "render/passes/tone_pass.hpp"
#include "shaders/interface.h"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {
namespace {

class CpuToneGl : public GlTest {};

struct Size {
  int width, height;
};
constexpr Size kSizes[] = {{640, 480}, {961, 541}, {320, 241}, {1, 1}};

/// Light over many stops, with highlights and what is no light at all.
Image random_light(const Size& size, bool with_bad = true) {
  Image light(size.width, size.height, 4);
  std::mt19937 random(11);
  std::normal_distribution<float> stops(-3, 1.5);
  std::uniform_real_distribution<float> share(0, 1);
  for (std::size_t i = 0; i < light.data.size(); ++i) light.data[i] = i % 4 == 3 ? 1 : std::exp2(stops(random));
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -3, 1e12f};
  for (int i = 0; i < 30; ++i) {
    const std::size_t pixel = static_cast<std::size_t>(share(random) * static_cast<float>(light.data.size() / 4 - 1));
    for (std::size_t c = 0; c < 3; ++c) light.data[4 * pixel + c] = std::exp2(8 * share(random));
    if (with_bad && i % 5 == 0) light.data[4 * pixel + static_cast<std::size_t>(i) % 3] = bad[(i / 5) % 4];
  }
  return light;
}

/// Larger than the picture, as targets are; what lies beyond is bright and must not count.
GlTexture texture_of(const Image& light) {
  const int width = roomy(light.width), height = roomy(light.height);
  GlTexture texture = make_texture_2d("test light", GL_RGBA32F, width, height);
  const float bright[4] = {1e6f, 1e6f, 1e6f, 1};
  glClearTexImage(texture.id(), 0, GL_RGBA, GL_FLOAT, bright);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, light.width, light.height, GL_RGBA, GL_FLOAT, light.data.data());
  return texture;
}

Image read(const GlTexture& texture, int size) {
  Image image(size, size, 4);
  glGetTextureImage(texture.id(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(image.data.size() * sizeof(float)),
                    image.data.data());
  return image;
}

void expect_alike(const GlarePicture& ours, const Image& theirs, const char* what) {
  float peak = 0, most = 0;
  for (int y = 0; y < theirs.height; ++y)
    for (int x = 0; x < theirs.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const Span lit = ours.lit(y);
        const float value = x >= lit.begin && x < lit.end ? ours.row(y)[x][c] : 0;
        peak = std::max(peak, theirs.pixel(x, y)[c]);
        most = std::max(most, std::abs(value - theirs.pixel(x, y)[c]));
      }
  EXPECT_LT(most, 3e-5f * peak) << what << ", peak " << peak;
}

TEST_F(CpuToneGl, ClassicGlareIsThatOfTheCard) {
  GlareSettings settings;
  settings.threshold = 0.7;
  for (const Size& size : kSizes) {
    const Image light = random_light(size, false);
    ShaderLibrary shaders;
    ClassicLook look(shaders);
    look.draw(texture_of(light), size.width, size.height, settings.threshold, classic_attenuation(settings.streak_attenuation));
    ClassicGlare ours(settings);
    ours.draw(light);
    expect_alike(ours.bright(), read(look.bright(), 512), "bright");
    expect_alike(ours.bloom(), read(look.bloom(), 512), "bloom");
    expect_alike(ours.streaks(), read(look.streaks(), 128), "streaks");
  }
}

TEST_F(CpuToneGl, MetersAsTheCardDoes) {
  const glm::dvec3 weights = luminance_weights(glm::mat3(0.9f, 0.1f, 0, 0.05f, 0.9f, 0, 0.05f, 0, 1));
  for (const Size& size : kSizes) {
    const Image light = random_light(size);
    ShaderLibrary shaders;
    const LuminanceHistogram theirs = ToneMeter(shaders).measure(texture_of(light), size.width, size.height, weights);
    const LuminanceHistogram ours = measure_luminances(light, weights);
    std::int64_t pixels = 0, elsewhere = 0;
    for (std::size_t bin = 0; bin < ours.bins.size(); ++bin) {
      pixels += static_cast<std::int64_t>(ours.bins[bin].count) - theirs.bins[bin].count;
      elsewhere += std::abs(static_cast<std::int64_t>(ours.bins[bin].count) - theirs.bins[bin].count);
    }
    EXPECT_EQ(pixels, 0);
    EXPECT_LE(elsewhere, size.width * size.height / 10000) << "rounding moves few into the next bin";
    const SceneLuminance a = scene_luminance(ours), b = scene_luminance(theirs);
    EXPECT_NEAR(a.average / b.average, 1, 1e-7);
    EXPECT_NEAR(a.low / b.low, 1, 1e-6);
    EXPECT_NEAR(a.high / b.high, 1, 1e-6);
  }
}

std::shared_ptr<const ResponseCurve> film() {
  ResponseCurve::Tables tables;
  for (std::vector<float>& channel : tables)
    for (int i = 0; i <= 100; ++i) channel.push_back(static_cast<float>(std::pow(i / 100.0, 2.0) + 0.001 * i));
  return std::make_shared<ResponseCurve>(tables);
}

struct Case {
  const char* name;
  Look look;
  bool is_toned, codes_end_at_1;
  int mode;
  PlateColor color;
};

PlateColor color_of(TransferFunction transfer) {
  PlateColor color;
  color.transfer = transfer;
  return color;
}

std::vector<Case> cases() {
  PlateColor curve, wide = color_of(TransferFunction::srgb);
  curve.curve = film();
  wide.plate_from_rec709 = glm::mat3(0.9f, 0.1f, 0, 0.05f, 0.9f, 0, 0.05f, 0, 1);
  return {{"srgb, camera", Look::camera, true, true, TRANSFER_SRGB, color_of(TransferFunction::srgb)},
          {"srgb, classic", Look::classic, true, true, TRANSFER_SRGB, color_of(TransferFunction::srgb)},
          {"classic without tone", Look::classic, false, true, TRANSFER_SRGB, wide},
          {"float codes", Look::classic, true, false, TRANSFER_LINEAR, color_of(TransferFunction::linear)},
          {"pq", Look::camera, true, true, TRANSFER_PQ, color_of(TransferFunction::pq)},
          {"hlg", Look::camera, true, true, TRANSFER_HLG, color_of(TransferFunction::hlg)},
          {"gamma", Look::camera, true, true, TRANSFER_GAMMA22, color_of(TransferFunction::gamma22)},
          {"curve", Look::camera, true, true, TRANSFER_CURVE, curve}};
}

void bind_composite(const Case& each, UniformBuffer<shader_interface::CompositeUniforms>& uniforms, GlBuffer& response) {
  shader_interface::CompositeUniforms block{};
  block.modes = {each.mode, each.codes_end_at_1 ? 1 : 0, 0, 1};
  uniforms.update(block);
  uniforms.bind(BINDING_COMPOSITE);
  if (!each.color.curve) return;
  std::vector<float> light;
  for (const std::vector<float>& channel : each.color.curve->light()) light.insert(light.end(), channel.begin(), channel.end());
  response = make_buffer("response", std::span<const float>(light));
  bind_storage(BINDING_RESPONSE, response.id());
}

TEST_F(CpuToneGl, CodesAreThoseOfTheCard) {
  for (const Case& each : cases())
    for (const Size& size : kSizes) {
      CompositorSettings settings;
      settings.look = each.look;
      settings.tone.enabled = each.is_toned;
      // Infinite light would make a bloom beside whose rounding all else is nothing.
      Image light = random_light(size, each.look == Look::camera);
      ShaderLibrary shaders;
      UniformBuffer<shader_interface::CompositeUniforms> uniforms("composite");
      GlBuffer response;
      bind_composite(each, uniforms, response);
      TonePass pass(settings, shaders);
      const GlTexture drawn = texture_of(light);
      const ToneCurve curve = pass.meter(drawn, size.width, size.height, each.color);
      pass.draw_glare(drawn, size.width, size.height);
      pass.draw(drawn, size.width, size.height, each.color, curve);
      const RawVector<float> theirs = pass.read();

      CpuTone ours(settings);
      const ToneCurve metered = ours.meter(light, each.color);
      EXPECT_NEAR(metered.gain / curve.gain, 1, 1e-6) << each.name;
      EXPECT_NEAR(metered.white / curve.white, 1, 1e-6) << each.name;
      ours.apply(light, each.color, curve, each.codes_end_at_1);
      ASSERT_EQ(light.data.size(), theirs.size());
      double most = 0;
      for (std::size_t i = 0; i < theirs.size(); ++i)
        most = std::max<double>(most, std::abs(light.data[i] - theirs[i]) / std::max(std::abs(theirs[i]), 1.0f));
      // A card rounds where between the texels of the classic glare a pixel lies.
      EXPECT_LT(most, each.look == Look::camera ? 1e-5 : 1e-4) << each.name << ", " << size.width;
    }
}

}  // namespace
}  // namespace catchlight::render::test
