#include "app/window/picture/picture_view.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/window/picture/false_colors.hpp"
#include "app/window/picture/pixel_text.hpp"

namespace catchlight::app {
namespace {

constexpr float kMinZoom = 0.05f, kMaxZoom = 64;
constexpr float kPixelZoom = 3;
constexpr double kFlicker_s = 0.5;

ImTextureID id_of(const render::GlTexture& texture) {
  return std::bit_cast<ImTextureID>(std::uintptr_t{texture.id()});
}

ImVec2 im(const glm::vec2& v) {
  return {v.x, v.y};
}

glm::vec2 vec(const ImVec2& v) {
  return {v.x, v.y};
}

void upload(const render::GlTexture& texture, const RgbPicture& picture) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, picture.rgb.data());
}

/// Which colour stands for which exposure, in the corner of the picture's room.
void draw_legend(float line_px) {
  const std::vector<Zone>& zones = exposure_zones();
  const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  const float width = 6.5f * line_px, height = line_px * static_cast<float>(zones.size()) + line_px;
  const ImVec2 from{corner.x + line_px / 2, corner.y + size.y - height - line_px / 2};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(from, {from.x + width, from.y + height}, IM_COL32(20, 20, 20, 220), 2);
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[zones.size() - 1 - i];
    const ImVec2 at{from.x + line_px / 2, from.y + line_px / 2 + line_px * static_cast<float>(i)};
    list->AddRectFilled(at, {at.x + 1.5f * line_px, at.y + line_px - 1}, IM_COL32(zone.rgb[0], zone.rgb[1], zone.rgb[2], 255));
    list->AddText({at.x + 2 * line_px, at.y}, IM_COL32(220, 220, 220, 255), zone.meaning.c_str());
  }
}

}  // namespace

PicturePlace PictureView::place(const DrawnFrame& frame) const {
  const glm::vec2 room = vec(ImGui::GetContentRegionAvail()), size(frame.plate.width, frame.plate.height);
  const float zoom = zoom_ > 0 ? zoom_ : std::max(std::min(room.x / size.x, room.y / size.y), kMinZoom);
  const glm::vec2 moved = zoom_ > 0 ? moved_px_ : glm::vec2(0);
  return {glm::round(vec(ImGui::GetCursorScreenPos()) + 0.5f * (room - zoom * size) + moved), zoom};
}

/// The wheel zooms around the pointer.
void PictureView::take_input(const PicturePlace& place, const glm::vec2& size_px) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsWindowHovered()) return;
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0)) {
    if (zoom_ == 0) zoom_ = place.zoom, moved_px_ = glm::vec2(0);
    moved_px_ += vec(io.MouseDelta);
  }
  if (io.MouseWheel == 0) return;
  const float zoom = std::clamp(place.zoom * std::pow(1.25f, io.MouseWheel), kMinZoom, kMaxZoom);
  const glm::vec2 pointed = (vec(io.MousePos) - place.corner_px) / place.zoom, middle = 0.5f * size_px;
  const glm::vec2 moved = zoom_ > 0 ? moved_px_ : glm::vec2(0);
  moved_px_ = moved + (place.zoom - zoom) * (pointed - middle);
  zoom_ = zoom;
}

FrameExtras PictureView::wanted() const {
  FrameExtras extras;
  if (is_layer(view)) extras.layer = view;
  if (view == View::light) extras.light = light;
  overlays.add_wanted(extras);
  return extras;
}

bool PictureView::shows_layer(const DrawnFrame& frame) const {
  return frame.layer && frame.layer->view == view && (view != View::light || frame.layer->light == light);
}

