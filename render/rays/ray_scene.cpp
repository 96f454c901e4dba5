#include "render/rays/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "catchlight/error.hpp"

namespace catchlight::render {

struct RayScene::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Handles() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

namespace {

void fill(RTCRay& ray, const glm::vec3& origin_m, const glm::vec3& direction) {
  ray.org_x = origin_m.x, ray.org_y = origin_m.y, ray.org_z = origin_m.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = 0.0f;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = 0xffffffffu;
  ray.flags = 0;
}

RTCIntersectContext context_for(Coherence coherence) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

RTCRayNp ray_pointers(RayStream& rays) {
  RTCRayNp pointers{};  // Embree takes the members that are left out as 0, and all bits of the mask as set
  pointers.org_x = rays.origin_x_m.data(), pointers.org_y = rays.origin_y_m.data(), pointers.org_z = rays.origin_z_m.data();
  pointers.dir_x = rays.direction_x.data(), pointers.dir_y = rays.direction_y.data(), pointers.dir_z = rays.direction_z.data();
  pointers.tnear = rays.near.data(), pointers.tfar = rays.far.data();
  return pointers;
}

void attach_triangles(RTCDevice device, RTCScene scene, const Mesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.vertices.size()));
  auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                      3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
  if (positions && corners) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) positions[i] = mesh.vertices[i].position_m;
    std::memcpy(corners, mesh.indices.data(), mesh.indices.size() * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
  }
  rtcReleaseGeometry(geometry);
}

}  // namespace

RayScene::RayScene(const Mesh& mesh) : mesh_(mesh), handles_(std::make_unique<Handles>()) {
  handles_->device = rtcNewDevice(nullptr);
  if (!handles_->device) throw Error("Embree cannot be started (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  handles_->scene = rtcNewScene(handles_->device);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between neighbours
  rtcSetSceneBuildQuality(handles_->scene, RTC_BUILD_QUALITY_HIGH);
  attach_triangles(handles_->device, handles_->scene, mesh);
  rtcCommitScene(handles_->scene);
  const RTCError error = rtcGetDeviceError(handles_->device);
  if (error != RTC_ERROR_NONE) {
    throw Error("Embree cannot take a mesh of " + std::to_string(mesh.indices.size() / 3) + " triangles (error " +
                std::to_string(error) + ")");
  }
}

RayScene::~RayScene() = default;

bool RayScene::occluded(const glm::vec3& origin_m, const glm::vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  fill(ray, origin_m, direction);
  rtcOccluded1(handles_->scene, &context, &ray);
  return ray.tfar < 0;
}

std::optional<RayHit> RayScene::closest_hit(const glm::vec3& origin_m, const glm::vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  fill(ray.ray, origin_m, direction);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(handles_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const auto corner = [&](int k) { return mesh_.vertices[mesh_.indices[3 * ray.hit.primID + k]].position_m; };
  const glm::vec3 outward = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
  return RayHit{ray.hit.primID, ray.hit.u, ray.hit.v, glm::dot(outward, direction) < 0};
}

void RayScene::closest_hits(RayStream& rays, Coherence coherence) const {
  std::ranges::fill(rays.triangle, RayStream::kNothing);
  std::ranges::fill(rays.geometry, RTC_INVALID_GEOMETRY_ID);
  RTCIntersectContext context = context_for(coherence);
  RTCRayHitNp stream{ray_pointers(rays), {}};
  stream.hit.Ng_x = rays.normal_x.data(), stream.hit.Ng_y = rays.normal_y.data(), stream.hit.Ng_z = rays.normal_z.data();
  stream.hit.u = rays.u.data(), stream.hit.v = rays.v.data();
  stream.hit.primID = rays.triangle.data();
  stream.hit.geomID = rays.geometry.data();
  rtcIntersectNp(handles_->scene, &context, &stream, static_cast<unsigned>(rays.size()));
}

void RayScene::find_occluded(RayStream& rays, Coherence coherence) const {
  RTCIntersectContext context = context_for(coherence);
  const RTCRayNp stream = ray_pointers(rays);
  rtcOccludedNp(handles_->scene, &context, &stream, static_cast<unsigned>(rays.size()));
}

}  // namespace catchlight::render
