// The view of a frame that the compositor draws, from what the track says of the frame and what the scene file wants of it.
#pragma once

#include "app/media/pixels/frame.hpp"
#include "app/session/plan.hpp"
#include "app/session/scene_builder.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/track.hpp"
#include "render/camera_effects.hpp"
#include "render/frame_view.hpp"

namespace catchlight::app {

/// Whether the virtual layer is exposed as the footage was, by what the tag shows. `auto` exposes it so as well, before the whole
/// picture is exposed anew.
bool follows_footage(ExposureMode mode);

/// Exposed linear value = gain * the probe's radiance + black.
struct LayerExposure {
  glm::dvec3 gain{1.0}, black{0.0};
};

/// The virtual layer's exposure in the row's frame. Where it follows the footage, paper under the probe's own irradiance E comes
/// out as the tag's did in the frame: gain = white / (E/pi), and the frame's black is added. Else gain is 1 and nothing is added.
/// The gain is then multiplied by 2^ev, and channel by channel by white_balance.
LayerExposure layer_exposure(const SceneSettings::Exposure& settings, const TrackRow& row,
                             const glm::dvec3& tag_irradiance_over_pi);

/// The standard deviation of the noise in luma on a grey of `light`, in 8-bit codes.
double noise_codes(const NoiseModel& noise, const PlateColor& response, double light);

/// Splits noise of these variances and correlations into what pixels of one colour sample share and what each has alone
/// (render::SensorNoise::mix): colour, which is RGB less luma, is the block's; luma is the pixel's, but follows colour as far as
/// the two are correlated. Every channel's variance is 1; correlations are kept within 0.01.
glm::dmat3 noise_mix(const NoiseModel& noise);

/// The variance of the lens's blur beyond that of a pixel's own square, which every picture has, ours too; 0: none.
double defocus_px2(Switch wanted, const BlurModel& blur);

/// The share of the frame's interval over which motion blurs the virtual layer; 0: it does not.
double shutter_share(const SceneSettings::Lens& settings, const BlurModel& blur);

/// What the camera does to the virtual layer in one frame.
render::CameraEffects camera_effects(const SceneSettings::Lens& settings, const TrackRow& row, const Frame& frame);

/// The plan's entries for these effects: which are on, by what figure, and why.
std::vector<PlanEntry> lens_plan(const SceneSettings& scene, const std::vector<TrackRow>& rows, const Frame& frame,
                                 const glm::dvec3& vignetting, bool has_track_file = false);

/// The frame's view: pose, exposure, black, and what the lens does, each as far as the settings want it. Every command draws a
/// frame by this view, and so does the reference that it is compared with. No tone curve is set. `built` needs its files
/// loaded.
render::FrameView frame_view(const Frame& frame, const TrackRow& row, const CameraModel& camera, const SceneSettings& scene,
                             const BuiltScene& built);

}  // namespace catchlight::app
