#include "render/cpu/surface/direct_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <utility>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr auto kKind = "direct-light";
// Raise when what is found or its members change: older files then no longer match.
constexpr std::uint32_t kVersion = 4;

/// Shares of the object's diagonal: how far above a surface its shadow is looked for; how much farther where normals tell that it
/// is rounder than its triangles; how fine shadows are kept.
constexpr float kLiftShare = 0.4f / 512, kRoundShare = 1.5f / 512, kLatticeShare = 1.0f / 384;
/// Within triangles longer than this share of the diagonal, shadows are looked for that miss the corners: so far apart where the
/// light stands still, else at four places.
constexpr float kProbedShare = 1.0f / 64;
constexpr float kMaxProbedSteps = 64;
/// How much coarser shadows are that are found for one frame alone.
constexpr float kCoarser = 3;
constexpr std::uint16_t kMaxLatticeSteps = 96;
constexpr std::size_t kVerticesAtOnce = 256;

std::size_t lattice_nodes(std::size_t steps) {
  return (steps + 1) * (steps + 2) / 2;
}

/// The node `across` steps towards corner 1 and `up` towards corner 2.
std::size_t lattice_index(std::size_t steps, std::size_t across, std::size_t up) {
  return up * (2 * steps + 3 - up) / 2 + across;
}

/// As many low bits as there are samples.
std::array<std::uint64_t, 2> bits_of(std::size_t samples) {
  std::array<std::uint64_t, 2> bits{};
  for (std::size_t i = 0; i < samples; ++i) bits[i / 64] |= std::uint64_t{1} << (i % 64);
  return bits;
}

glm::vec3 unit(const glm::vec3& v) {
  return v / std::max(glm::length(v), 1e-20f);
}

}  // namespace

DirectLight::DirectLight(const Mesh& mesh, const RayScene& rays, const Bounds& object)
    : mesh_(mesh),
      rays_(rays),
      lift_m_(object.empty() ? 0 : kLiftShare * object.rounded_diagonal_m()),
      max_rounding_m_(kRoundShare / kLiftShare * lift_m_),
      fine_step_m_(object.empty() ? 1 : kLatticeShare * object.rounded_diagonal_m()),
      lattice_step_m_(fine_step_m_),
      probed_edge_m_(object.empty() ? 1 : kProbedShare * object.rounded_diagonal_m()) {}

DirectLight::~DirectLight() {
  keep_findings();
}

void DirectLight::archive(CacheStream& file) {
  file(vertices_);
  file(is_vertex_known_);
  file(lattices_);
  file(lattice_nodes_);
}

void DirectLight::keep_findings() {
  if (std::exchange(has_news_, false)) kept_.keep(kKind, kVersion, [this](CacheStream& file) { archive(file); });
}

void DirectLight::set_samples(std::span<const LightSample> samples_tag, bool stands_still, const KeyedCache& kept) {
  keep_findings();
  kept_ = kept;
  lattice_step_m_ = (stands_still ? 1 : kCoarser) * fine_step_m_;
  stands_still_ = stands_still;
  samples_.assign(samples_tag.begin(), samples_tag.end());
  at_vertices_over_pi_.clear();
  if (samples_.empty() || kept_.read(kKind, kVersion, [this](CacheStream& file) { archive(file); })) return;
  lattice_nodes_.clear();
  vertices_.resize(mesh_.vertices.size());
  is_vertex_known_.assign(mesh_.vertices.size(), 0);
  lattices_.assign(mesh_.indices.size() / 3, {});
}

/// `seen` is known; of the samples in `unknown` it is found by rays.
DirectLightNode DirectLight::node_at(const glm::vec3& position_m, const glm::vec3& normal, const Bits& seen,
                                     const Bits& unknown) const {
  thread_local RayStream rays;
  thread_local std::vector<std::size_t> asked;
  asked.clear();
  DirectLightNode node{seen, glm::vec3(0)};
  for (std::size_t word = 0; word < 2; ++word)
    for (std::uint64_t bits = unknown[word]; bits != 0; bits &= bits - 1) {
      const std::size_t sample = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
      if (glm::dot(normal, glm::vec3(samples_[sample].direction)) > 0) asked.push_back(sample);
    }
  rays.resize(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i)
    rays.set(i, position_m + lift_m_ * normal, glm::vec3(samples_[asked[i]].direction), 0,
             std::numeric_limits<float>::infinity());
  if (!asked.empty()) rays_.find_occluded(rays, Coherence::coherent);
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (!(rays.far[i] < 0)) node.seen[asked[i] / 64] |= std::uint64_t{1} << (asked[i] % 64);
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (node.sees(i))
      node.irradiance += std::max(glm::dot(normal, glm::vec3(samples_[i].direction)), 0.0f) * glm::vec3(samples_[i].irradiance);
  if (node.seen == Bits{}) {
    const auto above = rays_.closest_hit(position_m + lift_m_ * normal, normal);
    node.is_inside = above && !above->front_facing;
  }
  return node;
}

