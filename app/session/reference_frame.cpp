#include "app/session/reference_frame.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/session/frame_view.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/plate.hpp"
#include "render/image/picture_file.hpp"
#include "render/mesh/base_color.hpp"
#include "render/reference/path_tracer.hpp"

namespace catchlight::app {
namespace {

namespace reference = render::reference;

/// The exposure at each pixel: that at the tag, times what vignetting leaves at the pixel against what it leaves at the tag.
struct PixelExposure {
  LayerExposure at_tag;
  CameraModel camera;
  double passed_at_tag = 1;  ///< share of light that vignetting leaves at the tag

  glm::dvec3 gain(int x, int y) const { return at_tag.gain * (vignetting_at(camera, {x, y}) / passed_at_tag); }
};

PixelExposure exposure_of(const render::FrameView& view) {
  const std::optional<glm::dvec2> tag_px = reference::CameraRays(view.camera, view.camera_from_tag).pixel_of(view.tag_in_scene_m);
  PixelExposure exposure{{view.exposure, view.black}, view.camera};
  const double passed_at_tag = tag_px ? vignetting_at(view.camera, *tag_px) : 0;
  if (passed_at_tag > 0)
    exposure.passed_at_tag = passed_at_tag;
  else
    exposure.camera.vignetting = glm::dvec3(0.0);
  return exposure;
}

reference::ReferenceScene traced_scene(const SceneSettings& settings, const BuiltScene& built, const render::FrameView& view) {
  reference::ReferenceScene scene;
  scene.mesh = built.scene.mesh;
  render::fold_base_color_textures(scene.mesh);
  scene.probe = built.probe;
  for (float& value : scene.probe.image.data) value *= static_cast<float>(built.light_gain);
  scene.tag_from_probe = view.tag_from_light * built.orientation.light_from_probe;
  scene.has_receiver = settings.receiver.plane == ReceiverPlane::tag;
  scene.probe_in_tag_m = probe_in_scene_m(scene.mesh);
  return scene;
}

/// The light that the camera saw, before its exposure. What noise made darker than black is black.
Image radiance_of(const Image& exposed_linear, const PixelExposure& exposure) {
  Image radiance = exposed_linear;
  for (int y = 0; y < radiance.height; ++y) {
    for (int x = 0; x < radiance.width; ++x) {
      const glm::dvec3 gain = exposure.gain(x, y);
      for (int c = 0; c < 3; ++c) {
        float& value = radiance.pixel(x, y)[c];
        const double light = std::max(0.0, value - exposure.at_tag.black[c]);
        value = gain[c] > 0 ? static_cast<float>(light / gain[c]) : 0.0f;
      }
    }
  }
  return radiance;
}

/// What the camera would have seen with the object there.
void put_in(const reference::ReferencePicture& traced, const PixelExposure& exposure, Image& plate) {
  for (int y = 0; y < plate.height; ++y) {
    for (int x = 0; x < plate.width; ++x) {
      const glm::dvec3 gain = exposure.gain(x, y);
      for (int c = 0; c < 3; ++c) {
        float& value = plate.pixel(x, y)[c];
        const double kept = traced.kept.pixel(x, y)[c], object = traced.object.pixel(x, y)[c], black = exposure.at_tag.black[c];
        if (kept != 1 || object != 0) value = static_cast<float>((value - black) * kept + object * gain[c] + black);
      }
    }
  }
}

}  // namespace

Image trace_reference_frame(const FrameJob& job, const SceneSettings& settings, const BuiltScene& built,
                            const ReferenceQuality& quality, const ProgressHandler& progress) {
  const render::FrameView& view = job.view;
  Image plate(job.image.width_px(), job.image.height_px());
  plate.data = linear_rgb(job.image.rgb({0, 0, plate.width, plate.height}), job.image.color());

  reference::ReferenceScene scene = traced_scene(settings, built, view);
  const PixelExposure exposure = exposure_of(view);
  scene.frame = {radiance_of(plate, exposure), view.camera, view.camera_from_tag};
  scene.unlit_radiance = 1.0 / glm::max(exposure.at_tag.gain, 1e-20);
  reference::TraceOptions options;
  options.samples = quality.samples;
  options.bounces = quality.bounces;
  const reference::ReferencePicture traced =
      reference::PathTracer(std::move(scene), options).render(view.camera, view.camera_from_tag, progress);

  put_in(traced, exposure, plate);
  return plate;
}

void write_reference_png(const std::string& path, const Image& exposed_linear, const Frame& frame, bool overwrite) {
  const PlateColor color = frame.color();
  const bool is_8_bit = frame.rgb({0, 0, 1, 1}).format == Plate::Format::rgb_u8;
  const double full_scale = is_8_bit ? 255 : 65535;
  cv::Mat picture(exposed_linear.height, exposed_linear.width, is_8_bit ? CV_8UC3 : CV_16UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float* value = exposed_linear.pixel(x, y);
      const glm::vec3 light = color.plate_from_rec709 * glm::vec3(value[0], value[1], value[2]);
      for (int c = 0; c < 3; ++c) {
        const double code = std::round(std::clamp(code_from_linear(color, light[c], c), 0.0, 1.0) * full_scale);
        const int bgr = 3 * x + 2 - c;
        if (is_8_bit)
          picture.ptr<std::uint8_t>(y)[bgr] = static_cast<std::uint8_t>(code);
        else
          picture.ptr<std::uint16_t>(y)[bgr] = static_cast<std::uint16_t>(code);
      }
    }
  }
  PendingFile file = pending_output(path, overwrite);
  render::write_png(file.pending_path(), picture);
  file.commit();
}

}  // namespace catchlight::app
