#include "render/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "render/hemisphere_rays.hpp"
#include "render/parallel.hpp"
#include "render/ray_scene.hpp"
#include "render/sh.hpp"

namespace catchlight::render {
namespace {

constexpr std::size_t kPointsPerTask = 64;
constexpr int kRimCells = 4;      // over which the receiver's shadow fades to nothing
constexpr int kCoveredRings = 2;  // of covered points that are filled from their neighbours

// Rays start this share of the mesh's size above the surface: a hundred times the rounding of its coordinates, a hundredth of a
// pixel.
constexpr float kLift = 1e-5f;

using Basis = std::array<float, kMaxShBands * kMaxShBands>;

struct Bounds {
  glm::vec3 min_m{INFINITY}, max_m{-INFINITY};
};

Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds;
  for (const std::uint32_t index : mesh.indices) {
    bounds.min_m = glm::min(bounds.min_m, mesh.vertices[index].position_m);
    bounds.max_m = glm::max(bounds.max_m, mesh.vertices[index].position_m);
  }
  return bounds;
}

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
    middle_m_ = (bounds.min_m + bounds.max_m) * 0.5f;
    radius_m_ = glm::distance(bounds.min_m, bounds.max_m) * 0.5f;
    lift_m_ = kLift * 2 * radius_m_;
  }

  Transfer bake(const ReceiverGrid& grid) {
    const std::size_t points = static_cast<std::size_t>(grid.columns) * grid.rows, vertices = mesh_.vertices.size();
    total_ = static_cast<double>(vertices) * (1 + options_.bounces) + static_cast<double>(points);
    Transfer transfer{options_.bands, {}, grid, {}, std::vector<float>(count_)};
    unshadowed_lobe(glm::vec3(0, 0, 1), options_.bands, transfer.receiver_unshadowed);
    transfer.object.resize(vertices * count_);
    for_points(vertices, [&](std::size_t v) { bake_direct(v, coefficients(transfer.object, v)); });
    const std::vector<glm::vec3> direct = transfer.object;
    for (int bounce = 0; bounce < options_.bounces; ++bounce) {
      const std::vector<glm::vec3> before = transfer.object;
      for_points(vertices, [&](std::size_t v) { bake_bounce(v, direct, before, coefficients(transfer.object, v)); });
    }
    transfer.receiver.resize(points * count_);
    std::vector<char> covered(points);
    for_points(points, [&](std::size_t p) { covered[p] = bake_receiver(p, transfer); });
    fill_covered(transfer, covered);
    fade_rim(transfer);
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

  // visit(origin, direction) for every ray of the point.
  template <typename Visit>
  void for_rays(const glm::vec3& position_m, const glm::vec3& normal, const Visit& visit) const {
    const Hemisphere hemisphere(normal);
    const glm::vec3 origin_m = position_m + lift_m_ * glm::normalize(normal);
    const std::uint32_t seed = seed_of(position_m, normal, options_.seed);
    for (int k = 0; k < options_.rays; ++k) visit(origin_m, hemisphere.direction(scrambled_sobol(k, seed)));
  }

  // The closed form of the open hemisphere less what the occluded rays would have brought: exact where nothing is in the way, and
  // elsewhere only the blocked part is uncertain.
  void bake_direct(std::size_t v, std::span<glm::vec3> out) const {
    const Vertex& vertex = mesh_.vertices[v];
    if (albedo_[v] == glm::vec3(0)) return;
    Basis lobe, basis, blocked{};
    unshadowed_lobe(vertex.normal, options_.bands, std::span(lobe).first(count_));
    for_rays(vertex.position_m, vertex.normal, [&](const glm::vec3& origin_m, const glm::vec3& direction) {
      if (!scene_.occluded(origin_m, direction)) return;
      evaluate_sh(direction, options_.bands, std::span(basis).first(count_));
      for (int i = 0; i < count_; ++i) blocked[i] += basis[i];
    });
    for (int i = 0; i < count_; ++i) out[i] = albedo_[v] * (lobe[i] - blocked[i] / static_cast<float>(options_.rays));
  }

  // Light on its way over one more surface: what the front faces that the rays hit send back. (The same rays as before.)
  void bake_bounce(std::size_t v, const std::vector<glm::vec3>& direct, const std::vector<glm::vec3>& before,
                   std::span<glm::vec3> out) const {
    if (albedo_[v] == glm::vec3(0)) return;
    const float share = 1.0f / static_cast<float>(options_.rays);
    std::array<glm::vec3, kMaxShBands * kMaxShBands> arriving{};
    for_rays(mesh_.vertices[v].position_m, mesh_.vertices[v].normal, [&](const glm::vec3& origin_m, const glm::vec3& direction) {
      if (const auto hit = scene_.closest_hit(origin_m, direction)) add_exit_radiance(*hit, before, share, arriving);
    });
    for (int i = 0; i < count_; ++i) out[i] = direct[v * count_ + i] + albedo_[v] * arriving[i];
  }

  void add_exit_radiance(const RayHit& hit, const std::vector<glm::vec3>& object, float share, std::span<glm::vec3> sum) const {
    if (!hit.front_facing) return;  // the inside of a solid is dark
    const std::array<float, 3> weight{share * (1 - hit.u - hit.v), share * hit.u, share * hit.v};
    for (int k = 0; k < 3; ++k) {
      const glm::vec3* corner = &object[static_cast<std::size_t>(mesh_.indices[3 * hit.triangle + k]) * count_];
      for (int i = 0; i < count_; ++i) sum[i] += weight[k] * corner[i];
    }
  }

  glm::vec3 receiver_point(const ReceiverGrid& grid, std::size_t p) const {
    const auto place = [](float from, float to, std::size_t i, int count) {
      return count > 1 ? from + (to - from) * static_cast<float>(i) / static_cast<float>(count - 1) : from;
    };
    return {place(grid.min_m.x, grid.max_m.x, p % grid.columns, grid.columns),
            place(grid.min_m.y, grid.max_m.y, p / grid.columns, grid.rows), lift_m_};
  }

  // visit(direction, weight): sum of weight * f = (1 / pi) integral of max(z, 0) f dw for any f that is 0 where the object is
  // not. From afar the object is small in the sky: there the rays go into the cone around its bounding sphere, uniformly.
  template <typename Visit>
  void for_receiver_rays(const glm::vec3& origin_m, const Visit& visit) const {
    const std::uint32_t seed = seed_of(origin_m, glm::vec3(0, 0, 1), options_.seed);
    const glm::vec3 to_middle_m = middle_m_ - origin_m;
    const double sin_cone = radius_m_ / glm::length(to_middle_m);
    const bool narrow = sin_cone < 0.7;
    const double cos_cone = narrow ? std::sqrt(1 - sin_cone * sin_cone) : 0;
    const Hemisphere hemisphere(narrow ? to_middle_m : glm::vec3(0, 0, 1));
    for (int k = 0; k < options_.rays; ++k) {
      const glm::dvec2 square = scrambled_sobol(k, seed);
      const glm::vec3 direction = narrow ? hemisphere.cone_direction(square, cos_cone) : hemisphere.direction(square);
      const double weight = narrow ? 2 * (1 - cos_cone) * std::max(direction.z, 0.0f) : 1.0;
      if (weight > 0) visit(direction, static_cast<float>(weight / options_.rays));
    }
  }

  // Returns whether the object covers the point: no ray escapes, so no camera sees it, and a good part of them look at back faces
  // (half of them where the point lies on a wall).
  bool bake_receiver(std::size_t p, Transfer& transfer) const {
    const glm::vec3 origin_m = receiver_point(transfer.grid, p);
    Basis basis;
    std::array<glm::vec3, kMaxShBands * kMaxShBands> change{};
    float blocked = 0, inside = 0;
    for_receiver_rays(origin_m, [&](const glm::vec3& direction, float weight) {
      const auto hit = scene_.closest_hit(origin_m, direction);
      if (!hit) return;
      blocked += weight;
      if (!hit->front_facing) inside += weight;
      evaluate_sh(direction, options_.bands, std::span(basis).first(count_));
      for (int i = 0; i < count_; ++i) change[i] -= weight * basis[i];
      if (options_.bounces > 0) add_exit_radiance(*hit, transfer.object, weight, change);
    });
    const std::span<glm::vec3> out = coefficients(transfer.receiver, p);
    for (int i = 0; i < count_; ++i) out[i] = transfer.receiver_unshadowed[i] + change[i];
    return blocked > 1 - 0.5f / static_cast<float>(options_.rays) && inside > 0.25f;
  }

  // Covered points are never seen, but the points beside it are blended with them along the contact line: those next
  // to the border take the mean of their open neighbours, so that neither darkness nor light leaks out.
  void fill_covered(Transfer& transfer, std::vector<char>& covered) const {
    const int columns = transfer.grid.columns, rows = transfer.grid.rows;
    for (int ring = 0; ring < kCoveredRings; ++ring) {
      const std::vector<char> before = covered;
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          const std::size_t p = static_cast<std::size_t>(y) * columns + x;
          if (before[p]) covered[p] = !fill_from_neighbours(transfer, before, x, y);
        }
      }
    }
  }

  bool fill_from_neighbours(Transfer& transfer, const std::vector<char>& covered, int x, int y) const {
    const int columns = transfer.grid.columns, rows = transfer.grid.rows;
    std::vector<glm::vec3> sum(count_, glm::vec3(0));
    int open = 0;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, rows - 1); ++ny) {
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, columns - 1); ++nx) {
        const std::size_t neighbour = static_cast<std::size_t>(ny) * columns + nx;
        if (covered[neighbour]) continue;
        ++open;
        for (int i = 0; i < count_; ++i) sum[i] += transfer.receiver[neighbour * count_ + i];
      }
    }
    if (open == 0) return false;
    const std::span<glm::vec3> out = coefficients(transfer.receiver, static_cast<std::size_t>(y) * columns + x);
    for (int i = 0; i < count_; ++i) out[i] = sum[i] / static_cast<float>(open);
    return true;
  }

  // Beyond the grid nothing is shadowed, so at its rim nothing may be: no border shows.
  void fade_rim(Transfer& transfer) const {
    const int columns = transfer.grid.columns, rows = transfer.grid.rows;
    const int cells = std::min({kRimCells, (columns - 1) / 2, (rows - 1) / 2});
    if (cells < 1) return;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const int from_rim = std::min({x, y, columns - 1 - x, rows - 1 - y});
        if (from_rim >= cells) continue;
        const float t = static_cast<float>(from_rim) / static_cast<float>(cells), kept = t * t * (3 - 2 * t);
        const std::span<glm::vec3> out = coefficients(transfer.receiver, static_cast<std::size_t>(y) * columns + x);
        for (int i = 0; i < count_; ++i) out[i] = glm::mix(glm::vec3(transfer.receiver_unshadowed[i]), out[i], kept);
      }
    }
  }

  const Mesh& mesh_;
  const TransferOptions& options_;
  const ProgressHandler& progress_;
  int count_;
  RayScene scene_;
  std::vector<glm::vec3> albedo_;
  glm::vec3 middle_m_{0};  // of a sphere around the object
  float radius_m_ = 0, lift_m_ = 0;
  double done_ = 0, total_ = 1;
};

}  // namespace

ReceiverGrid receiver_grid_for(const Mesh& mesh_tag, int points_across) {
  const Bounds bounds = bounds_of(mesh_tag);
  if (points_across < 2 || !(bounds.max_m.z > 0)) return {};
  // Twice the height away the object fills 1 % of the cosine-weighted sky or less.
  const glm::vec2 margin(2 * bounds.max_m.z);
  ReceiverGrid grid{glm::vec2(bounds.min_m) - margin, glm::vec2(bounds.max_m) + margin, 0, 0};
  const glm::vec2 size = grid.max_m - grid.min_m;
  const float cell = std::max(size.x, size.y) / static_cast<float>(points_across - 1);
  grid.columns = static_cast<int>(std::ceil(size.x / cell - 1e-3f)) + 1;
  grid.rows = static_cast<int>(std::ceil(size.y / cell - 1e-3f)) + 1;
  grid.max_m = grid.min_m + cell * glm::vec2(grid.columns - 1, grid.rows - 1);
  return grid;
}

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
