#include "render/transfer/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "catchlight/util/parallel.hpp"
#include "render/math/hemisphere_rays.hpp"
#include "render/math/sh.hpp"
#include "render/mesh/bounds.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/transfer/interior_vertices.hpp"

namespace catchlight::render {
namespace {

constexpr std::size_t kPointsPerTask = 64;

// Rays start this share of the mesh's size above the surface: a hundred times the rounding of its coordinates, a hundredth of a
// pixel.
constexpr float kLift = 1e-5f;

constexpr float kMinBounce = 0.004f;  // share of the brightest spot: what comes back of less is below one code of 255
constexpr int kMinRays = 256;

using Basis = std::array<float, kMaxShBands * kMaxShBands>;

// Diffuse albedo of each vertex; of a vertex that triangles of several materials share, the first one's. Metals have none.
std::vector<glm::vec3> diffuse_albedos(const Mesh& mesh) {
  std::vector<glm::vec3> albedo(mesh.vertices.size(), glm::vec3(0));
  std::vector<bool> known(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t vertex = mesh.indices[i];
    if (known[vertex]) continue;
    known[vertex] = true;
    const Material& material = mesh.materials[mesh.triangle_material[i / 3]];
    albedo[vertex] = material.base_color * mesh.vertices[vertex].color * (1.0f - material.metallic);
  }
  return albedo;
}

// (1 / pi) integral of max(n . w, 0) y_i(w) dw.
void unshadowed_lobe(const glm::vec3& normal, int bands, std::span<float> lobe) {
  evaluate_sh(glm::normalize(glm::dvec3(normal)), bands, lobe);
  for (int l = 0; l < bands; ++l) {
    const float scale = static_cast<float>(cosine_lobe_over_pi(l));
    for (int m = -l; m <= l; ++m) lobe[sh_index(l, m)] *= scale;
  }
}

class Baker {
 public:
  Baker(const Mesh& mesh, const TransferOptions& options, const ProgressHandler& progress)
      : mesh_(mesh),
        options_(options),
        progress_(progress),
        count_(sh_count(options.bands)),
        scene_(mesh),
        albedo_(diffuse_albedos(mesh)) {
    const Bounds bounds = bounds_of(mesh);
    middle_m_ = bounds.middle_m();
    radius_m_ = bounds.diagonal_m() * 0.5f;
    lift_m_ = kLift * 2 * radius_m_;
  }

  Transfer bake(const ReceiverGrid& grid) {
    const std::size_t vertices = mesh_.vertices.size();
    total_ = static_cast<double>(vertices + grid.points()) * (1 + options_.bounces);
    Transfer transfer;
    transfer.bands = options_.bands;
    transfer.grid = grid;
    transfer.receiver_unshadowed.resize(count_);
    unshadowed_lobe(glm::vec3(0, 0, 1), options_.bands, transfer.receiver_unshadowed);
    receiver_sends_back_ = options_.bounces > 0 && grid.points() > 0 && options_.receiver_albedo.known();
    transfer.object_direct.resize(vertices * count_);
    std::vector<char> is_interior(vertices);
    for_points(vertices, [&](std::size_t v) { is_interior[v] = bake_direct(v, coefficients(transfer.object_direct, v)); });
    const InteriorVertices interior(mesh_, is_interior);
    interior.fill(transfer.object_direct);
    const std::vector<char> covered = bake_receiver_direct(transfer);
    transfer.object = transfer.object_direct;
    transfer.receiver = transfer.receiver_direct;
    bake_bounces(transfer, interior, covered);
    if (progress_) progress_(1.0);  // light may have died away before the last bounce
    return transfer;
  }

 private:
  std::span<glm::vec3> coefficients(std::vector<glm::vec3>& all, std::size_t i) const {
    return std::span(all).subspan(i * count_, count_);
  }

  template <typename Work>
  void for_points(std::size_t points, const Work& work) {
    const std::size_t tasks = (points + kPointsPerTask - 1) / kPointsPerTask;
    const auto tell = [&](double share) { progress_((done_ + share * static_cast<double>(points)) / total_); };
    const auto run = [&](std::size_t task) {
      for (std::size_t i = task * kPointsPerTask; i < std::min(points, (task + 1) * kPointsPerTask); ++i) work(i);
    };
    parallel_for(tasks, options_.threads, run, progress_ ? ProgressHandler(tell) : ProgressHandler());
    done_ += static_cast<double>(points);
  }

