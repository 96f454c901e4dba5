#include "app/session/frame_view.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "catchlight/color.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/statistics.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kVisibleCodes = 0.25;  ///< less noise than rounding itself makes (0.29) is none
constexpr double kGrey = 0.18;
constexpr double kPixelBlur_px2 = 1.0 / 12, kMinDefocus_px2 = 0.02;
constexpr double kFilmShutter = 0.5;  ///< 180 degrees: where motion blur is asked for and the footage does not say how much

glm::dmat3 covariance(const NoiseModel& noise, double light) {
  const glm::dvec3 sigma = glm::sqrt(glm::max(noise.slope * light + noise.floor, 0.0));
  const auto& [rg, rb, gb] = std::tuple{noise.correlation.x, noise.correlation.y, noise.correlation.z};
  const glm::dmat3 correlation{{1, rg, rb}, {rg, 1, gb}, {rb, gb, 1}};
  return glm::matrixCompMult(correlation, glm::outerProduct(sigma, sigma));
}

bool is_visible(const NoiseModel& noise, const PlateColor& response) {
  return std::max(noise_codes(noise, response, kGrey), noise_codes(noise, response, 3 * kGrey)) >= kVisibleCodes;
}

bool adds_noise(Switch wanted, const NoiseModel& noise, const PlateColor& response) {
  if (wanted == Switch::off || !noise.is_measured()) return false;
  return wanted == Switch::on || is_visible(noise, response);
}

/// Why a figure is not known; `beyond`: where the tag was seen, and not only read from a file.
std::string not_measured(const std::vector<TrackRow>& rows, bool has_track_file, const std::string& beyond) {
  if (std::ranges::none_of(rows, &TrackRow::found)) return "not measured: the tag was not found";
  return "not measured: " + (has_track_file ? "the track file does not say" : beyond);
}

PlanEntry noise_entry(Switch wanted, const NoiseModel& noise, const PlateColor& response, const std::string& not_measured) {
  const bool on = adds_noise(wanted, noise, response);
  std::string why;
  if (wanted == Switch::off) {
    why = "switched off";
  } else if (!noise.is_measured()) {
    why = not_measured;
  } else {
    why = "luma's grain is " + fixed_text(noise_codes(noise, response, kGrey), 2) + " codes on a grey of " + fixed_text(kGrey, 2);
    if (!on) why += ", less than rounding's own";
    if (wanted == Switch::on) why += "; switched on";
  }
  return {"lens.noise", on ? "on" : "off", why};
}

PlanEntry defocus_entry(Switch wanted, const std::vector<TrackRow>& rows, const std::string& not_measured) {
  std::vector<double> measured;
  for (const TrackRow& row : rows)
    if (row.blur.focus_px2 > 0) measured.push_back(row.blur.focus_px2);
  if (wanted == Switch::off) return {"lens.defocus", "off", "switched off"};
  if (measured.empty()) return {"lens.defocus", "off", not_measured};
  BlurModel typical;
  typical.focus_px2 = median(std::move(measured));
  const double added = defocus_px2(wanted, typical);
  return {"lens.defocus", added > 0 ? "on" : "off",
          "the tag's edges are blurred by " + fixed_text(std::sqrt(typical.focus_px2), 2) + " px (standard deviation, median), " +
              (added > 0 ? fixed_text(std::sqrt(added), 2) + " px more than a pixel's own" : "no more than a pixel's own")};
}

/// A shutter that is set by hand says all there is.
bool draws_shake(const SceneSettings::Lens& settings) {
  return settings.motion_blur != Switch::off && settings.shutter == 0;
}

PlanEntry motion_entry(const SceneSettings::Lens& settings, const std::vector<TrackRow>& rows, const std::string& not_measured) {
  const BlurModel& blur = rows.back().blur;
  const double share = shutter_share(settings, blur);
  const bool shakes = draws_shake(settings) &&
                      std::ranges::any_of(rows, [](const TrackRow& row) { return row.blur.shake_rad != glm::dvec2(0.0); });
  std::string why;
  if (settings.motion_blur == Switch::off)
    why = "switched off";
  else if (settings.shutter > 0)
    why = "the shutter is set to " + fixed_text(share, 2) + " of the frame's interval";
  else if (blur.shutter > 0)
    why = "the tag's blur along its motion is that of a shutter open for " + fixed_text(share, 2) + " of the frame's interval";
  else if (blur.focus_px2 == 0)
    why = not_measured;
  else
    why = "the tag's edges show no blur along its motion";
  if (share > 0 && settings.shutter == 0 && blur.shutter == 0) why += "; switched on, for half of the interval";
  if (shakes) why += "; frames in which it is blurred otherwise, as by a jerk, are drawn with their own blur";
  return {"lens.motion_blur", share > 0 || shakes ? "on" : "off", why};
}

