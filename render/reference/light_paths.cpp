#include "render/reference/light_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catchlight/image.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render::reference {
namespace {

constexpr double kPi = std::numbers::pi;

// Share of the mesh's size by which rays start above a surface: a hundred times the rounding of its coordinates.
constexpr double kLift = 1e-5;

double lift_for(const Mesh& mesh) {
  const Bounds bounds = bounds_of(mesh);
  return bounds.empty() ? kLift : kLift * glm::distance(glm::dvec3(bounds.min_m), glm::dvec3(bounds.max_m));
}

// The matrix of columns x, y, z with z along n (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
glm::dmat3 frame_around(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// A direction of density cos / pi: a uniform point of the disc, lifted to the sphere.
glm::dvec3 cosine_direction(const glm::dvec2& square) {
  const double radius = std::sqrt(square.x), phi = 2 * kPi * square.y;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0, 1 - square.x))};
}

// The balance heuristic: the weight of a sample drawn with `density` that could have been drawn with `other` as well.
double balance(double density, double other) {
  return density / (density + other);
}

glm::dvec3 bilinear(const Image& image, const glm::dvec2& pixel) {
  const int x = std::min(static_cast<int>(pixel.x), image.width - 2), y = std::min(static_cast<int>(pixel.y), image.height - 2);
  const auto at = [&](int dx, int dy) {
    const float* value = image.pixel(x + dx, y + dy);
    return glm::dvec3(value[0], value[1], value[2]);
  };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), pixel.x - x), glm::mix(at(0, 1), at(1, 1), pixel.x - x), pixel.y - y);
}

}  // namespace

/// `density` is that of `direction`, had it been drawn; 0 where nobody chose it.
struct LightPaths::Path {
  glm::dvec3 origin_m, direction;
  glm::dvec3 throughput{1}, sum{0};
  double density = 0;
  bool after_matte = false;
  int reflections = 0;
};

struct LightPaths::Surface {
  glm::dvec3 position_m, outward;  ///< outward: the triangle's own normal
  glm::dmat3 frame;                ///< z along the smoothed normal
  Brdf brdf;
  glm::dvec3 emitted{0};
};

LightPaths::LightPaths(const ReferenceScene& scene, int bounces)
    : scene_(scene),
      bounces_(bounces),
      lift_m_(lift_for(scene.mesh)),
      light_(scene.probe, scene.tag_from_probe, scene.has_receiver),
      rays_(scene.mesh.indices.empty() ? nullptr : std::make_unique<RayScene>(scene.mesh)) {
  if (scene.has_receiver) {
    const glm::dvec3 irradiance = light_.irradiance({0, 0, 1});
    for (int c = 0; c < 3; ++c) one_over_irradiance_[c] = irradiance[c] > 0 ? 1 / irradiance[c] : 0.0;
  }
  if (scene.frame) frame_rays_.emplace(scene.frame->camera, scene.frame->camera_from_tag);
}

LightPaths::Meeting LightPaths::meet(const glm::dvec3& origin_m, const glm::dvec3& direction) const {
  Meeting nearest;
  double distance_m = std::numeric_limits<double>::infinity();
  if (const auto hit = rays_ ? rays_->closest_hit(origin_m, direction) : std::nullopt) {
    const auto corner = [&](int k) {
      return glm::dvec3(scene_.mesh.vertices[scene_.mesh.indices[3 * hit->triangle + k]].position_m);
    };
    const glm::dvec3 position_m = (1.0 - hit->u - hit->v) * corner(0) + double{hit->u} * corner(1) + double{hit->v} * corner(2);
    distance_m = glm::dot(position_m - origin_m, direction);
    nearest = {hit->front_facing ? Met::object : Met::back_of_object, position_m, *hit};
  }
  if (!scene_.has_receiver) return nearest;
  const bool is_above = origin_m.z > -2 * lift_m_;
  if (!is_above) return {Met::below_receiver, {}, {}};  // where it is dark
  if (direction.z < 0 && -origin_m.z / direction.z < distance_m) {
    const double to_plane_m = std::max(0.0, -origin_m.z / direction.z);
    return {Met::receiver, {origin_m.x + to_plane_m * direction.x, origin_m.y + to_plane_m * direction.y, 0}, {}};
  }
  return nearest;
}

