#include "app/window/picture/view_choice.hpp"

#include <imgui.h>

#include "app/window/surface/gui_menu.hpp"
#include "app/window/surface/window_layout.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

const char* help_of(View view) {
  switch (view) {
    case View::split:
      return "plate and composite beside an edge that is dragged";
    case View::flicker:
      return "plate and composite in turn";
    case View::difference:
      return "composite less plate, enlarged";
    case View::zones:
      return "exposure in stops around mid grey";
    case View::object:
      return "the object's light alone";
    case View::reflection:
      return "what of it is mirrored";
    case View::shadow:
      return "how much of its light the receiver keeps";
    case View::glare:
      return "what the lens spills";
    case View::normals:
      return "where surfaces face: x red, y green, z blue";
    case View::depth:
      return "distance: near white, far dark";
    default:
      return "";
  }
}

void draw_entries(PictureView& picture, bool has_truth, GuiItems& items) {
  for (const std::string& name : name_list<View>()) {
    const View view = *value_named<View>(name);
    if ((view == View::truth && !has_truth) || view == View::light) continue;
    if (view == View::object) ImGui::Separator();
    if (ImGui::MenuItem(name.c_str(), help_of(view), view == picture.view)) picture.view = view;
    items.note("view " + name);
  }
}

/// What each light adds, and what else there is.
void draw_lights(PictureView& picture, const std::vector<double>& shares, GuiItems& items) {
  ImGui::Separator();
  double rest = 1;
  for (const double share : shares) rest -= share;
  for (int light = 0; light <= static_cast<int>(shares.size()); ++light) {
    const double share = light == 0 ? rest : shares[static_cast<std::size_t>(light - 1)];
    const std::string help = fixed_text(100 * share, 1) + " % of the light on the receiver";
    const bool is_chosen = picture.view == View::light && picture.light == light;
    if (ImGui::MenuItem(light_name(light).c_str(), help.c_str(), is_chosen)) picture.view = View::light, picture.light = light;
    items.note("view " + light_name(light));
  }
}

}  // namespace

void draw_view_choice(PictureView& picture, const DrawnFrame* frame, GuiItems& items) {
  const bool has_truth = frame && !frame->truth.rgb.empty();
  if (begin_menu("view: " + (picture.view == View::light ? light_name(picture.light) : name_of(picture.view)), "view", items)) {
    draw_entries(picture, has_truth, items);
    if (frame) draw_lights(picture, frame->light_shares, items);
    ImGui::EndPopup();
  }
  picture.overlays.draw_choice(items);
  const View view = picture.view;
  if (view == View::difference) {
    fit_on_line(10 * ImGui::GetTextLineHeight());
    ImGui::SetNextItemWidth(7 * ImGui::GetTextLineHeight());
    ImGui::SliderFloat("gain", &picture.gain, 1, 64, "%.0f", ImGuiSliderFlags_Logarithmic);
    items.note("gain");
    ImGui::SameLine();
  }
  const bool compares = view == View::split || view == View::flicker || view == View::difference;
  if (!compares || !has_truth) return;
  fit_box_on_line("against truth");
  ImGui::Checkbox("against truth", &picture.against_truth);
  items.note("against truth");
  ImGui::SameLine();
}

}  // namespace catchlight::app