PlanEntry vignetting_entry(Switch wanted, const glm::dvec3& vignetting) {
  if (wanted == Switch::off) return {"lens.vignetting", "off", "switched off"};
  if (vignetting == glm::dvec3(0.0)) return {"lens.vignetting", "off", "the camera file gives none"};
  return {
      "lens.vignetting", "on",
      "the camera file leaves the corners " + fixed_text(1 + vignetting.x + vignetting.y + vignetting.z, 2) + " of the light"};
}

PlanEntry chroma_entry(Switch wanted, const glm::ivec2& shift) {
  if (shift == glm::ivec2(0)) return {"lens.chroma_subsampling", "off", "every pixel of the footage has its own colour"};
  const std::string size = std::to_string(1 << shift.x) + " x " + std::to_string(1 << shift.y);
  if (wanted == Switch::off) return {"lens.chroma_subsampling", "off", "switched off"};
  return {"lens.chroma_subsampling", "on", size + " pixels of the footage share a colour"};
}

}  // namespace

bool follows_footage(ExposureMode mode) {
  return mode != ExposureMode::fixed;
}

LayerExposure layer_exposure(const SceneSettings::Exposure& settings, const TrackRow& row,
                             const glm::dvec3& tag_irradiance_over_pi) {
  const glm::dvec3 by_hand = std::exp2(settings.ev) * settings.white_balance;
  if (!follows_footage(settings.mode)) return {by_hand, glm::dvec3(0.0)};
  LayerExposure exposure{glm::dvec3(0.0), row.black};  // a channel in which the probe is black stays black
  for (int c = 0; c < 3; ++c)
    if (tag_irradiance_over_pi[c] > 1e-12) exposure.gain[c] = by_hand[c] * row.exposure[c] / tag_irradiance_over_pi[c];
  return exposure;
}

double noise_codes(const NoiseModel& noise, const PlateColor& response, double light) {
  const glm::dmat3 c = covariance(noise, light);
  const double variance = std::max(glm::dot(kLuminanceWeights, c * kLuminanceWeights), 0.0);
  const double step = 1e-3 * light;
  const double codes_per_light =
      255 * (code_from_linear(response, light + step, 1) - code_from_linear(response, light - step, 1)) / (2 * step);
  return std::sqrt(variance) * codes_per_light;
}

glm::dmat3 noise_mix(const NoiseModel& noise) {
  const glm::dmat3 c = covariance(noise, kGrey);
  const glm::dvec3 w = kLuminanceWeights, one(1.0), with_luma = c * w;
  const double luma = std::max(glm::dot(w, with_luma), 0.0);
  // Colour is C = n - Y; `color` is its covariance, and `shared` its covariance with Y.
  const glm::dmat3 color =
      c - glm::outerProduct(one, with_luma) - glm::outerProduct(with_luma, one) + luma * glm::outerProduct(one, one);
  const glm::dvec3 shared = with_luma - luma;
  // C has no luma, so red and blue say all of it: this is the Cholesky factor of their covariance.
  const double rr = std::sqrt(std::max(color[0][0], 0.0)), br = rr > 0 ? color[0][2] / rr : 0;
  const double bb = std::sqrt(std::max(color[2][2] - br * br, 0.0));
  const auto of_red_and_blue = [&](double red, double blue) { return glm::dvec3(red, -(w.r * red + w.b * blue) / w.g, blue); };
  const glm::dvec3 first = of_red_and_blue(rr, br), second = of_red_and_blue(0, bb);
  // Luma's regression on the two numbers behind C; what is left of it is the pixel's own. The ridge keeps luma from following
  // colours that hardly vary, which any error of measurement would make it do.
  const double ridge = 0.005 * luma;
  const double on_first = rr > 0 ? shared.r * rr / (rr * rr + ridge) : 0;
  const double on_second = bb > 0 ? (shared.b - br * on_first) * bb / (bb * bb + ridge) : 0;
  const double alone = std::sqrt(std::max(luma - on_first * on_first - on_second * on_second, 0.0));
  glm::dmat3 mix(first + on_first, second + on_second, glm::dvec3(alone));
  for (int channel = 0; channel < 3; ++channel) {
    const double sigma = std::sqrt(mix[0][channel] * mix[0][channel] + mix[1][channel] * mix[1][channel] + alone * alone);
    for (int i = 0; i < 3; ++i) mix[i][channel] = sigma > 0 ? mix[i][channel] / sigma : 0;
  }
  return mix;
}