// Whether something blocks the way to the sky.
bool LightPaths::blocked(const glm::dvec3& origin_m, const glm::dvec3& direction) const {
  if (scene_.has_receiver && origin_m.z < -2 * lift_m_) return true;
  return rays_ && rays_->occluded(origin_m, direction);
}

LightPaths::Surface LightPaths::surface_at(const Meeting& meeting, const glm::dvec3& direction) const {
  const RayHit& hit = meeting.hit;
  const Mesh& mesh = scene_.mesh;
  const auto corner = [&](int k) -> const Vertex& { return mesh.vertices[mesh.indices[3 * hit.triangle + k]]; };
  const glm::vec3 w(1 - hit.u - hit.v, hit.u, hit.v);
  const glm::dvec3 from(corner(0).position_m);
  const glm::dvec3 outward =
      glm::normalize(glm::cross(glm::dvec3(corner(1).position_m) - from, glm::dvec3(corner(2).position_m) - from));
  glm::dvec3 normal = glm::normalize(glm::dvec3(w.x * corner(0).normal + w.y * corner(1).normal + w.z * corner(2).normal));
  // A smoothed normal that looks away from who sees the surface gives way to the triangle's own.
  if (!(glm::dot(normal, -direction) > 1e-3 && glm::dot(normal, outward) > 0)) normal = outward;
  const Material& material = mesh.materials[mesh.triangle_material[hit.triangle]];
  const glm::vec3 color = w.x * corner(0).color + w.y * corner(1).color + w.z * corner(2).color;
  const glm::dvec3 emitted = glm::dvec3(material.emissive) + glm::dvec3(material.unlit_color * color) * scene_.unlit_radiance;
  return {meeting.position_m, outward, frame_around(normal), Brdf(material, color), emitted};
}

glm::dvec3 LightPaths::receiver_radiance(const glm::dvec3& point_m) const {
  if (frame_rays_) {
    const Image& frame = scene_.frame->radiance;
    const auto pixel = frame_rays_->pixel_of(point_m);
    if (pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x <= frame.width - 1 && pixel->y <= frame.height - 1)
      return bilinear(frame, *pixel);
  }
  return light_.radiance(glm::normalize(point_m - scene_.probe_in_tag_m));
}

// Adds what comes in along the path's ray, by as many reflections as are left.
void LightPaths::follow(Path& path, PointStream& points) const {
  for (;; ++path.reflections) {
    const Meeting meeting = meet(path.origin_m, path.direction);
    if (meeting.what == Met::back_of_object || meeting.what == Met::below_receiver) return;
    if (meeting.what == Met::sky) {
      const double weight = path.density > 0 ? balance(path.density, light_.density(path.direction)) : 1.0;
      path.sum += path.throughput * weight * light_.radiance(path.direction);
      return;
    }
    if (path.reflections > bounces_) return;
    if (meeting.what == Met::receiver) {
      const glm::dvec3 radiance = receiver_radiance(meeting.position_m);
      path.sum += path.throughput * radiance;
      if (!scatter_on_receiver(path, meeting.position_m, radiance * one_over_irradiance_, points)) return;
    } else {
      const Surface surface = surface_at(meeting, path.direction);
      path.sum += path.throughput * surface.emitted;
      if (!scatter(path, surface, points)) return;
    }
  }
}

// The probe in a direction drawn from it, reflected by both lobes.
void LightPaths::add_sampled_light(Path& path, const Surface& surface, double glossy_share, PointStream& points) const {
  const auto light = light_.sample(points.next());
  if (!light || (scene_.has_receiver && light->direction_tag.z <= 0)) return;
  const glm::dvec3 v = -path.direction * surface.frame, l = light->direction_tag * surface.frame;
  if (l.z <= 0 || glm::dot(light->direction_tag, surface.outward) <= 0) return;
  const double matte_density = (1 - glossy_share) * l.z / kPi;
  glm::dvec3 reflected = surface.brdf.diffuse_albedo(v) / kPi * balance(light->density, matte_density);
  if (!path.after_matte)
    reflected += surface.brdf.glossy(v, l) * balance(light->density, glossy_share * surface.brdf.glossy_density(v, l));
  if (reflected == glm::dvec3(0) || blocked(surface.position_m + lift_m_ * surface.outward, light->direction_tag)) return;
  path.sum += path.throughput * reflected * l.z * light->radiance / light->density;
}

