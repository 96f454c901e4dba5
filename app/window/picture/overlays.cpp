#include "app/window/picture/overlays.hpp"

#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/session/track_sketch.hpp"
#include "app/window/surface/gui_menu.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr ImU32 kHalo = IM_COL32(0, 0, 0, 170);
constexpr Rgb kReceiver{120, 220, 220}, kResidual{255, 220, 60};

ImVec2 im(const glm::vec2& v) {
  return {v.x, v.y};
}

ImU32 color_of(const Rgb& rgb) {
  return IM_COL32(rgb[0], rgb[1], rgb[2], 255);
}

void draw_strokes(const std::vector<Stroke>& strokes, const PicturePlace& place) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  std::vector<ImVec2> points;
  for (const bool is_halo : {true, false})
    for (const Stroke& stroke : strokes) {
      points.clear();
      for (const glm::dvec2& px : stroke.points_px) points.push_back(im(place.screen_px(px)));
      list->AddPolyline(points.data(), static_cast<int>(points.size()), is_halo ? kHalo : color_of(stroke.color), 0,
                        is_halo ? 3.5f : 1.5f);
    }
}

/// Words on a dark ground, so that they are read on any picture.
void draw_text(const glm::vec2& at, const Rgb& color, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(im(at - glm::vec2(4, 1)), {at.x + size.x + 4, at.y + size.y + 2}, kHalo, 2);
  list->AddText(im(at), color_of(color), text.c_str());
}

void draw_tags(const DrawnFrame& frame, const PicturePlace& place) {
  for (const BundledTag& tag : frame.target.tags()) {
    const auto strokes = outline_strokes(frame.camera, frame.track.camera_from_tag * tag.tag_from_this, tag.size_m);
    draw_strokes(strokes, place);
    if (strokes.empty()) continue;
    draw_text(place.screen_px(strokes.front().points_px.front()) + 4.0f, {255, 255, 255}, std::to_string(tag.id));
  }
}

/// From where the pose has each corner towards where the frame shows it, so many times as far.
void draw_residuals(const DrawnFrame& frame, const PicturePlace& place, float gain) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const CornerResiduals& tag : frame.corners)
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec2 error_px = tag.seen_px[i] - tag.drawn_px[i];
      draw_strokes({{{tag.drawn_px[i], tag.drawn_px[i] + static_cast<double>(gain) * error_px}, kResidual}}, place);
      const glm::vec2 at = place.screen_px(tag.drawn_px[i]);
      list->AddCircleFilled(im(at), 3.5f, kHalo);
      list->AddCircleFilled(im(at), 2.5f, color_of(kResidual));
      draw_text(at + glm::vec2(7, -ImGui::GetTextLineHeight()), kResidual, fixed_text(glm::length(error_px), 2) + " px");
    }
}

/// State, and the residual where it is on, in the room's corner.
void draw_state(const DrawnFrame& frame, bool has_state, bool has_residual, float gain) {
  std::vector<SketchLine> lines;
  if (has_state) lines = state_lines(frame.track);
  if (has_residual) {
    std::string text = "residual";
    text += frame.corners.empty()
                ? ": no tag is detected in this frame alone"
                : ' ' + fixed_text(rms_px(frame.corners), 3) + " px rms, drawn " + fixed_text(gain, 0) + " times";
    lines.push_back({text, kResidual});
  }
  glm::vec2 at{ImGui::GetWindowPos().x + 10, ImGui::GetWindowPos().y + 8};
  for (const SketchLine& line : lines) {
    draw_text(at, line.color, line.text);
    at.y += ImGui::GetTextLineHeightWithSpacing();
  }
}

const char* help_of(Overlay overlay) {
  switch (overlay) {
    case Overlay::tag:
      return "outline and number";
    case Overlay::axes:
      return "x red, y green, z blue";
    case Overlay::residual:
      return "corners as seen, from those that the pose has";
    case Overlay::state:
      return "what the tracker says of the frame";
    case Overlay::object:
      return "what the object covers, orange";
    case Overlay::shadow:
      return "where it takes light from the receiver, blue";
    case Overlay::receiver:
      return "where the receiver's shadow is known";
  }
  return "";
}

}  // namespace

void PictureOverlays::draw_masks(const std::shared_ptr<const DrawnFrame>& frame, const PicturePlace& place) {
  if (!frame->masks || (!is_on(Overlay::object) && !is_on(Overlay::shadow))) return;
  const glm::ivec2 size(frame->plate.width, frame->plate.height);
  if (masks_size_ != size) masks_ = render::make_texture_2d("masks", GL_RGBA8, size.x, size.y, GL_LINEAR);
  if (tinted_ != frame || tinted_on_ != on || masks_size_ != size) {
    const std::vector<unsigned char> rgba = mask_tint(*frame->masks, is_on(Overlay::object), is_on(Overlay::shadow));
    glTextureSubImage2D(masks_.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  tinted_ = frame, tinted_on_ = on, masks_size_ = size;
  ImGui::GetWindowDrawList()->AddImage(std::bit_cast<ImTextureID>(std::uintptr_t{masks_.id()}), im(place.corner_px),
                                       im(place.corner_px + place.zoom * glm::vec2(size)));
}

void PictureOverlays::draw(const std::shared_ptr<const DrawnFrame>& frame, const PicturePlace& place) {
  draw_masks(frame, place);
  const TrackRow& track = frame->track;
  if (track.found) {
    if (is_on(Overlay::receiver) && frame->receiver)
      draw_strokes(plane_strokes(frame->camera, track.camera_from_tag, frame->receiver->min_m, frame->receiver->max_m, kReceiver),
                   place);
    if (is_on(Overlay::tag)) draw_tags(*frame, place);
    if (is_on(Overlay::axes)) draw_strokes(axis_strokes(frame->camera, track.camera_from_tag, frame->target.size_m), place);
    if (is_on(Overlay::residual)) draw_residuals(*frame, place, residual_gain);
  }
  draw_state(*frame, is_on(Overlay::state), is_on(Overlay::residual), residual_gain);
}

void PictureOverlays::draw_choice(GuiItems& items) {
  if (!begin_menu(on.empty() ? "overlays" : "overlays: " + std::to_string(on.size()), "overlays", items)) return;
  for (const std::string& name : name_list<Overlay>()) {
    const Overlay overlay = *value_named<Overlay>(name);
    bool is_chosen = is_on(overlay);
    if (ImGui::Checkbox(name.c_str(), &is_chosen)) is_chosen ? void(on.insert(overlay)) : void(on.erase(overlay));
    items.note("overlay " + name);
    ImGui::SameLine(7 * ImGui::GetTextLineHeight());
    ImGui::TextDisabled("%s", help_of(overlay));
  }
  ImGui::SetNextItemWidth(8 * ImGui::GetTextLineHeight());
  ImGui::SliderFloat("times the residual", &residual_gain, 1, 500, "%.0f", ImGuiSliderFlags_Logarithmic);
  items.note("residual gain");
  ImGui::EndPopup();
}

void PictureOverlays::add_wanted(FrameExtras& extras) const {
  extras.masks = is_on(Overlay::object) || is_on(Overlay::shadow);
  extras.corners = is_on(Overlay::residual);
}

}  // namespace catchlight::app