double defocus_px2(Switch wanted, const BlurModel& blur) {
  const double beyond = blur.focus_px2 - kPixelBlur_px2;
  return wanted == Switch::off || blur.focus_px2 == 0 || beyond < kMinDefocus_px2 ? 0 : beyond;
}

double shutter_share(const SceneSettings::Lens& settings, const BlurModel& blur) {
  if (settings.motion_blur == Switch::off) return 0;
  if (settings.shutter > 0) return settings.shutter;
  return blur.shutter > 0 || settings.motion_blur == Switch::automatic ? blur.shutter : kFilmShutter;
}

render::CameraEffects camera_effects(const SceneSettings::Lens& settings, const TrackRow& row, const Frame& frame) {
  render::CameraEffects effects;
  if (adds_noise(settings.noise, row.noise, frame.color())) {
    effects.noise.enabled = true;
    effects.noise.slope = row.noise.slope;
    effects.noise.floor = row.noise.floor;
    effects.noise.mix = noise_mix(row.noise);
    effects.noise.block_shift = frame.color_block_shift();
    effects.noise.frame = static_cast<std::uint32_t>(row.frame);
  }
  effects.defocus_px2 = defocus_px2(settings.defocus, row.blur);
  const double shutter = shutter_share(settings, row.blur);
  effects.motion = {row.blur.motion.turn_rad * shutter, row.blur.motion.shift_m * shutter};
  if (draws_shake(settings)) effects.motion.turn_rad += glm::dvec3(row.blur.shake_rad, 0);
  return effects;
}

std::vector<PlanEntry> lens_plan(const SceneSettings& scene, const std::vector<TrackRow>& rows, const Frame& frame,
                                 const glm::dvec3& vignetting, bool has_track_file) {
  if (rows.empty()) return {};
  const SceneSettings::Lens& settings = scene.lens;
  const bool is_direct = scene.tag.tracker_options().refinement == tracking::Refinement::direct;
  const std::string no_noise = not_measured(rows, has_track_file, "the tag's cells are too small"),
                    no_blur = not_measured(rows, has_track_file,
                                           is_direct ? "the tag's print fits in no frame" : "needs tag.refinement direct");
  return {noise_entry(settings.noise, rows.back().noise, frame.color(), no_noise), defocus_entry(settings.defocus, rows, no_blur),
          motion_entry(settings, rows, no_blur), vignetting_entry(settings.vignetting, vignetting),
          chroma_entry(settings.chroma_subsampling, frame.color_block_shift())};
}

render::FrameView frame_view(const Frame& frame, const TrackRow& row, const CameraModel& camera, const SceneSettings& scene,
                             const BuiltScene& built) {
  render::FrameView view;
  view.camera = scene.lens.as_drawn(camera);
  view.color = frame.color();
  view.has_pose = row.found;
  if (!row.found) return view;
  view.camera_from_tag = row.camera_from_tag * built.tag_from_scene;
  view.tag_in_scene_m = -built.tag_from_scene.translation_m;
  const LayerExposure exposure = layer_exposure(scene.exposure, row, tag_irradiance_over_pi(built, row.camera_from_tag));
  view.exposure = exposure.gain;
  view.black = exposure.black;
  if (row.has_exposure) view.receiver_light = row.exposure * scene.receiver.albedo + row.black;
  view.tag_from_light = built.orientation.tag_from_light(row.camera_from_tag.rotation);
  view.light_turns = built.orientation.follows_camera;
  view.effects = camera_effects(scene.lens, row, frame);
  return view;
}

}  // namespace catchlight::app