// Turns the path into one of the surface's lobes. False where it ends.
bool LightPaths::scatter(Path& path, const Surface& surface, PointStream& points) const {
  const glm::dvec3 v = -path.direction * surface.frame;
  const glm::dvec3 matte = surface.brdf.diffuse_albedo(v);
  const double glossy_share = path.after_matte ? 0.0 : surface.brdf.glossy_share(v);
  if (matte == glm::dvec3(0) && glossy_share == 0) return false;
  add_sampled_light(path, surface, glossy_share, points);
  const bool is_glossy = points.next().x < glossy_share;
  const glm::dvec2 square = points.next();
  const glm::dvec3 l = is_glossy ? surface.brdf.sample_glossy(v, square) : cosine_direction(square);
  const glm::dvec3 direction = surface.frame * l;
  if (l.z <= 0 || glm::dot(direction, surface.outward) <= 0) return false;
  if (is_glossy) {
    path.density = glossy_share * surface.brdf.glossy_density(v, l);
    path.throughput *= surface.brdf.glossy(v, l) * l.z / path.density;
  } else {
    path.density = (1 - glossy_share) * l.z / kPi;
    path.throughput *= matte / (1 - glossy_share);
    path.after_matte = true;
  }
  path.origin_m = surface.position_m + lift_m_ * surface.outward;
  path.direction = direction;
  return path.throughput != glm::dvec3(0);
}

// What the object changes of the receiver's own radiance: in the directions where it is in the way, its light stands for the
// probe's. Where it is not, nothing is added, so nothing is noisy. False where the path meets nothing more.
bool LightPaths::scatter_on_receiver(Path& path, const glm::dvec3& point_m, const glm::dvec3& albedo_over_pi,
                                     PointStream& points) const {
  const glm::dvec3 origin_m = point_m + glm::dvec3(0, 0, lift_m_);
  const auto light = light_.sample(points.next());
  if (light && light->direction_tag.z > 0 && blocked(origin_m, light->direction_tag)) {
    const double z = light->direction_tag.z;
    path.sum -= path.throughput * albedo_over_pi * light->radiance * z / light->density * balance(light->density, z / kPi);
  }
  const glm::dvec3 direction = cosine_direction(points.next());
  if (!(direction.z > 0) || !blocked(origin_m, direction)) return false;
  path.origin_m = origin_m;
  path.direction = direction;
  path.density = direction.z / kPi;
  path.throughput *= albedo_over_pi * kPi;
  path.after_matte = true;
  path.sum -= path.throughput * light_.radiance(direction) * balance(path.density, light_.density(direction));
  return true;
}

Seen LightPaths::look(const glm::dvec3& origin_m, const glm::dvec3& direction, PointStream points) const {
  const Meeting meeting = meet(origin_m, direction);
  if (meeting.what == Met::receiver) return {glm::dvec3(0), receiver_ratio(meeting.position_m, points)};
  if (meeting.what == Met::sky || meeting.what == Met::below_receiver) return {glm::dvec3(0), glm::dvec3(1)};
  Path path{origin_m, direction};
  follow(path, points);
  return {path.sum, glm::dvec3(0)};
}

glm::dvec3 LightPaths::exit_radiance(const MattePoint& point, PointStream points) const {
  const glm::dvec3 normal = glm::normalize(point.normal);
  const Surface surface{point.position_m, normal, frame_around(normal), Brdf::lambertian(point.albedo)};
  Path path{point.position_m, -normal};
  if (scatter(path, surface, points)) {
    ++path.reflections;
    follow(path, points);
  }
  return path.sum;
}

glm::dvec3 LightPaths::receiver_ratio(const glm::dvec2& point_m, PointStream points) const {
  Path path{};
  path.sum = glm::dvec3(1);
  if (scatter_on_receiver(path, {point_m, 0}, one_over_irradiance_, points)) {
    ++path.reflections;
    follow(path, points);
  }
  return path.sum;
}

}  // namespace catchlight::render::reference
