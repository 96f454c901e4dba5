// Draws the object on the processor: rays find what each pixel shows, and each piece of surface is shaded once.
#pragma once

#include <memory>
#include <optional>

#include "catchlight/image.hpp"
#include "render/cpu/mirror/mirrored_light.hpp"
#include "render/cpu/plate/plate_light.hpp"
#include "render/cpu/receiver/receiver_shadow.hpp"
#include "render/cpu/surface/direct_light.hpp"
#include "render/cpu/surface/highlights.hpp"
#include "render/cpu/surface/surface_textures.hpp"
#include "render/cpu/surface/visible_surface.hpp"
#include "render/frame_plan.hpp"
#include "render/render_scene.hpp"

namespace catchlight::render {

/// What is drawn of the object: premultiplied by coverage, exposed linear, in the plate's primaries.
struct ObjectImages {
  PixelRect rect;      ///< the frame's pixels that the images are
  PixelRect covered;   ///< the box around those of them that the object covers
  Image color;         ///< RGBA
  Image reflection;    ///< the mirrored part of it, of four channels as all that is blurred; only with layers
  Image normal_depth;  ///< camera frame, metres along z; only with layers
  Image emission;      ///< what the materials emit, of four channels; only where it glares otherwise than the rest
};

class CpuObject {
 public:
  /// Keeps references. `samples` of a pixel's outline, `reflection_rays` over a rough surface's lobe.
  CpuObject(const RenderScene& scene, const RayScene& rays, const Bounds& bounds, int samples, int reflection_rays);

  /// Takes over the light, in the tag frame; needed again when it turns. `stands_still`: it does not turn with every frame.
  /// `kept`: for that scene and light.
  void light_by(const SplitLight& light_tag, bool stands_still, const KeyedCache& kept);

  bool reflects() const { return materials_.reflects; }
  bool emits() const { return materials_.emits; }

  /// The box around the frame's pixels that the object covers, in the plan's rectangle.
  PixelRect covered(const FrameView& view, const FramePlan& plan) const;

  /// Draws into images that were made for covered(). `shadow` and `plate`: what mirrors show of the receiver, or null.
  void draw(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow* shadow,
            const PlateLight* plate, ObjectImages& images);

 private:
  struct Shaded;

  Shaded shade(const VisibleSurface& surface, const SurfacePoint& point, const glm::vec3& mirrored,
               const glm::vec3& exposure) const;
  glm::vec3 arriving_over_pi(const TexturedSurface* textured, const SurfacePoint& point, bool shines, float* shares) const;
  void put(const FrameView& view, const VisibleSurface& surface, std::span<const glm::vec3> mirrored, ObjectImages& images) const;

  const RenderScene& scene_;
  Bounds bounds_;
  SurfaceMaterials materials_;
  BrdfTable brdf_;
  SurfaceTextures textures_;
  CubeTexture probe_, rest_;
  Surroundings around_;
  SurfaceFinder finder_;
  DirectLight direct_;
  Highlights highlights_;
  MirrorRays mirror_rays_;
  MirroredLight mirrored_;
  std::vector<glm::vec3> irradiance_over_pi_;
  ShRgb smooth_light_;  ///< what is not split off, as far as it shows in irradiance
};

}  // namespace catchlight::render
