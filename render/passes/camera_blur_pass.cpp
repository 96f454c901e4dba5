#include "render/passes/camera_blur_pass.hpp"

#include "render/gl/read_back.hpp"
#include "shaders/interface.h"

namespace catchlight::render {

CameraBlur::CameraBlur(ShaderLibrary& shaders)
    : gaussian_(shaders.program(fullscreen("defocus.frag"))), motion_(shaders.program(fullscreen("motion_blur.frag"))) {}

const GlTexture& CameraBlur::apply(const CameraBlurPlan& plan, const MotionField& motion, const GlTexture& sharp,
                                   const PixelRect& rect) {
  const int width = roomy(rect.width), height = roomy(rect.height);
  for (auto& target : targets_)
    if (!target || !target->fits(width, height))
      target = std::make_unique<ColorTarget<1>>("lens blur", GL_RGBA32F, width, height);
  const glm::ivec2 size(rect.width, rect.height);
  const GlTexture* from = &sharp;
  const auto draw = [&](const Program& program) {
    latest_ = 1 - latest_;
    glBindTextureUnit(TEXTURE_SOURCE, from->id());
    draw_.over({0, 0, size.x, size.y}, targets_[latest_]->framebuffer(), program);
    from = &targets_[latest_]->texture();
  };
  if (plan.variance_px2 > 0) {
    const std::vector<float> weights = discrete_gaussian(plan.variance_px2);
    gaussian_.set("size", size);
    gaussian_.set("count", static_cast<int>(weights.size()));
    gaussian_.set("weights", weights);
    for (const glm::ivec2 step_px : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
      gaussian_.set("step_px", step_px);
      draw(gaussian_);
    }
  }
  if (plan.moves) {
    motion_.set("size", size);
    motion_.set("motion_px", glm::vec2(motion.at(glm::dvec2(rect.x, rect.y))));
    motion_.set("change", glm::mat2(motion.change));
    draw(motion_);
  }
  return *from;
}

Image CameraBlur::read(int width, int height) const {
  return read_back(targets_[latest_]->framebuffer(), 0, width, height, 4);
}

}  // namespace catchlight::render