  // Calls visit(origin, direction) for every ray of the point.
  template <typename Visit>
  void for_rays(const glm::vec3& position_m, const glm::vec3& normal, int rays, const Visit& visit) const {
    const Hemisphere hemisphere(normal);
    glm::vec3 origin_m = position_m + lift_m_ * glm::normalize(normal);
    if (receiver_sends_back_) origin_m.z = std::max(origin_m.z, lift_m_);
    const std::uint32_t seed = seed_of(position_m, normal, options_.seed);
    for (int k = 0; k < rays; ++k) visit(origin_m, hemisphere.direction(scrambled_sobol(k, seed)));
  }

  // The transfer is the closed form of the open hemisphere less what the occluded rays would have brought: exact where nothing is
  // in the way, and elsewhere only the blocked part is uncertain. Returns whether the vertex lies within another part.
  bool bake_direct(std::size_t v, std::span<glm::vec3> out) const {
    const Vertex& vertex = mesh_.vertices[v];
    if (albedo_[v] == glm::vec3(0)) return false;
    int escaped = 0;
    Basis lobe, basis, blocked{};
    unshadowed_lobe(vertex.normal, options_.bands, std::span(lobe).first(count_));
    for_rays(vertex.position_m, vertex.normal, options_.rays, [&](const glm::vec3& origin_m, const glm::vec3& direction) {
      if (!scene_.occluded(origin_m, direction)) {
        ++escaped;
        return;
      }
      evaluate_sh(direction, options_.bands, std::span(basis).first(count_));
      for (int i = 0; i < count_; ++i) blocked[i] += basis[i];
    });
    for (int i = 0; i < count_; ++i) out[i] = albedo_[v] * (lobe[i] - blocked[i] / static_cast<float>(options_.rays));
    return escaped == 0 && looks_at_backs(vertex);
  }

  // Whether rays meet backs of faces, as from within a solid; in a narrow gap or a closed room they meet fronts.
  bool looks_at_backs(const Vertex& vertex) const {
    constexpr int kRays = 64;
    int backs = 0;
    for_rays(vertex.position_m, vertex.normal, kRays, [&](const glm::vec3& origin_m, const glm::vec3& direction) {
      const auto hit = scene_.closest_hit(origin_m, direction);
      backs += hit && !hit->front_facing;
    });
    return backs > kRays / 2;
  }

  // Sends light over one more surface each time, until it stops mattering. What came last is passed on alone, so that fewer rays
  // do for it the less it is.
  void bake_bounces(Transfer& transfer, const InteriorVertices& interior, const std::vector<char>& covered) {
    const std::size_t vertices = mesh_.vertices.size();
    std::vector<glm::vec3> last = transfer.object_direct, sent_up = sent_up_by(transfer.receiver_direct, transfer.grid);
    for (int bounce = 0; bounce < options_.bounces && largest(last) > kMinBounce * largest(transfer.object); ++bounce) {
      const int rays = std::max(options_.rays >> (2 * bounce), std::min(options_.rays, kMinRays));
      std::vector<glm::vec3> next(last.size()), on_receiver(transfer.receiver.size());
      for_points(vertices, [&](std::size_t v) { gather(v, rays, last, transfer, sent_up, bounce == 0, coefficients(next, v)); });
      for_points(transfer.grid.points(),
                 [&](std::size_t p) { gather_on_receiver(p, rays, last, transfer.grid, coefficients(on_receiver, p)); });
      interior.fill(next);
      finish_receiver(transfer.grid, covered, std::vector(count_, glm::vec3(0)), on_receiver);
      add(next, transfer.object);
      add(on_receiver, transfer.receiver);
      sent_up = sent_up_by(on_receiver, transfer.grid);
      last = std::move(next);
    }
  }

  // The largest first coefficient; all others stay below it.
  float largest(const std::vector<glm::vec3>& all) const {
    float most = 0;
    for (std::size_t i = 0; i < all.size(); i += count_) most = std::max({most, all[i].x, all[i].y, all[i].z});
    return most;
  }

