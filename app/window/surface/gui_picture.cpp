#include "app/window/surface/gui_picture.hpp"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "render/gl/gl_context.hpp"

namespace catchlight::app {

void GuiPicture::draw(const glm::ivec2& size_px) {
  ImGui::Render();
  if (!target_ || target_->width() != size_px.x || target_->height() != size_px.y)
    target_.emplace("window", GL_RGBA8, size_px.x, size_px.y);
  glBindFramebuffer(GL_FRAMEBUFFER, target_->framebuffer());
  glViewport(0, 0, size_px.x, size_px.y);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  render::check_gl("the window");
}

void GuiPicture::show() const {
  const int width = target_->width(), height = target_->height();
  glBlitNamedFramebuffer(target_->framebuffer(), 0, 0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

RgbPicture GuiPicture::read() const {
  RgbPicture result;
  if (!target_) return result;
  result.width = target_->width(), result.height = target_->height();
  const auto row = static_cast<std::ptrdiff_t>(3 * result.width);
  std::vector<unsigned char> upwards(static_cast<std::size_t>(row * result.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, result.width, result.height, GL_RGB, GL_UNSIGNED_BYTE, upwards.data());
  result.rgb.reserve(upwards.size());
  for (int y = result.height; y-- > 0;)
    result.rgb.insert(result.rgb.end(), upwards.begin() + row * y, upwards.begin() + row * (y + 1));
  return result;
}

}  // namespace catchlight::app
