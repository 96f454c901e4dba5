#include "render/passes/glare/glare_pass.hpp"

#include <algorithm>
#include <cmath>

#include "render/gl/read_back.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
GlarePass::GlarePass(const GlareSettings& settings, ShaderLibrary& shaders)
    : settings_(settings),
      shaders_(shaders),
      bright_(shaders.program(fullscreen("glare_bright.frag"))),
      tiles_(shaders),
      blur_(shaders),
      bloom_(shaders),
      streaks_(shaders),
      any_bright_(make_query(GL_ANY_SAMPLES_PASSED)) {}

void GlarePass::make_targets(int frame_width, int frame_height) {
  frame_width_ = frame_width;
  frame_height_ = frame_height;
  grid_ = make_glare_grid(frame_width, frame_height, settings_.grid_rows);
  const auto target = [&](const char* label) {
    return std::make_unique<ColorTarget<1>>(make_glare_target(label, grid_.columns, grid_.rows));
  };
  light_ = target("light to glare");
  excess_ = target("excess");
  reflected_.reset();
  emitted_.reset();
  scratch_ = target("glare rows");
  glow_ = target("glare");
  bloom_.resize(grid_, grid_.rows_per_height(frame_height));
  narrow_.reset();
}

const Program& GlarePass::axis_filter(std::vector<std::string> defines, int first_pixel, int source_size) {
  const int taps = static_cast<int>(std::floor(4 * grid_.texel_px)) + 1;
  Program& program = shaders_.program(fullscreen_with_taps("glare_filter.frag", taps, std::move(defines)));
  program.set("first_pixel", first_pixel);
  program.set("source_size", source_size);
  program.set("texel_px", static_cast<float>(grid_.texel_px));
  return program;
}

/// Brings the object's light onto the grid: first along the pixels' rows, then down the columns.
void GlarePass::filter(const GlTexture& object, const GlTexture* emission, const PixelRect& rect) {
  if (!filtered_rows_ || filtered_rows_->width() != grid_.columns || filtered_rows_->height() < rect.height)
    filtered_rows_ = std::make_unique<ColorTarget<1>>(make_glare_target("rows to glare", grid_.columns, roomy(rect.height)));
  std::vector<std::string> along_rows{"AXIS 0"};
  if (emission) along_rows.emplace_back("EMISSION");
  glBindTextureUnit(TEXTURE_SOURCE, object.id());
  glBindTextureUnit(TEXTURE_EMISSION, (emission ? *emission : object).id());
  std::vector<PixelRect> pixels;
  for (const PixelRect& texels : tiles_.grown(kLightReach, kLightReach + kFilterReach)) {
    const PixelRect rows = grid_.pixels(texels);
    pixels.push_back(intersect({texels.x, rows.y - rect.y, texels.width, rows.height}, {0, 0, grid_.columns, rect.height}));
  }
  draw_.over(pixels, *filtered_rows_, axis_filter(along_rows, rect.x, rect.width));
  glBindTextureUnit(TEXTURE_SOURCE, filtered_rows_->texture().id());
  draw_.over(tiles_.grown(kLightReach, kLightReach), *light_, axis_filter({"AXIS 1"}, rect.y, rect.height));
}

