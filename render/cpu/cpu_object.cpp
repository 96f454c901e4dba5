#include "render/cpu/cpu_object.hpp"

#include <algorithm>
#include <array>

#include "catchlight/util/parallel.hpp"
#include "render/camera/clip_from_camera.hpp"
#include "render/cpu/surface/transferred_light.hpp"
#include "shaders/shading.h"

namespace catchlight::render {
namespace {

/// How far a smoothed surface may lie from its triangles, in shares of the object's diagonal.
constexpr float kSkinShare = 0.01f;
constexpr std::size_t kPointsAtOnce = 512;
/// So many points ahead their light is fetched.
constexpr std::size_t kFetchedAhead = 8;
constexpr float kBrightest = 1e9f;
/// Irradiance is smooth: more bands of the light than these hardly show in it.
constexpr int kIrradianceBands = 3;
/// Bands ring around strong light, light cannot be negative: this share of its mean is the least that arrives on any side.
constexpr float kDarkest = 0.02f;

/// Never NaN, infinite or negative (out of the plate's gamut): one such pixel would spread with the glare.
glm::vec3 exposed(const FrameView& view, const glm::vec3& radiance) {
  const glm::vec3 light = view.exposure * (view.color.plate_from_rec709 * radiance);
  glm::vec3 result;
  for (int c = 0; c < 3; ++c) result[c] = light[c] > 0 ? std::min(light[c], kBrightest) : 0;
  return result;
}

std::vector<char> polished(const SurfaceMaterials& materials) {
  std::vector<char> result;
  for (const auto& m : materials.materials)
    result.push_back((m.base_color_metallic.w > 0 || m.dielectric.x > 0) &&
                     m.emissive_roughness.w < shading::kMinHighlightRoughness);
  return result;
}

void add(float* pixel, const glm::vec3& value, float coverage) {
  for (int c = 0; c < 3; ++c) pixel[c] += coverage * value[c];
}

}  // namespace

struct CpuObject::Shaded {
  glm::vec3 radiance, reflected, emitted;
};

CpuObject::CpuObject(const RenderScene& scene, const RayScene& rays, const Bounds& bounds, int samples, int reflection_rays)
    : scene_(scene),
      bounds_(bounds),
      materials_(surface_materials(scene.mesh)),
      brdf_(materials_.reflects),
      textures_(scene.mesh, materials_),
      probe_(materials_.reflects ? scene.reflections : ReflectionMap{}),
      rest_(materials_.reflects ? scene.rest_reflections : ReflectionMap{}),
      around_(probe_, rest_, scene.probe_in_tag_m),
      finder_(scene.mesh, rays, samples, polished(materials_)),
      direct_(scene.mesh, rays, bounds),
      mirror_rays_(scene.mesh, rays, textures_, brdf_, bounds.empty() ? 0 : kSkinShare * bounds.rounded_diagonal_m()),
      mirrored_(materials_, mirror_rays_, reflection_rays) {}

void CpuObject::light_by(const SplitLight& light_tag, bool stands_still, const KeyedCache& kept) {
  irradiance_over_pi_ = transferred_light(scene_.transfer.object, scene_.transfer.object_direct, light_tag);
  smooth_light_.assign(light_tag.whole.begin(), light_tag.whole.begin() + std::min<std::ptrdiff_t>(sh_count(kIrradianceBands),
                                                                                                   std::ssize(light_tag.whole)));
  for (std::size_t i = 0; i < std::min(smooth_light_.size(), light_tag.split_off.size()); ++i)
    smooth_light_[i] -= light_tag.split_off[i];
  direct_.set_samples(light_tag.samples, stands_still, kept);
  highlights_.set_samples(light_tag.samples);
}

/// Irradiance / pi. A normal map turns the surface under the light that was found for the smooth one, with the same shadows.
glm::vec3 CpuObject::arriving_over_pi(const TexturedSurface* textured, const SurfacePoint& point, bool shines,
                                      float* shares) const {
  if (!textured || !textured->is_bent) {
    const float occlusion = textured ? textured->occlusion : 1;
    return occlusion * point.irradiance_over_pi + direct_.irradiance(point, shines ? shares : nullptr) / shading::kPi;
  }
  direct_.irradiance(point, shares);
  glm::vec3 direct(0);
  const std::span<const LightSample> samples = direct_.samples();
  for (std::size_t i = 0; i < samples.size(); ++i)
    direct +=
        shares[i] * std::max(glm::dot(point.normal, glm::vec3(samples[i].direction)), 0.0f) * glm::vec3(samples[i].irradiance);
  const glm::vec3 smooth(irradiance_over_pi(smooth_light_, textured->smooth_normal)),
      bent(irradiance_over_pi(smooth_light_, point.normal));
  const glm::vec3 floor = kDarkest * glm::max(glm::vec3(smooth_light_.front()), 1e-20f);
  const glm::vec3 turned = glm::max(bent, floor) / glm::max(smooth, floor);
  return textured->occlusion * turned * point.irradiance_over_pi + direct / shading::kPi;
}

CpuObject::Shaded CpuObject::shade(const VisibleSurface& surface, const SurfacePoint& point, const glm::vec3& mirrored,
                                   const glm::vec3& exposure) const {
  std::array<float, kMaxLightSamples> shares;
  const TexturedSurface* textured = surface.textured_at(point);
  const auto& m = surface.material_at(point, materials_);
  const float roughness = m.emissive_roughness.w;
  const bool mirrors = m.base_color_metallic.w > 0 || m.dielectric.x > 0;
  const bool shines = mirrors && !direct_.samples().empty() && roughness >= shading::kMinHighlightRoughness;
  const glm::vec2 table = mirrors ? brdf_.at(glm::dot(point.normal, point.to_viewer), roughness) : glm::vec2(1, 0);
  const glm::vec4 factor = shading::mirror_factor(m, point.color, table);
  Shaded result{};
  if (mirrors) result.reflected = glm::vec3(factor) * mirrored;
  const glm::vec3 diffuse = arriving_over_pi(textured, point, shines, shares.data()) * shading::diffuse_albedo(m, point.color);
  if (shines) {
    const glm::vec3 f0 = shading::mirror_f0(m, point.color);
    const GlossySurface gloss{point.normal, point.to_viewer, roughness * roughness, f0, shading::mirror_f90(m)};
    result.reflected += shading::multiple_scattering(f0, table) * highlights_.radiance(gloss, shares.data());
  }
  // What the dielectric boundary mirrors does not reach the pigment below it.
  result.emitted = shading::emitted_radiance(m, point.color, exposure);
  result.radiance = diffuse * factor.w + result.reflected + result.emitted;
  return result;
}

/// Shades the points into their pixels. A pixel's points are shaded one after the other, on one thread.
void CpuObject::put(const FrameView& view, const VisibleSurface& surface, std::span<const glm::vec3> mirrored,
                    ObjectImages& images) const {
  const PixelRect& rect = surface.rect;
  const std::vector<SurfacePoint>& points = surface.points;
  const glm::mat3 camera_from_tag(view.camera_from_tag.rotation);
  /// The first point at `index` or later that is its pixel's first.
  const auto pixel_from = [&](std::size_t index) {
    while (index > 0 && index < points.size() && points[index].pixel == points[index - 1].pixel) ++index;
    return std::min(index, points.size());
  };
  parallel_for((points.size() + kPointsAtOnce - 1) / kPointsAtOnce, 0, [&](std::size_t chunk) {
    for (std::size_t i = pixel_from(chunk * kPointsAtOnce); i < pixel_from((chunk + 1) * kPointsAtOnce); ++i) {
      const SurfacePoint& point = points[i];
      direct_.prefetch(points[std::min(i + kFetchedAhead, points.size() - 1)]);
      const int x = static_cast<int>(point.pixel) % rect.width + rect.x - images.rect.x;
      const int y = static_cast<int>(point.pixel) / rect.width + rect.y - images.rect.y;
      const Shaded shaded = shade(surface, point, mirrored[i], view.exposure);
      add(images.color.pixel(x, y), exposed(view, shaded.radiance), point.coverage);
      images.color.pixel(x, y)[3] += point.coverage;
      if (!images.emission.data.empty()) add(images.emission.pixel(x, y), exposed(view, shaded.emitted), point.coverage);
      if (images.reflection.data.empty()) continue;
      add(images.reflection.pixel(x, y), exposed(view, shaded.reflected), point.coverage);
      add(images.normal_depth.pixel(x, y), camera_from_tag * point.normal, point.coverage);
      images.normal_depth.pixel(x, y)[3] += point.coverage * point.depth_m;
    }
  });
}

PixelRect CpuObject::covered(const FrameView& view, const FramePlan& plan) const {
  if (bounds_.empty()) return {};
  return intersect(visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, bounds_, kNear_m), plan.virtual_rect);
}

void CpuObject::draw(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays, const ReceiverShadow* shadow,
                     const PlateLight* plate, ObjectImages& images) {
  if (images.covered.empty()) return;
  around_.set_view(view, plan.distortion_limit, shadow, plate);
  VertexLight light{irradiance_over_pi_};
  if (materials_.reflects) light.direct_over_pi = direct_.at_vertices_over_pi();
  mirror_rays_.set_frame(around_, light, view.exposure);
  VisibleSurface& surface = finder_.find(view, plan.distortion_limit, pixel_rays, images.covered, irradiance_over_pi_);
  textures_.apply(view, surface);
  direct_.prepare(surface.points);
  put(view, surface, mirrored_.find(surface, around_, !direct_.samples().empty()), images);
}

}  // namespace catchlight::render