  static void add(const std::vector<glm::vec3>& more, std::vector<glm::vec3>& sum) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
  }

  // Gathers what leaves the vertex of the light that front faces and the receiver sent in its direction.
  void gather(std::size_t v, int rays, const std::vector<glm::vec3>& sent, const Transfer& transfer,
              const std::vector<glm::vec3>& sent_up, bool first_time, std::span<glm::vec3> out) const {
    if (albedo_[v] == glm::vec3(0)) return;
    const float share = 1.0f / static_cast<float>(rays);
    for_rays(mesh_.vertices[v].position_m, mesh_.vertices[v].normal, rays,
             [&](const glm::vec3& origin_m, const glm::vec3& direction) {
               if (const auto hit = scene_.closest_hit(origin_m, direction)) {
                 add_exit_radiance(*hit, sent, share, out);
               } else if (receiver_sends_back_ && direction.z < 0) {
                 const glm::vec2 place_m = glm::vec2(origin_m) - origin_m.z / direction.z * glm::vec2(direction);
                 const auto p = transfer.grid.nearest(place_m);
                 for (int i = 0; p && i < count_; ++i) out[i] += share * sent_up[*p * count_ + i];
                 if (first_time) correct_for_receiver(place_m, direction, !p, transfer, share, out);
               }
             });
    for (glm::vec3& value : out) value *= albedo_[v];
  }

  // The light counts what the probe saw below the plane as infinitely far away and open to the sky: this takes that out, for what
  // is met where the plane is. Both are shares of the light that reaches the plane, so no sharp horizon has to be held by a few
  // bands.
  void correct_for_receiver(const glm::vec2& place_m, const glm::vec3& direction, bool beyond_grid, const Transfer& transfer,
                            float share, std::span<glm::vec3> sum) const {
    glm::vec3 albedo = -options_.receiver_albedo.towards(direction);
    if (beyond_grid) albedo += options_.receiver_albedo.at(place_m);
    for (int i = 0; i < count_; ++i) sum[i] += share * transfer.receiver_unshadowed[i] * albedo;
  }

  // The light that each of the receiver's points sends back.
  std::vector<glm::vec3> sent_up_by(const std::vector<glm::vec3>& receiver, const ReceiverGrid& grid) const {
    std::vector<glm::vec3> sent_up;
    if (!receiver_sends_back_) return sent_up;
    sent_up.reserve(receiver.size());
    for (std::size_t p = 0; p < grid.points(); ++p) {
      const glm::vec3 albedo = options_.receiver_albedo.at(grid.place_m(p));
      for (int i = 0; i < count_; ++i) sent_up.push_back(albedo * receiver[p * count_ + i]);
    }
    return sent_up;
  }

  void add_exit_radiance(const RayHit& hit, const std::vector<glm::vec3>& object, float share, std::span<glm::vec3> sum) const {
    if (!hit.front_facing) return;  // the inside of a solid is dark
    const std::array<float, 3> weight{share * (1 - hit.u - hit.v), share * hit.u, share * hit.v};
    for (int k = 0; k < 3; ++k) {
      const glm::vec3* corner = &object[static_cast<std::size_t>(mesh_.indices[3 * hit.triangle + k]) * count_];
      for (int i = 0; i < count_; ++i) sum[i] += weight[k] * corner[i];
    }
  }

  // Calls visit(direction, weight) so that the sum of weight * f = (1 / pi) integral of max(z, 0) f dw for any f that is 0 where
  // the object is not. From afar the object is small in the sky: there the rays go into the cone around its bounding sphere,
  // uniformly.
  template <typename Visit>
  void for_receiver_rays(const glm::vec3& origin_m, int rays, const Visit& visit) const {
    const std::uint32_t seed = seed_of(origin_m, glm::vec3(0, 0, 1), options_.seed);
    const glm::vec3 to_middle_m = middle_m_ - origin_m;
    const double sin_cone = radius_m_ / glm::length(to_middle_m);
    const bool narrow = sin_cone < 0.7;
    const double cos_cone = narrow ? std::sqrt(1 - sin_cone * sin_cone) : 0;
    const Hemisphere hemisphere(narrow ? to_middle_m : glm::vec3(0, 0, 1));
    for (int k = 0; k < rays; ++k) {
      const glm::dvec2 square = scrambled_sobol(k, seed);
      const glm::vec3 direction = narrow ? hemisphere.cone_direction(square, cos_cone) : hemisphere.direction(square);
      const double weight = narrow ? 2 * (1 - cos_cone) * std::max(direction.z, 0.0f) : 1.0;
      if (weight > 0) visit(direction, static_cast<float>(weight / rays));
    }
  }

