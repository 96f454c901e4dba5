#include "app/window/playing/frame_light.hpp"

#include "app/session/frame_view.hpp"

namespace catchlight::app {

FrameLight FrameLightMaker::light_of(const FrameJob& job, const SceneSettings& settings, const SceneBuilder& builder) {
  constexpr int kWidth = 512;
  const BuiltScene& built = builder.scene();
  const int probe_version = builder.times_made(ScenePart::probe), lights_version = builder.times_made(ScenePart::lights);
  if (lights_version == 0 || !job.track.found) return {};
  if (!probe_ || probe_version != probe_version_ || lights_version != lights_version_) {
    const bool is_small = built.probe.layout == render::ProbeLayout::latlong && built.probe.image.width <= kWidth;
    probe_ = std::make_shared<SmallProbe>(SmallProbe{
        is_small ? built.probe : render::convert(built.probe, render::ProbeLayout::latlong, kWidth), builder.lights()});
    probe_version_ = probe_version, lights_version_ = lights_version;
  }
  SceneSettings::Exposure exposure = settings.exposure;
  exposure.white_balance = glm::dvec3(1.0);
  const glm::dvec3 irradiance_over_pi = tag_irradiance_over_pi(built, job.track.camera_from_tag);
  FrameLight light{probe_, built.light_gain * glm::dvec3(job.view.exposure), {}, glm::dvec3(job.view.black)};
  light.paper = layer_exposure(exposure, job.track, irradiance_over_pi).gain * irradiance_over_pi;
  return light;
}

}  // namespace catchlight::app
