#include "app/window/panels/waveform_panel.hpp"

#include <imgui.h>

#include <bit>

#include "app/window/panels/waveform.hpp"

namespace catchlight::app {
namespace {

constexpr int kLumaColumns = 320, kParadeColumns = 106;

void upload(render::GlTexture& texture, const RgbPicture& picture) {
  if (texture.id() == 0) texture = render::make_texture_2d("waveform", GL_RGB8, picture.width, picture.height, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, picture.rgb.data());
}

/// Lines at a quarter of the codes each; their middle is code 127.5.
void draw_graph(const render::GlTexture& texture) {
  const ImVec2 corner = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 8 * ImGui::GetTextLineHeight()};
  ImGui::Image(std::bit_cast<ImTextureID>(std::uintptr_t{texture.id()}), size);
  for (const float share : {0.25f, 0.5f, 0.75f}) {
    const float y = corner.y + share * size.y;
    ImGui::GetWindowDrawList()->AddLine({corner.x, y}, {corner.x + size.x, y}, IM_COL32(255, 255, 255, 28));
  }
}

}  // namespace

void WaveformPanel::count(const DrawnFrame& frame) {
  upload(luma_, luma_waveform(waveform_of(frame.composite, kLumaColumns)));
  upload(parade_, rgb_parade(waveform_of(frame.composite, kParadeColumns)));
}

void WaveformPanel::draw(const std::shared_ptr<const DrawnFrame>& frame) {
  if (frame != counted_) count(*frame);
  counted_ = frame;
  draw_graph(luma_);
  draw_graph(parade_);
}

}  // namespace catchlight::app
