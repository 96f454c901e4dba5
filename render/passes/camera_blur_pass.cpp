#include "render/passes/camera_blur_pass.hpp"

#include "shaders/interface.h"

namespace catchlight::render {

CameraBlur::CameraBlur(ShaderLibrary& shaders)
    : gaussian_(shaders.program(fullscreen("defocus.frag"))), motion_(shaders.program(fullscreen("motion_blur.frag"))) {}

void CameraBlur::apply(const CameraBlurPlan& plan, const GlTexture& object_sharp, const GlTexture& shadow_sharp,
                       const PixelRect& rect) {
  const int width = roomy(rect.width), height = roomy(rect.height);
  for (auto& target : targets_)
    if (!target || !target->fits(width, height))
      target = std::make_unique<ColorTarget<2>>("lens blur", GL_RGBA32F, width, height);
  const glm::ivec2 size(rect.width, rect.height);
  const GlTexture *from_object = &object_sharp, *from_shadow = &shadow_sharp;
  const auto draw = [&](const Program& program) {
    latest_ = 1 - latest_;
    glBindTextureUnit(TEXTURE_OBJECT, from_object->id());
    glBindTextureUnit(TEXTURE_SHADOW, from_shadow->id());
    draw_.over({0, 0, size.x, size.y}, targets_[latest_]->framebuffer(), program);
    from_object = &object(), from_shadow = &shadow();
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
    const glm::dvec2 corner(rect.x, rect.y);
    motion_.set("size", size);
    motion_.set("object_motion_px", glm::vec2(plan.object.at(corner)));
    motion_.set("object_change", glm::mat2(plan.object.change));
    motion_.set("shadow_motion_px", glm::vec2(plan.shadow.at(corner)));
    motion_.set("shadow_change", glm::mat2(plan.shadow.change));
    draw(motion_);
  }
}

}  // namespace catchlight::render
