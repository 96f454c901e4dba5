#include "render/transfer/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "catchlight/util/parallel.hpp"
#include "render/math/sh.hpp"
#include "render/transfer/bake_points.hpp"
#include "render/transfer/interior_vertices.hpp"

namespace catchlight::render {
namespace {

constexpr std::size_t kPointsPerTask = 64;

constexpr float kMinBounce = 0.004f;  // share of the brightest spot: what comes back of less is below one code of 255
constexpr int kMinRays = 256;

// What so many rays saw, of object and receiver each, is kept from one bounce to the next: up to 1 GB, where all of them meet
// something, and a quarter as a rule.
constexpr std::size_t kMaxKeptRays = std::size_t{1} << 26;

using Basis = std::array<float, kMaxShBands * kMaxShBands>;

std::size_t tasks_of(std::size_t points) {
  return (points + kPointsPerTask - 1) / kPointsPerTask;
}

// (1 / pi) integral of max(n . w, 0) y_i(w) dw.
void unshadowed_lobe(const glm::vec3& normal, int bands, std::span<float> lobe) {
  evaluate_sh(glm::normalize(glm::dvec3(normal)), bands, lobe);
  for (int l = 0; l < bands; ++l) {
    const float scale = static_cast<float>(cosine_lobe_over_pi(l));
    for (int m = -l; m <= l; ++m) lobe[sh_index(l, m)] *= scale;
  }
}

/// What each of some points sees, task by task, and the number of rays that it was found by.
struct KeptLinks {
  std::vector<LightLinks> tasks;
  int rays = 0;  ///< 0: nothing is kept
};

class Baker {
 public:
  Baker(const Mesh& mesh, const ReceiverGrid& grid, const TransferOptions& options, const ProgressHandler& progress)
      : mesh_(mesh),
        grid_(grid),
        options_(options),
        progress_(progress),
        count_(sh_count(options.bands)),
        points_(mesh, grid, options),
        total_(static_cast<double>(points_.vertices() + grid.points()) * (1 + options.bounces)) {
    transfer_.bands = options.bands;
    transfer_.grid = grid;
    transfer_.receiver_unshadowed.resize(count_);
    unshadowed_lobe(glm::vec3(0, 0, 1), options.bands, transfer_.receiver_unshadowed);
  }

  Transfer bake() {
    const InteriorVertices interior(mesh_, bake_object_direct());
    interior.fill(transfer_.object_direct);
    const std::vector<char> covered = bake_receiver_direct();
    transfer_.object = transfer_.object_direct;
    transfer_.receiver = transfer_.receiver_direct;
    bake_bounces(interior, covered);
    if (progress_) progress_(1.0);  // light may have died away before the last bounce
    return std::move(transfer_);
  }

 private:
  std::span<glm::vec3> coefficients(std::vector<glm::vec3>& all, std::size_t i) const {
    return std::span(all).subspan(i * count_, count_);
  }

  // Calls work(begin, end, task) for tasks that together are all points.
  template <typename Work>
  void for_tasks(std::size_t points, const Work& work) {
    const auto tell = [&](double share) { progress_((done_ + share * static_cast<double>(points)) / total_); };
    const auto run = [&](std::size_t task) { work(task * kPointsPerTask, std::min(points, (task + 1) * kPointsPerTask), task); };
    parallel_for(tasks_of(points), options_.threads, run, progress_ ? ProgressHandler(tell) : ProgressHandler());
    done_ += static_cast<double>(points);
  }

  // The first of a point's rays, which do for what is left after the first bounce.
  int first_rays() const { return std::max(options_.rays / 4, std::min(options_.rays, kMinRays)); }
  int rays_of(int bounce) const { return bounce == 0 ? options_.rays : first_rays(); }

  // Whether the links of so many points that this many rays found are kept for a bounce.
  bool keeps_for(int bounce, int rays, std::size_t points) const {
    return bounce < options_.bounces && points * static_cast<std::size_t>(rays) <= kMaxKeptRays;
  }

  // Fills object_direct. Returns which vertices lie within another part.
  std::vector<char> bake_object_direct() {
    const std::size_t vertices = points_.vertices();
    transfer_.object_direct.resize(vertices * count_);
    correction_.resize(vertices);
    std::vector<char> is_interior(vertices);
    to_object_ = {std::vector<LightLinks>(tasks_of(vertices)), keeps_for(0, options_.rays, vertices) ? options_.rays : 0};
    for_tasks(vertices, [&](std::size_t begin, std::size_t end, std::size_t task) {
      PointRays rays(points_.scene(), options_.rays);
      for (std::size_t v = begin; v < end; ++v) {
        if (is_dark(v)) {
          if (to_object_.rays > 0) leave_empty(to_object_.tasks[task]);
          continue;
        }
        points_.send_from_vertex(v, rays);
        is_interior[v] = looks_at_backs(rays.rays());
        bake_direct(v, rays);
        correction_[v] = points_.receiver_correction(rays);
        if (to_object_.rays > 0) points_.link_vertex(rays, first_rays(), to_object_.tasks[task]);
      }
    });
    return is_interior;
  }

