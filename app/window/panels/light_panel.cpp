#include "app/window/panels/light_panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "app/session/scene_files.hpp"
#include "app/tools/probe_view/mirror_ball.hpp"
#include "app/window/editing/light_drag.hpp"
#include "catchlight/color.hpp"

namespace catchlight::app {
namespace {

constexpr double kDegree = glm::pi<double>() / 180;
constexpr std::size_t kMaxNamed = 6;  ///< lights that are told of in words

/// The axes of a ball seen by the frame's camera, in the camera's: x right, y away, z up.
glm::dmat3 camera_from_ball() {
  return {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)};
}

std::vector<unsigned char> codes_of(const Image& ball, const glm::dvec3& exposure) {
  std::vector<unsigned char> codes;
  codes.reserve(ball.data.size());
  for (std::size_t i = 0; i + 3 < ball.data.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double light = std::min(exposure[static_cast<int>(c)] * ball.data[i + c], 1.0);
      codes.push_back(static_cast<unsigned char>(std::lround(255 * srgb_from_linear(light))));
    }
    codes.push_back(static_cast<unsigned char>(255 * ball.data[i + 3]));
  }
  return codes;
}

/// A ring at the light, the larger the more of all light it is, with its number.
void mark(const ImVec2& middle, float radius, const glm::dvec2& place, double share, std::size_t number) {
  const float ring = 3 + 8 * static_cast<float>(std::sqrt(share));
  const ImVec2 at{middle.x + radius * static_cast<float>(place.x), middle.y - radius * static_cast<float>(place.y)};
  const std::string text = std::to_string(number);
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const auto& [ink, thickness] : {std::pair(IM_COL32(0, 0, 0, 200), 3.0f), std::pair(IM_COL32(255, 190, 80, 255), 1.2f)})
    list->AddCircle(at, ring, ink, 0, thickness);
  list->AddText({at.x + ring + 3, at.y - 6}, IM_COL32(0, 0, 0, 220), text.c_str());
  list->AddText({at.x + ring + 2, at.y - 7}, IM_COL32(255, 190, 80, 255), text.c_str());
}

/// Share and direction of each light; the tag's plane is level, and +x lies at 0°.
void list_lights(const std::vector<render::LightSummary>& lights, const glm::dmat3& tag_from_light) {
  if (lights.empty()) ImGui::TextWrapped("nothing in it throws a sharp shadow");
  for (std::size_t i = 0; i < std::min(lights.size(), kMaxNamed); ++i) {
    const glm::dvec3 to_light = tag_from_light * lights[i].direction;
    ImGui::Text("%zu  %.0f %%  at %.0f°, %.0f° up", i + 1, 100 * lights[i].share, std::atan2(to_light.y, to_light.x) / kDegree,
                std::asin(std::clamp(to_light.z, -1.0, 1.0)) / kDegree);
  }
  if (lights.size() > kMaxNamed) ImGui::Text("and %zu more", lights.size() - kMaxNamed);
}

}  // namespace

void LightPanel::renew(const FrameLight& light, const glm::dmat3& probe_from_ball, int size_px) {
  const bool is_same = drawn_ == light.probe && drawn_probe_from_ball_ == probe_from_ball && drawn_exposure_ == light.exposure;
  if (is_same && size_px == size_px_) return;
  if (size_px != size_px_) ball_ = render::make_texture_2d("probe ball", GL_RGBA8, size_px, size_px, GL_LINEAR);
  const Image ball = mirror_ball(light.probe->probe, probe_from_ball, size_px, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(ball_.id(), 0, 0, 0, size_px, size_px, GL_RGBA, GL_UNSIGNED_BYTE, codes_of(ball, light.exposure).data());
  drawn_ = light.probe, drawn_probe_from_ball_ = probe_from_ball, drawn_exposure_ = light.exposure, size_px_ = size_px;
}

void LightPanel::draw_ball(const DrawnFrame& frame, SettingsHistory& history, GuiItems& items) {
  const float size = std::floor(7.5f * ImGui::GetFrameHeight()), radius = size / 2;
  const LightOrientation orientation = light_orientation(history.now().probe);
  const glm::dmat3& camera_from_tag = frame.track.camera_from_tag.rotation;
  const glm::dmat3 tag_from_light = orientation.tag_from_light(camera_from_tag);
  const glm::dmat3 light_from_ball = glm::transpose(camera_from_tag * tag_from_light) * camera_from_ball();
  renew(frame.light, glm::transpose(orientation.light_from_probe) * light_from_ball, static_cast<int>(size));

  const ImVec2 corner = ImGui::GetCursorScreenPos(), middle{corner.x + radius, corner.y + radius};
  ImGui::InvisibleButton("probe ball", {size, size});
  items.note("probe ball");
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddImage(std::bit_cast<ImTextureID>(std::uintptr_t{ball_.id()}), corner, {corner.x + size, corner.y + size});
  list->AddCircle(middle, radius, ImGui::GetColorU32(ImGuiCol_WindowBg), 0, 2);
  const std::vector<render::LightSummary>& lights = frame.light.probe->lights;
  for (std::size_t i = std::min(lights.size(), kMaxNamed); i-- > 0;)
    mark(middle, radius, place_on_ball(glm::transpose(light_from_ball) * lights[i].direction), lights[i].share, i + 1);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the light as a mirror ball on the tag shows it: drag it to turn the probe");
  // What the ball's middle mirrors follows the pointer: the light turns twice as far as the surface.
  const double turned_deg = 2 * ImGui::GetIO().MouseDelta.x / radius / kDegree;
  if (ImGui::IsItemActive() && turned_deg != 0) history.change(with_probe_turned(history.now(), turned_deg), "probe.yaw_deg");
  if (ImGui::IsItemDeactivated()) history.end_gesture();

  ImGui::SameLine();
  ImGui::BeginGroup();
  list_lights(lights, tag_from_light);
  ImGui::EndGroup();
}

bool LightPanel::draw(const std::shared_ptr<const DrawnFrame>& frame, bool picks_white, SettingsHistory& history,
                      GuiItems& items) {
  if (!items.section("light")) return false;
  if (frame && frame->light.probe)
    draw_ball(*frame, history, items);
  else
    ImGui::TextWrapped(frame && frame->wish != 0 ? "no tag in this frame" : "the probe is being read");
  const bool is_asked = ImGui::Button(picks_white ? "click something white or grey" : "white balance …");
  items.note("white balance");
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("w: then click something in the picture that should be white or grey;\nit sets exposure.white_balance");
  return is_asked;
}

}  // namespace catchlight::app
