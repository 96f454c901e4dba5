#include <array>
#include <unordered_map>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {
namespace {

/// The half of a mesh that lies above z = 0.
class UpperHalf {
 public:
  explicit UpperHalf(const Mesh& whole) : whole_(whole) {
    half_.materials = whole.materials;
    half_.textures = whole.textures;
  }

  Mesh run() {
    for (std::size_t t = 0; t < whole_.triangle_material.size(); ++t) add_triangle(t);
    return std::move(half_);
  }

 private:
  float height_m(std::uint32_t vertex) const { return whole_.vertices[vertex].position_m.z; }

  void add_triangle(std::size_t triangle) {
    std::array<std::uint32_t, 4> corners{};
    std::size_t count = 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t here = whole_.indices[3 * triangle + k], next = whole_.indices[3 * triangle + (k + 1) % 3];
      if (height_m(here) >= 0) corners[count++] = kept(here);
      if (height_m(here) < 0 && height_m(next) > 0) corners[count++] = crossing(here, next);
      if (height_m(here) > 0 && height_m(next) < 0) corners[count++] = crossing(next, here);
    }
    for (std::size_t k = 2; k < count; ++k) {
      half_.indices.insert(half_.indices.end(), {corners[0], corners[k - 1], corners[k]});
      half_.triangle_material.push_back(whole_.triangle_material[triangle]);
    }
  }

  std::uint32_t kept(std::uint32_t vertex) {
    const auto [found, is_new] = made_.try_emplace(std::uint64_t{vertex} << 32 | vertex, half_.vertices.size());
    if (is_new) half_.vertices.push_back(whole_.vertices[vertex]);
    if (is_new && whole_.has_textures()) half_.texture_coordinates.push_back(whole_.texture_coordinates[vertex]);
    return found->second;
  }

  // Always from below to above, so that vertices doubled along a seam get the same place.
  std::uint32_t crossing(std::uint32_t below, std::uint32_t above) {
    const auto [found, is_new] = made_.try_emplace(std::uint64_t{below} << 32 | above, half_.vertices.size());
    if (!is_new) return found->second;
    const Vertex &from = whole_.vertices[below], &to = whole_.vertices[above];
    const float share = from.position_m.z / (from.position_m.z - to.position_m.z);
    half_.vertices.push_back(between(from, to, share));
    half_.vertices.back().position_m.z = 0;
    const std::vector<TextureCoordinates>& places = whole_.texture_coordinates;
    if (!places.empty()) half_.texture_coordinates.push_back(between(places[below], places[above], share));
    return found->second;
  }

  const Mesh& whole_;
  Mesh half_;
  std::unordered_map<std::uint64_t, std::uint32_t> made_;  ///< vertices by the two that they lie between, or twice the same
};

}  // namespace

Mesh upper_half(const Mesh& mesh) {
  return UpperHalf(mesh).run();
}

}  // namespace catchlight::render
