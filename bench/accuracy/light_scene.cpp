#include "bench/accuracy/light_scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "catchlight/color.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

constexpr float kLift_m = 1e-6f;
constexpr int kGridPoints = 48, kGridRim = 6, kGridStep = 2;
/// Rays bring no more than this share of the probe's light where they stand for several texels or a piece of one.
constexpr double kMaxOfARay = 5e-5;
constexpr int kBlock = 4;  // texels along each side of what may share a ray

std::vector<SeenPoint> points_on(const Mesh& mesh) {
  std::vector<SeenPoint> points;
  for (const std::uint32_t v : used_vertices(mesh)) {
    const Vertex& vertex = mesh.vertices[v];
    points.push_back({vertex.position_m + kLift_m * vertex.normal, vertex.normal, v});
  }
  return points;
}

std::vector<SeenPoint> points_on_ground(const LightScene& scene) {
  std::vector<SeenPoint> points;
  for (int row = kGridRim; row < scene.grid.rows - kGridRim; row += kGridStep) {
    for (int column = kGridRim; column < scene.grid.columns - kGridRim; column += kGridStep) {
      const std::size_t p = static_cast<std::size_t>(row) * scene.grid.columns + column;
      const glm::vec3 up(0, 0, 1), origin_m(scene.grid.place_m(p), kLift_m);
      const auto above = scene.rays->closest_hit(origin_m, up);
      if (!above || above->front_facing) points.push_back({origin_m, up, p});
    }
  }
  return points;
}

double flux_at(const Probe& probe, int x, int y) {
  const float* rgb = probe.image.pixel(x, y);
  return texel_solid_angle(probe.layout, probe.image.width, probe.image.height, x, y) *
         glm::dot(kLuminanceWeights, glm::dvec3(rgb[0], rgb[1], rgb[2]));
}

class Rays {
 public:
  Rays(const Probe& probe, const glm::dmat3& tag_from_probe) : probe_(probe), tag_from_probe_(tag_from_probe) {
    double total = 0;
    for (int y = 0; y < probe.image.height; ++y)
      for (int x = 0; x < probe.image.width; ++x) total += flux_at(probe, x, y);
    most_ = kMaxOfARay * total;
  }

  void add_block(int x0, int y0) {
    const int x1 = std::min(x0 + kBlock, probe_.image.width), y1 = std::min(y0 + kBlock, probe_.image.height);
    double sum = 0;
    glm::dvec3 middle(0);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const double flux = flux_at(probe_, x, y);
        if (!(flux > 0)) continue;
        sum += flux;
        middle += flux * *direction_at(x, y);
      }
    }
    if (sum > most_)
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) add_texel(x, y);
    else if (sum > 0)
      rays_.push_back({glm::normalize(tag_from_probe_ * middle), sum});
  }

  std::vector<Ray> take() { return std::move(rays_); }

 private:
  std::optional<glm::dvec3> direction_at(double x, double y) const {
    return direction_from_texel(probe_.layout, probe_.image.width, probe_.image.height, x, y);
  }

  void add_texel(int x, int y) {
    const double flux = flux_at(probe_, x, y);
    const int across = static_cast<int>(std::ceil(std::sqrt(flux / most_)));
    for (int i = 0; i < across * across; ++i) {
      const glm::dvec2 within = (glm::dvec2(i % across, i / across) + 0.5) / static_cast<double>(across) - 0.5;
      const auto direction = direction_at(x + within.x, y + within.y);
      rays_.push_back({tag_from_probe_ * direction.value_or(*direction_at(x, y)), flux / (across * across)});
    }
  }

  const Probe& probe_;
  glm::dmat3 tag_from_probe_;
  double most_ = 0;
  std::vector<Ray> rays_;
};

}  // namespace

LightScene make_light_scene() {
  LightScene scene;
  scene.mesh = sphere({-0.03f, 0.0f, 0.025f}, 0.025f, 8);
  append(scene.mesh, box({0.01f, -0.02f, 0.0f}, {0.05f, 0.02f, 0.05f}));
  subdivide_long_edges(scene.mesh, 0.015, 10'000);
  scene.grid = receiver_grid_for(scene.mesh, kGridPoints);
  scene.rays = std::make_unique<RayScene>(scene.mesh);
  scene.object = points_on(scene.mesh);
  scene.ground = points_on_ground(scene);
  return scene;
}

std::vector<Ray> rays_of(const Probe& probe, const glm::dmat3& tag_from_probe) {
  Rays rays(probe, tag_from_probe);
  for (int y = 0; y < probe.image.height; y += kBlock)
    for (int x = 0; x < probe.image.width; x += kBlock) rays.add_block(x, y);
  return rays.take();
}

double brute_force(const LightScene& scene, const SeenPoint& point, const std::vector<Ray>& rays) {
  double sum = 0;
  for (const Ray& ray : rays) {
    const double cosine = glm::dot(point.normal, ray.direction);
    if (cosine > 0 && !scene.rays->occluded(point.origin_m, ray.direction)) sum += cosine * ray.flux;
  }
  return sum / glm::pi<double>();
}

double unshadowed(const glm::vec3& normal, const std::vector<Ray>& rays) {
  double sum = 0;
  for (const Ray& ray : rays) sum += std::max<double>(glm::dot(normal, ray.direction), 0.0) * ray.flux;
  return sum / glm::pi<double>();
}

}  // namespace catchlight::render