void DirectLight::find_vertices(std::span<const std::uint32_t> wanted) {
  const Bits none{}, all = bits_of(samples_.size());
  const std::size_t chunks = (wanted.size() + kVerticesAtOnce - 1) / kVerticesAtOnce;
  parallel_for(chunks, 0, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kVerticesAtOnce; i < std::min((chunk + 1) * kVerticesAtOnce, wanted.size()); ++i) {
      const Vertex& vertex = mesh_.vertices[wanted[i]];
      vertices_[wanted[i]] = node_at(vertex.position_m, unit(vertex.normal), none, all);
    }
  });
}

const std::vector<glm::vec3>& DirectLight::at_vertices_over_pi() {
  if (samples_.empty() || !at_vertices_over_pi_.empty()) return at_vertices_over_pi_;
  std::vector<std::uint32_t> unknown;
  for (std::uint32_t v = 0; v < vertices_.size(); ++v)
    if (!std::exchange(is_vertex_known_[v], 1)) unknown.push_back(v);
  if (!unknown.empty()) {
    has_news_ = false;  // nothing half-done is kept
    find_vertices(unknown);
    has_news_ = true;
  }
  for (const DirectLightNode& node : vertices_) at_vertices_over_pi_.push_back(node.irradiance / glm::pi<float>());
  return at_vertices_over_pi_;
}

float DirectLight::longest_edge_m(std::uint32_t triangle) const {
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(triangle)];
  const auto place = [&](int k) { return mesh_.vertices[corner[k]].position_m; };
  return std::max({glm::distance(place(0), place(1)), glm::distance(place(1), place(2)), glm::distance(place(2), place(0))});
}

DirectLightNode DirectLight::node_in(std::uint32_t triangle, const glm::vec2& weights, const Bits& seen,
                                     const Bits& unknown) const {
  const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(triangle)];
  const Vertex &a = mesh_.vertices[corner[0]], &b = mesh_.vertices[corner[1]], &c = mesh_.vertices[corner[2]];
  const glm::vec3 w(1 - weights.x - weights.y, weights);
  const glm::vec3 position_m = w.x * a.position_m + w.y * b.position_m + w.z * c.position_m;
  // Without it, neighbouring triangles shade a round surface where light grazes it: Hanika 2021, "Hacking the Shadow Terminator".
  glm::vec3 rounding_m(0);
  for (int k = 0; k < 3; ++k) {
    const Vertex& vertex = mesh_.vertices[corner[k]];
    const glm::vec3 normal = unit(vertex.normal);
    rounding_m -= w[k] * std::min(glm::dot(position_m - vertex.position_m, normal), 0.0f) * normal;
  }
  rounding_m *= std::min(1.0f, max_rounding_m_ / std::max(glm::length(rounding_m), 1e-20f));
  return node_at(position_m + rounding_m, unit(w.x * a.normal + w.y * b.normal + w.z * c.normal), seen, unknown);
}

/// What the triangle's corners see, and, if it is large, some places between them.
void DirectLight::look_at(Known& known) const {
  const auto add = [&](const Bits& seen) {
    for (std::size_t word = 0; word < 2; ++word) known.every[word] &= seen[word], known.any[word] |= seen[word];
  };
  known.every = known.any = vertices_[mesh_.indices[3 * static_cast<std::size_t>(known.triangle)]].seen;
  for (std::size_t k = 1; k < 3; ++k) add(vertices_[mesh_.indices[3 * static_cast<std::size_t>(known.triangle) + k]].seen);
  const float edges = std::ceil(longest_edge_m(known.triangle) / probed_edge_m_);
  if (edges <= 1) return;
  const auto probe = [&](const glm::vec2& weights) { add(node_in(known.triangle, weights, {}, bits_of(samples_.size())).seen); };
  if (!stands_still_) {
    for (const glm::vec2& w : {glm::vec2(0.5f, 0), glm::vec2(0, 0.5f), glm::vec2(0.5f, 0.5f), glm::vec2(1.0f / 3)}) probe(w);
    return;
  }
  const int steps = static_cast<int>(std::min(edges + 1, kMaxProbedSteps));
  for (int up = 0; up < steps; ++up)
    for (int across = up == 0 ? 1 : 0; across + up <= steps && across < steps; ++across)
      probe(glm::vec2(across, up) / static_cast<float>(steps));
}

/// Only of the samples that corners and probes do not agree on it is asked which are seen.
void DirectLight::fill_lattice(const Known& known) {
  const Lattice& lattice = lattices_[known.triangle];
  Bits unknown;
  for (std::size_t word = 0; word < 2; ++word) unknown[word] = known.any[word] & ~known.every[word];
  const std::size_t steps = lattice.steps;
  for (std::size_t up = 0; up <= steps; ++up)
    for (std::size_t across = 0; across + up <= steps; ++across)
      lattice_nodes_[lattice.first_node + lattice_index(steps, across, up)] =
          node_in(known.triangle, glm::vec2(across, up) / static_cast<float>(steps), known.every, unknown);
}

