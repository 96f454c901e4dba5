// Draws the virtual layer and puts it into the frame. Never knows whether a window exists: draws into its own framebuffers.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catchlight.hpp"
#include "render/camera/lens_view.hpp"
#include "render/image/image.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/light_samples.hpp"
#include "render/probe/prefilter.hpp"
#include "render/tone/tone_curve.hpp"
#include "render/transfer/transfer.hpp"
#include "response_curve.hpp"

namespace catchlight::render {

/// Part of the footage's frame: RGB codes, row-major. Integers are full scale (255 or 65535 = code 1); floats are codes as they
/// are.
struct Plate {
  enum class Format { rgb_u8, rgb_u16, rgb_f32 };
  PixelRect rect;
  Format format = Format::rgb_u8;
  std::vector<std::byte> pixels;
};

/// Gives the requested part of the current frame; called only for what the virtual layer reaches.
using PlateReader = std::function<Plate(const PixelRect&)>;

inline constexpr int kMaxLightSamples = 128;

/// What the scene is made of, all in the tag frame. Light is scene-linear radiance, Rec. 709.
struct RenderScene {
  Mesh mesh;
  Transfer transfer;
  ShRgb light;                           ///< all of it: transfer.bands^2 coefficients
  std::vector<LightSample> lights = {};  ///< split off; at most kMaxLightSamples, none where the transfer has no direct part
  ReflectionMap reflections;             ///< all of it
  ReflectionMap rest_reflections = {};   ///< less the compact lights; used where there are any
  glm::vec3 probe_in_tag_m{0.0f};        ///< where the probe was captured
};

struct GlareSettings {
  bool enabled = true;
  double threshold = 1.0;  ///< exposed linear value above which the lens spills; 1 = sensor white
  double brightest = 3e4;  ///< what the light of a highlight tends to, however bright it is
  double bloom_strength = 0.05;
  double streak_strength = 0.04;
  int streak_directions = 4;
  double streak_attenuation = 0.92;  ///< a of a^k, per pixel at a frame height of 480 px
  double streak_dispersion = 0;      ///< 1: a streak is as long as its colour's wavelength says; 0: all alike
  double streak_rotation_deg = 45;
  double streak_width = 0.006;    ///< standard deviation across, in shares of the frame's height
  double emitter_strength = 1;    ///< of what the object's materials emit, against what else is as bright
  int emitter_directions = 0;     ///< streaks of what they emit; 0: as of the rest
  int streak_passes = 0;          ///< of four samples each; 0: as many as can be seen
  int grid_rows = 240;            ///< resolution that glare is computed at; texels are never smaller than pixels
  std::string method = "fast";    ///< or "fft": of an aperture, as render/glare/fft_glare.hpp says
  std::string aperture = "none";  ///< or what aperture_picture() takes
  double aperture_mm = 2;         ///< width of its picture
  double aperture_strength = 1;   ///< 1: as much as the aperture diffracts
};

/// `classic`: bloom and streaks of the whole picture as in render/passes/glare/classic_glare.hpp, instead of those of the object's highlights.
enum class Look { camera, classic };

struct CompositorSettings {
  GlareSettings glare;
  Look look = Look::camera;
  ToneSettings tone;  ///< with it, or with the classic look, every pixel of every frame changes
  int samples = 4;    ///< multisampling of the object's edges
  int reflection_rays =
      16;  ///< over the lobe of a rough surface; 0: only the probe is mirrored, neither the object nor the receiver
  std::string shader_folder;  ///< overrides the embedded shaders where not empty
};

/// How the footage codes light.
struct PlateColor {
  TransferFunction transfer = TransferFunction::srgb;
  glm::mat3 plate_from_rec709{1.0f};                ///< linear primaries conversion
  std::shared_ptr<const ResponseCurve> curve = {};  ///< stands in for `transfer`
};

/// The camera's part of one frame: exposed linear value = exposure * radiance + black.
struct FrameView {
  CameraModel camera;
  RigidTransform camera_from_tag;
  glm::vec3 exposure{1.0f};
  glm::vec3 black{0.0f};
  glm::vec3 receiver_light{
      0.0f};  ///< unshadowed, exposed linear: what clipped pixels of the plate are taken to hide; 0: not known
  PlateColor color;
  glm::dmat3 tag_from_light{1.0};  ///< turns the light against the tag (probe fixed to the camera)
  bool has_pose = true;            ///< false: nothing virtual is drawn; the tone curve, where there is one, is
  std::optional<ToneCurve> tone;   ///< what the exposure has adapted to; none: what the frame itself calls for
  LensView lens;                   ///< what the camera does to the virtual layer besides
};

/// Layers for compositing packages, whole frame, premultiplied, exposed linear in the plate's primaries. r = plate * shadow * (1
/// - a) + object + glare.
struct Layers {
  Image plate, object /* RGBA */, shadow, reflection, glare, normal, depth /* metres along z, 1 channel */;
};

/// The changed part of a frame. RGBA floats: display codes as the footage's, alpha 1 where the virtual layer changed the pixel,
/// else 0.
struct Composite {
  PixelRect rect;           ///< empty: nothing virtual in sight
  std::vector<float> rgba;  ///< row-major within rect
  bool glare_drawn = false;
  PixelRect glare_rect;  ///< what glare reaches, where it is drawn
  std::optional<Layers> layers;
  ToneCurve tone_wanted;  ///< what the frame calls for, where tone settings are enabled
};

/// Milliseconds by pass name, in drawing order.
struct PassTime {
  std::string name;
  double ms;
};

/// Needs a current GL 4.5 core context for its whole life. Throws Error where a shader does not compile (file and log) or a
/// texture is too large.
class Compositor {
 public:
  Compositor(const RenderScene& scene, const CompositorSettings& settings);
  ~Compositor();
  Compositor(Compositor&&) noexcept;
  Compositor& operator=(Compositor&&) noexcept;

  /// Deterministic: the same input gives the same bytes. Holds no state between frames but buffers.
  /// With layers there is no tone curve: they are the scene's light, for a compositing package to expose.
  Composite render(const FrameView& view, const PlateReader& plate, bool want_layers = false);

  /// Composite::tone_wanted alone: the frame is drawn, but neither coded nor read back.
  ToneCurve meter(const FrameView& view, const PlateReader& plate);

  /// Of the last frame.
  const std::vector<PassTime>& pass_times() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::render