  static void leave_empty(LightLinks& links) {
    for (int part = 0; part < 2; ++part) links.end_part();
  }

  bool is_dark(std::size_t v) const { return !points_.is_diffuse(v); }

  // What leaves the vertices of the light that arrives there.
  std::vector<glm::vec3> sent_back(std::vector<glm::vec3> arriving) const {
    for (std::size_t v = 0; v < points_.vertices(); ++v)
      for (glm::vec3& value : coefficients(arriving, v)) value *= points_.albedo()[v];
    return arriving;
  }

  // The transfer is the closed form of the open hemisphere less what the occluded rays would have brought: exact where nothing is
  // in the way, and elsewhere only the blocked part is uncertain.
  void bake_direct(std::size_t v, PointRays& rays) {
    Basis lobe, blocked{};
    unshadowed_lobe(mesh_.vertices[v].normal, options_.bands, std::span(lobe).first(count_));
    rays.add_blocked_light(options_.bands, std::span(blocked).first(count_));
    const std::span<glm::vec3> out = coefficients(transfer_.object_direct, v);
    for (int i = 0; i < count_; ++i) out[i] = glm::vec3(lobe[i] - blocked[i]);
  }

  // Whether no ray escapes and most meet backs of faces, as from within a solid; in a narrow gap or a closed room they meet
  // fronts.
  static bool looks_at_backs(const RayStream& rays) {
    std::size_t backs = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      if (!rays.meets(k)) return false;
      backs += !rays.is_front_facing(k);
    }
    return backs > rays.size() / 2;
  }

  // Fills receiver_direct. Returns which points the object covers: no ray escapes, so no camera sees them, and a good part of
  // them look at back faces (half of them where the point lies on a wall).
  std::vector<char> bake_receiver_direct() {
    transfer_.receiver_direct.resize(grid_.points() * count_);
    std::vector<char> covered(grid_.points());
    to_receiver_ = {std::vector<LightLinks>(tasks_of(grid_.points())),
                    keeps_for(0, options_.rays, grid_.points()) ? options_.rays : 0};
    for_tasks(grid_.points(), [&](std::size_t begin, std::size_t end, std::size_t task) {
      PointRays rays(points_.scene(), options_.rays);
      for (std::size_t p = begin; p < end; ++p) {
        points_.send_from_receiver(p, rays);
        covered[p] = is_covered(rays);
        Basis blocked{};
        rays.add_blocked_light(options_.bands, std::span(blocked).first(count_));
        const std::span<glm::vec3> out = coefficients(transfer_.receiver_direct, p);
        for (int i = 0; i < count_; ++i) out[i] = glm::vec3(transfer_.receiver_unshadowed[i] - blocked[i]);
        if (to_receiver_.rays > 0) points_.link_receiver(rays, first_rays(), to_receiver_.tasks[task]);
      }
    });
    const std::vector<glm::vec3> unshadowed(transfer_.receiver_unshadowed.begin(), transfer_.receiver_unshadowed.end());
    finish_receiver(covered, unshadowed, transfer_.receiver_direct);
    return covered;
  }

  static bool is_covered(const PointRays& point_rays) {
    const RayStream& rays = point_rays.rays();
    float blocked = 0, inside = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      if (!rays.meets(k)) continue;
      blocked += point_rays.weights()[k];
      if (!rays.is_front_facing(k)) inside += point_rays.weights()[k];
    }
    return blocked > 1 - 0.5f / static_cast<float>(rays.size()) && inside > 0.25f;
  }

  void finish_receiver(const std::vector<char>& covered, const std::vector<glm::vec3>& beyond,
                       std::span<glm::vec3> values) const {
    fill_covered(grid_, covered, values);
    fade_rim(grid_, beyond, values);
  }