void PictureView::upload(const DrawnFrame& frame) {
  const RgbPicture &plate = frame.plate, &composite = frame.composite;
  const bool has_truth = !frame.truth.rgb.empty();
  const RgbPicture& other = against_truth && has_truth ? frame.truth : plate;
  if (width_ != plate.width || height_ != plate.height) {
    width_ = plate.width, height_ = plate.height;
    first_ = render::make_texture_2d("picture", GL_RGB8, width_, height_, GL_LINEAR);
    second_ = render::make_texture_2d("beside it", GL_RGB8, width_, height_, GL_LINEAR);
  }
  if (view == View::difference)
    app::upload(first_, difference(composite, other, gain));
  else if (view == View::zones)
    app::upload(first_, zones(composite));
  else if (shows_layer(frame))
    app::upload(first_, frame.layer->picture);
  else
    app::upload(first_, view == View::plate ? plate : view == View::truth && has_truth ? frame.truth : composite);
  if (view == View::split || view == View::flicker) app::upload(second_, other);
  uploaded_view_ = view, uploaded_gain_ = gain, uploaded_truth_ = against_truth;
}

/// The plate, or the truth, left of an edge that can be dragged, the composite right of it.
void PictureView::draw_split(const PicturePlace& place, const glm::vec2& size_px) {
  const glm::vec2 size = place.zoom * size_px;
  const float edge = place.corner_px.x + split_ * size.x;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddImage(id_of(second_), im(place.corner_px), {edge, place.corner_px.y + size.y}, {0, 0}, {split_, 1});
  list->AddLine({edge, place.corner_px.y}, {edge, place.corner_px.y + size.y}, IM_COL32(255, 255, 255, 160));
  const float x = ImGui::GetIO().MousePos.x;
  if (ImGui::IsWindowHovered() && ImGui::IsMouseDown(ImGuiMouseButton_Left))
    split_ = std::clamp((x - place.corner_px.x) / size.x, 0.0f, 1.0f);
}

void PictureView::look_under_pointer(const DrawnFrame& frame, const PicturePlace& place) {
  pixel_text_.clear();
  const glm::vec2 pointed = (vec(ImGui::GetIO().MousePos) - place.corner_px) / place.zoom;
  const glm::ivec2 pixel(glm::floor(pointed));
  pointed_px_ = glm::dvec2(pointed) - 0.5;  // (0, 0) is the middle of the first pixel
  if (!ImGui::IsWindowHovered() || pixel.x < 0 || pixel.y < 0 || pixel.x >= frame.plate.width || pixel.y >= frame.plate.height)
    return;
  pixel_text_ = '(' + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) + ")  ";
  if (shows_layer(frame)) pixel_text_ += layer_text(*frame.layer, pixel.x, pixel.y) + "  ";
  if (frame.composited) pixel_text_ += "composite " + app::pixel_text(*frame.composited, pixel.x, pixel.y) + "  ";
  if (frame.image && !shows_layer(frame)) pixel_text_ += "plate " + app::pixel_text(*frame.image, pixel.x, pixel.y);
}

void PictureView::draw(const std::shared_ptr<const DrawnFrame>& frame, GuiItems& items) {
  if (!frame) return ImGui::TextUnformatted("Opening the footage …");
  if (frame != shown_ || uploaded_view_ != view || uploaded_gain_ != gain || uploaded_truth_ != against_truth) upload(*frame);
  shown_ = frame;
  const glm::vec2 size(width_, height_);
  take_input(place(*frame), size);
  const PicturePlace where = place(*frame);
  // Enlarged much, pixels are to be seen as they are.
  for (const render::GlTexture* texture : {&first_, &second_})
    glTextureParameteri(texture->id(), GL_TEXTURE_MAG_FILTER, where.zoom < kPixelZoom ? GL_LINEAR : GL_NEAREST);
  const bool shows_second = view == View::flicker && std::fmod(ImGui::GetTime(), 2 * kFlicker_s) < kFlicker_s;
  ImGui::GetWindowDrawList()->AddImage(id_of(shows_second ? second_ : first_), im(where.corner_px),
                                       im(where.corner_px + where.zoom * size));
  if (view == View::split) draw_split(where, size);
  overlays.draw(frame, where);
  if (view == View::zones) draw_legend(ImGui::GetTextLineHeight());
  look_under_pointer(*frame, where);
  ImGui::SetCursorScreenPos(im(where.corner_px));
  ImGui::Dummy(im(where.zoom * size));
  items.note("picture");
}

}  // namespace catchlight::app
