#include "tests/support/glare_fixture.hpp"

#include "render/settings.hpp"

namespace catchlight::render::test {

GlTexture upload(const Image& rgb) {
  GlTexture texture = make_texture_2d("picture", GL_RGBA32F, rgb.width, rgb.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, rgb.width, rgb.height, GL_RGB, GL_FLOAT, rgb.data.data());
  return texture;
}

Glared glared(GlarePass& pass, const Image& picture, const Image* emission) {
  const GlTexture object = upload(picture), emitted = emission ? upload(*emission) : GlTexture();
  Glared result{};
  result.any =
      pass.extract(object, emission ? &emitted : nullptr, {0, 0, picture.width, picture.height}, picture.width, picture.height);
  result.grid = pass.grid();
  if (!result.any) return result;
  result.reach = pass.spread();
  result.excess = pass.read_excess();
  result.glare = pass.read_glare();
  return result;
}

Glared glared(const GlareSettings& settings, const Image& picture, const Image* emission) {
  ShaderLibrary shaders;
  GlarePass pass(settings, shaders);
  return glared(pass, picture, emission);
}

double sum_of(const Image& image, int channel) {
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += 3) sum += image.data[i];
  return sum;
}

}  // namespace catchlight::render::test