  // Sends light over one more surface each time, until it stops mattering. What came last is passed on alone, so that fewer rays
  // do for it the less it is.
  void bake_bounces(const InteriorVertices& interior, const std::vector<char>& covered) {
    std::vector<glm::vec3> last = sent_back(transfer_.object_direct), sent_up = sent_up_by(transfer_.receiver_direct);
    const float most = largest(last);
    for (int bounce = 0; bounce < options_.bounces && largest(last) > kMinBounce * most; ++bounce) {
      std::vector<glm::vec3> next(last.size()), on_receiver(transfer_.receiver.size());
      gather_at_vertices(bounce, last, sent_up, next);
      gather_on_receiver(bounce, last, on_receiver);
      interior.fill(next);
      finish_receiver(covered, std::vector(count_, glm::vec3(0)), on_receiver);
      add(next, transfer_.object);
      add(on_receiver, transfer_.receiver);
      sent_up = sent_up_by(on_receiver);
      last = sent_back(std::move(next));
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

  // Calls link(point, rays, links) for points whose links are not kept, then use(point, gather), where gather(object, receiver,
  // out) adds what they send to what arrives there. Keeps the links for the next bounce where they fit.
  template <typename Link, typename Use>
  void for_linked(int bounce, std::size_t points, KeptLinks& kept, const Link& link, const Use& use) {
    const bool is_kept = kept.rays > 0;
    if (!is_kept) kept.rays = rays_of(bounce);
    const bool keeps = keeps_for(bounce + 1, kept.rays, points);
    const std::size_t parts = bounce == 0 ? 2 : 1;
    const float factor = static_cast<float>(kept.rays) / static_cast<float>(rays_of(bounce));
    for_tasks(points, [&](std::size_t begin, std::size_t end, std::size_t task) {
      LightLinks& links = kept.tasks[task];
      if (!is_kept) {
        links = {};
        PointRays rays(points_.scene(), rays_of(bounce));
        for (std::size_t i = begin; i < end; ++i) link(i, rays, links);
      }
      for (std::size_t i = begin; i < end; ++i)
        use(i, [&](const auto& from_object, const auto& from_receiver, std::span<glm::vec3> out) {
          links.gather(i - begin, parts, factor, mesh_.indices, from_object, from_receiver, out);
        });
      if (!keeps) links = {};
    });
    if (!keeps) kept.rays = 0;
  }

  // Gathers what arrives at the vertices of the light that front faces and the receiver sent in their direction.
  void gather_at_vertices(int bounce, const std::vector<glm::vec3>& sent, const std::vector<glm::vec3>& sent_up,
                          std::vector<glm::vec3>& next) {
    const auto link = [&](std::size_t v, PointRays& rays, LightLinks& links) {
      if (is_dark(v)) return leave_empty(links);
      points_.send_from_vertex(v, rays);
      points_.link_vertex(rays, first_rays(), links);
    };
    for_linked(bounce, points_.vertices(), to_object_, link, [&](std::size_t v, const auto& gather) {
      const std::span<glm::vec3> out = coefficients(next, v);
      gather(sent, sent_up, out);
      for (int i = 0; bounce == 0 && i < count_; ++i) out[i] += transfer_.receiver_unshadowed[i] * correction_[v];
    });
  }

  // Gathers what the object sends down to the receiver.
  void gather_on_receiver(int bounce, const std::vector<glm::vec3>& sent, std::vector<glm::vec3>& on_receiver) {
    const auto link = [&](std::size_t p, PointRays& rays, LightLinks& links) {
      points_.send_from_receiver(p, rays);
      points_.link_receiver(rays, first_rays(), links);
    };
    for_linked(bounce, grid_.points(), to_receiver_, link,
               [&](std::size_t p, const auto& gather) { gather(sent, std::vector<glm::vec3>(), coefficients(on_receiver, p)); });
  }

  // The light that each of the receiver's points sends back.
  std::vector<glm::vec3> sent_up_by(const std::vector<glm::vec3>& receiver) const {
    std::vector<glm::vec3> sent_up;
    if (!points_.receiver_sends_back()) return sent_up;
    sent_up.reserve(receiver.size());
    for (std::size_t p = 0; p < grid_.points(); ++p) {
      const glm::vec3 albedo = options_.receiver_albedo.at(grid_.place_m(p));
      for (int i = 0; i < count_; ++i) sent_up.push_back(albedo * receiver[p * count_ + i]);
    }
    return sent_up;
  }

  const Mesh& mesh_;
  const ReceiverGrid& grid_;
  const TransferOptions& options_;
  const ProgressHandler& progress_;
  int count_;
  BakePoints points_;
  Transfer transfer_;
  KeptLinks to_object_, to_receiver_;
  std::vector<glm::vec3> correction_;  // of each vertex: BakePoints::receiver_correction
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
  return Baker(mesh_tag, grid, options, progress).bake();
}

}  // namespace catchlight::render