  // Fills receiver_direct. Returns which points the object covers: no ray escapes, so no camera sees them, and a good part of
  // them look at back faces (half of them where the point lies on a wall).
  std::vector<char> bake_receiver_direct(Transfer& transfer) {
    const ReceiverGrid& grid = transfer.grid;
    transfer.receiver_direct.resize(grid.points() * count_);
    std::vector<char> covered(grid.points());
    for_points(grid.points(), [&](std::size_t p) {
      const glm::vec3 origin_m(grid.place_m(p), lift_m_);
      Basis basis, blocked_light{};
      float blocked = 0, inside = 0;
      for_receiver_rays(origin_m, options_.rays, [&](const glm::vec3& direction, float weight) {
        const auto hit = scene_.closest_hit(origin_m, direction);
        if (!hit) return;
        blocked += weight;
        if (!hit->front_facing) inside += weight;
        evaluate_sh(direction, options_.bands, std::span(basis).first(count_));
        for (int i = 0; i < count_; ++i) blocked_light[i] += weight * basis[i];
      });
      const std::span<glm::vec3> out = coefficients(transfer.receiver_direct, p);
      for (int i = 0; i < count_; ++i) out[i] = glm::vec3(transfer.receiver_unshadowed[i] - blocked_light[i]);
      covered[p] = blocked > 1 - 0.5f / static_cast<float>(options_.rays) && inside > 0.25f;
    });
    const std::vector<glm::vec3> unshadowed(transfer.receiver_unshadowed.begin(), transfer.receiver_unshadowed.end());
    finish_receiver(grid, covered, unshadowed, transfer.receiver_direct);
    return covered;
  }

  // Gathers what the object sends down to the point.
  void gather_on_receiver(std::size_t p, int rays, const std::vector<glm::vec3>& sent, const ReceiverGrid& grid,
                          std::span<glm::vec3> out) const {
    const glm::vec3 origin_m(grid.place_m(p), lift_m_);
    for_receiver_rays(origin_m, rays, [&](const glm::vec3& direction, float weight) {
      if (const auto hit = scene_.closest_hit(origin_m, direction)) add_exit_radiance(*hit, sent, weight, out);
    });
  }

  static void finish_receiver(const ReceiverGrid& grid, const std::vector<char>& covered, const std::vector<glm::vec3>& beyond,
                              std::span<glm::vec3> values) {
    fill_covered(grid, covered, values);
    fade_rim(grid, beyond, values);
  }

  const Mesh& mesh_;
  const TransferOptions& options_;
  const ProgressHandler& progress_;
  int count_;
  RayScene scene_;
  std::vector<glm::vec3> albedo_;
  glm::vec3 middle_m_{0};  // middle of a sphere around the object
  float radius_m_ = 0, lift_m_ = 0;
  bool receiver_sends_back_ = false;
  double done_ = 0, total_ = 1;
};

}  // namespace

Transfer bake_transfer(const Mesh& mesh_tag, const ReceiverGrid& grid, const TransferOptions& options,
                       const ProgressHandler& progress) {
  if (mesh_tag.indices.empty()) throw Error("light transfer: the mesh has no triangles");
  if (options.bands < 1 || options.bands > kMaxShBands) {
    throw Error("light transfer: " + std::to_string(options.bands) + " bands: expected 1 to " + std::to_string(kMaxShBands));
  }
  if (options.rays < 1) throw Error("light transfer: " + std::to_string(options.rays) + " rays: expected at least 1");
  if (options.bounces < 0) throw Error("light transfer: " + std::to_string(options.bounces) + " bounces: expected 0 or more");
  return Baker(mesh_tag, options, progress).bake(grid);
}

}  // namespace catchlight::render
