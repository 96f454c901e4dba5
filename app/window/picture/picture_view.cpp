#include "app/window/picture/picture_view.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "catchlight/color.hpp"

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

/// Mid grey where both are the same, `gain` times their difference around it.
RgbPicture difference(const RgbPicture& a, const RgbPicture& b, float gain) {
  RgbPicture result{a.width, a.height, std::vector<unsigned char>(a.rgb.size())};
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    result.rgb[i] = static_cast<unsigned char>(std::clamp(128 + gain * (float{1} * a.rgb[i] - b.rgb[i]), 0.0f, 255.0f));
  return result;
}

/// Stops below and above mid grey in false colours: dark ones violet to blue, mid grey grey, bright ones yellow to red; what is
/// clipped white, what is crushed black.
RgbPicture zones(const RgbPicture& picture) {
  static constexpr unsigned char kColors[9][3] = {{70, 0, 110},   {50, 30, 170},  {30, 90, 200},  {30, 150, 140}, {120, 120, 120},
                                                  {110, 170, 60}, {220, 210, 50}, {240, 140, 30}, {230, 50, 40}};
  static const std::array<double, 256> light_of_code = [] {
    std::array<double, 256> light{};
    for (std::size_t code = 0; code < 256; ++code) light[code] = linear_from_srgb(static_cast<double>(code) / 255);
    return light;
  }();
  RgbPicture result{picture.width, picture.height, std::vector<unsigned char>(picture.rgb.size())};
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    const unsigned char* code = &picture.rgb[i];
    const int brightest = std::max({code[0], code[1], code[2]});
    const double light = 0.2126 * light_of_code[code[0]] + 0.7152 * light_of_code[code[1]] + 0.0722 * light_of_code[code[2]];
    const auto stop = static_cast<int>(std::lround(std::log2(std::max(light, 1e-6) / 0.18)));
    const unsigned char* color = kColors[std::clamp(stop, -4, 4) + 4];
    for (std::size_t c = 0; c < 3; ++c) result.rgb[i + c] = brightest >= 254 ? 255 : brightest <= 1 ? 0 : color[c];
  }
  return result;
}

}  // namespace

PictureView::Place PictureView::place(const DrawnFrame& frame) const {
  const glm::vec2 room = vec(ImGui::GetContentRegionAvail()), size(frame.plate.width, frame.plate.height);
  const float zoom = zoom_ > 0 ? zoom_ : std::max(std::min(room.x / size.x, room.y / size.y), kMinZoom);
  const glm::vec2 moved = zoom_ > 0 ? moved_px_ : glm::vec2(0);
  return {glm::round(vec(ImGui::GetCursorScreenPos()) + 0.5f * (room - zoom * size) + moved), zoom};
}

/// The wheel zooms around the pointer.
void PictureView::take_input(const Place& place, const glm::vec2& size_px) {
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
  else
    app::upload(first_, view == View::plate ? plate : view == View::truth && has_truth ? frame.truth : composite);
  if (view == View::split || view == View::flicker) app::upload(second_, other);
  uploaded_view_ = view, uploaded_gain_ = gain, uploaded_truth_ = against_truth;
}

/// The plate, or the truth, left of an edge that can be dragged, the composite right of it.
void PictureView::draw_split(const Place& place, const glm::vec2& size_px) {
  const glm::vec2 size = place.zoom * size_px;
  const float edge = place.corner_px.x + split_ * size.x;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddImage(id_of(second_), im(place.corner_px), {edge, place.corner_px.y + size.y}, {0, 0}, {split_, 1});
  list->AddLine({edge, place.corner_px.y}, {edge, place.corner_px.y + size.y}, IM_COL32(255, 255, 255, 160));
  const float x = ImGui::GetIO().MousePos.x;
  if (ImGui::IsWindowHovered() && ImGui::IsMouseDown(ImGuiMouseButton_Left))
    split_ = std::clamp((x - place.corner_px.x) / size.x, 0.0f, 1.0f);
}

void PictureView::look_under_pointer(const DrawnFrame& frame, const Place& place) {
  pixel_text_.clear();
  const glm::vec2 pointed = (vec(ImGui::GetIO().MousePos) - place.corner_px) / place.zoom;
  const glm::ivec2 pixel(glm::floor(pointed));
  pointed_px_ = glm::dvec2(pointed) - 0.5;  // (0, 0) is the middle of the first pixel
  if (!ImGui::IsWindowHovered() || pixel.x < 0 || pixel.y < 0 || pixel.x >= frame.plate.width || pixel.y >= frame.plate.height)
    return;
  const std::size_t at = 3 * (static_cast<std::size_t>(pixel.y) * frame.plate.width + static_cast<std::size_t>(pixel.x));
  const unsigned char *now = &frame.composite.rgb[at], *plate = &frame.plate.rgb[at];
  char text[128];
  std::snprintf(text, sizeof text, "(%d, %d)  composite %d %d %d  plate %d %d %d", pixel.x, pixel.y, now[0], now[1], now[2],
                plate[0], plate[1], plate[2]);
  pixel_text_ = text;
}

void PictureView::draw(const std::shared_ptr<const DrawnFrame>& frame, GuiItems& items) {
  if (!frame) return ImGui::TextUnformatted("Opening the footage …");
  if (frame != shown_ || uploaded_view_ != view || uploaded_gain_ != gain || uploaded_truth_ != against_truth) upload(*frame);
  shown_ = frame;
  const glm::vec2 size(width_, height_);
  take_input(place(*frame), size);
  const Place where = place(*frame);
  // Enlarged much, pixels are to be seen as they are.
  for (const render::GlTexture* texture : {&first_, &second_})
    glTextureParameteri(texture->id(), GL_TEXTURE_MAG_FILTER, where.zoom < kPixelZoom ? GL_LINEAR : GL_NEAREST);
  const bool shows_second = view == View::flicker && std::fmod(ImGui::GetTime(), 2 * kFlicker_s) < kFlicker_s;
  ImGui::GetWindowDrawList()->AddImage(id_of(shows_second ? second_ : first_), im(where.corner_px),
                                       im(where.corner_px + where.zoom * size));
  if (view == View::split) draw_split(where, size);
  look_under_pointer(*frame, where);
  ImGui::SetCursorScreenPos(im(where.corner_px));
  ImGui::Dummy(im(where.zoom * size));
  items.note("picture");
}

}  // namespace catchlight::app
