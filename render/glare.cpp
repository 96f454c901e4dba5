#include "render/glare.hpp"

#include <algorithm>
#include <cmath>

#include "render/read_back.hpp"
#include "render/shader.hpp"
#include "shaders/interface.h"

namespace catchlight::render {
namespace {

/// How many texels beyond a pixel the first filter carries its light.
constexpr int kFilterReach = 2;

GlProgram fragment_program(const char* name, const std::string& folder) {
  return make_program({.vertex = "fullscreen.vert", .fragment = name, .captured = {}}, folder);
}

}  // namespace

GlarePass::GlarePass(const GlareSettings& settings, const std::string& shader_folder)
    : settings_(settings),
      filter_rows_("glare_filter.frag", shader_folder, "#define AXIS 0\n"),
      filter_rows_with_emission_("glare_filter.frag", shader_folder, "#define AXIS 0\n#define EMISSION\n"),
      filter_columns_("glare_filter.frag", shader_folder, "#define AXIS 1\n"),
      bright_(fragment_program("glare_bright.frag", shader_folder)),
      blur_(shader_folder),
      bloom_(shader_folder),
      streaks_(shader_folder),
      no_attributes_(make_vertex_array("no attributes")),
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
  bloom_.resize(grid_.columns, grid_.rows, grid_.rows_per_height(frame_height));
  narrow_.reset();
}

/// Pixel `first_pixel` of the frame is the first of `source_size` along the filter's axis.
void GlarePass::use_filter(const TapPrograms& programs, int first_pixel, int source_size) const {
  const GLuint program = programs.with(static_cast<int>(std::floor(4 * grid_.texel_px)) + 1);
  glUseProgram(program);
  glProgramUniform1i(program, 1, first_pixel);
  glProgramUniform1i(program, 2, source_size);
  glProgramUniform1f(program, 3, static_cast<float>(grid_.texel_px));
}

/// The object's light on the grid: first along the pixels' rows, then down the columns.
void GlarePass::filter(const GlTexture& object, const GlTexture* emission, const PixelRect& rect) {
  if (!filtered_rows_ || filtered_rows_->width() != grid_.columns || filtered_rows_->height() < rect.height)
    filtered_rows_ = std::make_unique<ColorTarget<1>>(make_glare_target("rows to glare", grid_.columns, roomy(rect.height)));
  clear(*light_);
  use_filter(emission ? filter_rows_with_emission_ : filter_rows_, rect.x, rect.width);
  glBindTextureUnit(TEXTURE_SOURCE, object.id());
  glBindTextureUnit(TEXTURE_EMISSION, (emission ? *emission : object).id());
  draw_over(*filtered_rows_, {bright_texels_.x, 0, bright_texels_.width, rect.height});
  use_filter(filter_columns_, rect.y, rect.height);
  glBindTextureUnit(TEXTURE_SOURCE, filtered_rows_->texture().id());
  draw_over(*light_, bright_texels_);
}

/// The excess comes in two parts beside its sum, ready for their own streaks.
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
  reset_state();
  glBindVertexArray(no_attributes_.id());
  bright_texels_ = grid_.texels(rect, kFilterReach);
  filter(object, emission, rect);
  divided_ = emission && settings_.emitter_directions != 0;
  if (divided_) attach_parts();
  clear(*excess_);
  glUseProgram(bright_.id());
  glProgramUniform1f(bright_.id(), 0, std::max(static_cast<float>(settings_.threshold), 1e-6f));
  glProgramUniform1f(bright_.id(), 1, static_cast<float>(settings_.brightest));
  glProgramUniform1f(bright_.id(), 2, static_cast<float>(settings_.emitter_strength));
  glBindTextureUnit(TEXTURE_SOURCE, light_->texture().id());
  glBeginQuery(GL_ANY_SAMPLES_PASSED, any_bright_.id());
  draw_over(*excess_, bright_texels_);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint any = 0;
  glGetQueryObjectuiv(any_bright_.id(), GL_QUERY_RESULT, &any);
  return any != 0;
}

PixelRect GlarePass::spread() {
  reset_state();
  glBindVertexArray(no_attributes_.id());
  bloom_.shrink(excess_->texture(), bright_texels_);
  const double rows_per_height = grid_.rows_per_height(frame_height_);
  const auto [total, light] = bloom_.brightness();
  const GlareReach reach = glare_reach(settings_, rows_per_height, total);
  const int grow = static_cast<int>(std::ceil(std::max(reach.bloom_texels, reach.streak_texels)));
  const PixelRect texels = intersect({light.x - grow, light.y - grow, light.width + 2 * grow, light.height + 2 * grow},
                                     {0, 0, grid_.columns, grid_.rows});
  clear(*glow_);
  bloom_.blur(excess_->texture(), static_cast<float>(settings_.bloom_strength), *scratch_, *glow_, texels, blur_);
  if (settings_.streak_strength > 0) {
    StreakGrid on = streak_grid(settings_, rows_per_height);
    // The two parts of the excess are not in the pyramid.
    if (divided_) on = {0, std::pow(settings_.streak_width * rows_per_height, 2)};
    const GlTexture& source = divided_        ? reflected_->texture()
                              : on.level == 0 ? excess_->texture()
                                              : bloom_.level(on.level).shrunk.texture();
    add_streaks(source, settings_.streak_directions, on, reach.streak_texels, texels);
    if (divided_) add_streaks(emitted_->texture(), settings_.emitter_directions, on, reach.streak_texels, texels);
  }
  bloom_.gather(*glow_, texels);
  return intersect(grid_.pixels(texels), {0, 0, frame_width_, frame_height_});
}

void GlarePass::add_streaks(const GlTexture& source, int directions, const StreakGrid& on, double reach_texels,
                            const PixelRect& texels) {
  const double rows_per_height = grid_.rows_per_height(frame_height_) / std::exp2(on.level);
  const ColorTarget<1>& target = on.level == 0 ? *glow_ : bloom_.level(on.level).glow;
  const ColorTarget<1>& scratch = on.level == 0 ? *scratch_ : bloom_.level(on.level).scratch;
  const PixelRect reached = on.level == 0 ? texels : bloom_.texels_at(texels, on.level);
  if (!narrow_ || narrow_->width() != target.width() || narrow_->height() != target.height()) {
    narrow_ = std::make_unique<ColorTarget<1>>(make_glare_target("streak source", target.width(), target.height()));
    streaks_.resize(target.width(), target.height());
  }
  clear(*narrow_);
  streaks_.begin();
  const std::vector<double> wide = gaussian_taps(on.own_blur);
  const std::vector<float> taps(wide.begin(), wide.end());
  blur_.add(source, scratch, *narrow_, taps, reached);

  const glm::dvec3 log_per_texel = streak_log_per_height(settings_) / rows_per_height;
  const int passes = streak_pass_count(settings_, reach_texels / std::exp2(on.level));
  StreakTap half_of_first{{0, 0}, glm::vec3(0)};
  for (const glm::dvec2& direction : streak_directions(directions, settings_.streak_rotation_deg)) {
    // Neither their number nor the passes nor the resolution changes the brightness.
    const glm::dvec3 gain = settings_.streak_strength / directions / streak_sum(direction, log_per_texel, passes);
    streaks_.add(narrow_->texture(), streak_passes(direction, log_per_texel, passes, gain), target, reached);
    half_of_first.weight -= glm::vec3(0.5 * gain);
  }
  streaks_.add(narrow_->texture(), {{half_of_first}}, target, reached);
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