/// Lets the excess come in two parts beside its sum, for streaks of their own.
void GlarePass::attach_parts() {
  if (!emitted_) {
    for (auto* part : {&reflected_, &emitted_})
      *part = std::make_unique<ColorTarget<1>>(make_glare_target("part of the excess", grid_.columns, grid_.rows));
    const GLenum drawn[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glNamedFramebufferTexture(excess_->framebuffer(), drawn[1], reflected_->texture().id(), 0);
    glNamedFramebufferTexture(excess_->framebuffer(), drawn[2], emitted_->texture().id(), 0);
    glNamedFramebufferDrawBuffers(excess_->framebuffer(), 3, drawn);
  }
  clear(*reflected_);
  clear(*emitted_);
}

bool GlarePass::extract(const GlTexture& object, const GlTexture* emission, const PixelRect& rect, int frame_width,
                        int frame_height) {
  if (!glow_ || frame_width != frame_width_ || frame_height != frame_height_) make_targets(frame_width, frame_height);
  const float threshold = std::max(static_cast<float>(settings_.threshold), 1e-6f);
  if (!tiles_.find(object, rect, grid_, threshold)) return false;
  filter(object, emission, rect);
  divided_ = emission && settings_.emitter_directions != 0;
  if (divided_) attach_parts();
  clear(*excess_);
  bright_.set("threshold", threshold);
  bright_.set("brightest", static_cast<float>(settings_.brightest));
  bright_.set("emitter_strength", static_cast<float>(settings_.emitter_strength));
  glBindTextureUnit(TEXTURE_SOURCE, light_->texture().id());
  glBeginQuery(GL_ANY_SAMPLES_PASSED, any_bright_.id());
  draw_.over(tiles_.grown(kExcessReach, kExcessReach), *excess_, bright_);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint any = 0;
  glGetQueryObjectuiv(any_bright_.id(), GL_QUERY_RESULT, &any);
  return any != 0;
}

PixelRect GlarePass::spread() {
  const PixelRect light = intersect(around(tiles_.grown(kExcessReach, kExcessReach)), grid_.all());
  bloom_.shrink(excess_->texture(), light);
  const GlareSpread plan = plan_spread(settings_, grid_, frame_height_, light, bloom_.total(), divided_);
  for (int level = bloom_.coarsest(); level > 0; --level) {
    bloom_.glow(level, settings_.bloom_strength, plan.texels, blur_);
    if (level == plan.streaks.level) add_streaks(plan);
  }
  if (plan.texels != grid_.all()) clear(*glow_);
  bloom_.gather(*glow_, plan.texels);
  add_narrow_bloom();
  if (plan.streaks.level == 0) add_streaks(plan);
  return intersect(grid_.pixels(plan.texels), {0, 0, frame_width_, frame_height_});
}

/// Adds the part of the bloom that the grid itself is needed for, around the light alone.
void GlarePass::add_narrow_bloom() {
  for (const BloomBlur& each : bloom_.blurs()) {
    if (each.level > 0 || settings_.bloom_strength <= 0) continue;
    const double weight = settings_.bloom_strength * each.weight;
    const int reach = kExcessReach + static_cast<int>(each.taps.size()) - 1;
    clear(*scratch_);
    draw_.over(tiles_.grown(reach, kExcessReach), *scratch_, blur_.axis(excess_->texture(), 0, each.taps, weight));
    draw_.over(tiles_.grown(reach, reach), *glow_, blur_.axis(scratch_->texture(), 1, each.taps, weight), Blending::add);
  }
}

void GlarePass::add_streaks(const GlareSpread& plan) {
  if (settings_.streak_strength <= 0) return;
  const GlTexture& source = divided_                  ? reflected_->texture()
                            : plan.streaks.level == 0 ? excess_->texture()
                                                      : bloom_.level(plan.streaks.level).shrunk.texture();
  add_star(source, settings_.streak_directions, plan);
  if (divided_) add_star(emitted_->texture(), settings_.emitter_directions, plan);
}

void GlarePass::add_star(const GlTexture& source, int directions, const GlareSpread& plan) {
  const StreakGrid& on = plan.streaks;
  const ColorTarget<1>& target = on.level == 0 ? *glow_ : bloom_.level(on.level).glow;
  // Going down carries light less than two texels further.
  const auto at_level = [&](const PixelRect& r, int more) {
    return on.level == 0 ? intersect(r, grid_.all()) : texels_at(r, grid_, on.level, more);
  };
  const std::vector<double> taps = gaussian_taps(on.own_blur);
  const int reach = kExcessReach + (static_cast<int>(taps.size()) - 1) * (1 << on.level);
  const PixelRect light = at_level(around(tiles_.grown(reach, reach)), 2);
  const GlTexture* narrow = &source;
  if (taps.size() > 1) {
    const ColorTarget<1>& scratch = on.level == 0 ? *scratch_ : bloom_.level(on.level).scratch;
    if (!narrow_ || narrow_->width() != target.width() || narrow_->height() != target.height())
      narrow_ = std::make_unique<ColorTarget<1>>(make_glare_target("streak source", target.width(), target.height()));
    clear(*narrow_);
    blur_.add(source, scratch, *narrow_, taps, 1, light);
    narrow = &narrow_->texture();
  }
  const double texel = std::exp2(on.level);
  const Star star =
      plan_star(settings_, directions, grid_.rows_per_height(frame_height_) / texel, plan.streak_reach_texels / texel);
  streaks_.add(*narrow, light, star.arms, target, at_level(plan.texels, 3));
  const std::vector<std::vector<StreakSamples>> source_alone{{{1, {0, 0}, star.at_source, glm::dvec3(0)}}};
  streaks_.add(*narrow, light, source_alone, target, light);
}

Image GlarePass::read_excess() const {
  return read_back(excess_->framebuffer(), 0, grid_.columns, grid_.rows, 3);
}

Image GlarePass::read_glare() const {
  return read_back(glow_->framebuffer(), 0, grid_.columns, grid_.rows, 3);
}

glm::vec4 GlarePass::texels_from_frame() const {
  const auto per_pixel = static_cast<float>(1 / grid_.texel_px);
  return {per_pixel, per_pixel, GLARE_MARGIN, GLARE_MARGIN};
}

}  // namespace catchlight::render