void DirectLight::prepare(std::span<const SurfacePoint> points) {
  if (samples_.empty()) return;
  std::vector<Known> triangles;
  std::vector<std::uint32_t> vertices;
  for (const SurfacePoint& point : points) {
    if (std::exchange(lattices_[point.triangle].is_known, true)) continue;
    triangles.push_back({point.triangle});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh_.indices[3 * static_cast<std::size_t>(point.triangle) + k];
      if (!std::exchange(is_vertex_known_[vertex], 1)) vertices.push_back(vertex);
    }
  }
  if (triangles.empty()) return;
  has_news_ = false;  // nothing half-done is kept
  find_vertices(vertices);
  parallel_for(triangles.size(), 0, [&](std::size_t i) { look_at(triangles[i]); });
  std::erase_if(triangles, [](const Known& known) { return known.any == known.every; });
  std::size_t nodes = lattice_nodes_.size();
  for (const Known& known : triangles) {
    Lattice& lattice = lattices_[known.triangle];
    const float steps = std::ceil(longest_edge_m(known.triangle) / lattice_step_m_);
    lattice.steps = static_cast<std::uint16_t>(std::clamp(steps, 1.0f, float{kMaxLatticeSteps}));
    lattice.first_node = static_cast<std::uint32_t>(nodes);
    nodes += lattice_nodes(lattice.steps);
  }
  lattice_nodes_.resize(nodes);
  parallel_for(triangles.size(), 0, [&](std::size_t i) { fill_lattice(triangles[i]); });
  has_news_ = true;
}

DirectLight::Corners DirectLight::corners_at(const SurfacePoint& point) const {
  const Lattice& lattice = lattices_[point.triangle];
  const glm::vec2& w = point.weights;
  if (lattice.steps == 0) {
    const std::uint32_t* corner = &mesh_.indices[3 * static_cast<std::size_t>(point.triangle)];
    return {{&vertices_[corner[0]], &vertices_[corner[1]], &vertices_[corner[2]]}, {1 - w.x - w.y, w.x, w.y}};
  }
  const auto steps = static_cast<std::size_t>(lattice.steps);
  const glm::vec2 place = glm::clamp(w, 0.0f, 1.0f) * static_cast<float>(steps);
  std::size_t across = std::min(static_cast<std::size_t>(place.x), steps - 1);
  const std::size_t up = std::min(static_cast<std::size_t>(place.y), steps - 1);
  if (across + up > steps - 1) across = steps - 1 - up;
  const glm::vec2 f = place - glm::vec2(across, up);
  const DirectLightNode* first = &lattice_nodes_[lattice.first_node];
  const auto node = [&](std::size_t x, std::size_t y) { return first + lattice_index(steps, x, y); };
  if (f.x + f.y <= 1 || across + up + 2 > steps)
    return {{node(across, up), node(across + 1, up), node(across, up + 1)}, {1 - f.x - f.y, f.x, f.y}};
  return {{node(across + 1, up + 1), node(across, up + 1), node(across + 1, up)}, {f.x + f.y - 1, 1 - f.x, 1 - f.y}};
}

void DirectLight::prefetch(const SurfacePoint& point) const {
  if (samples_.empty()) return;
  for (const DirectLightNode* node : corners_at(point).nodes) __builtin_prefetch(node);
}

glm::vec3 DirectLight::irradiance(const SurfacePoint& point, float* shares) const {
  if (samples_.empty()) return glm::vec3(0);
  const auto [nodes, weights] = corners_at(point);
  // What lies inside would put a dark rim along the line where parts go through each other.
  glm::vec3 w = weights;
  for (int k = 0; k < 3; ++k)
    if (nodes[k]->is_inside) w[k] = 0;
  const float sum = w.x + w.y + w.z;
  constexpr float kEnough = 0.1f;
  if (point.is_back || sum < kEnough) {  // what is kept is for the front, and for what is outside
    const Bits all = bits_of(samples_.size());
    const DirectLightNode node =
        point.is_back ? node_at(point.position_m, point.normal, {}, all) : node_in(point.triangle, point.weights, {}, all);
    for (std::size_t i = 0; shares && i < samples_.size(); ++i) shares[i] = node.sees(i) ? 1 : 0;
    return node.irradiance;
  }
  w /= sum;
  for (std::size_t i = 0; shares && i < samples_.size(); ++i)
    shares[i] = (nodes[0]->sees(i) ? w.x : 0) + (nodes[1]->sees(i) ? w.y : 0) + (nodes[2]->sees(i) ? w.z : 0);
  return w.x * nodes[0]->irradiance + w.y * nodes[1]->irradiance + w.z * nodes[2]->irradiance;
}

}  // namespace catchlight::render
