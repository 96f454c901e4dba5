#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <unordered_map>

#include "catchlight/error.hpp"
#include "render/mesh/mesh.hpp"

namespace catchlight::render {
namespace {

// A place by its bits: vertices doubled along a hard edge or a material border are one place.
using Place = std::array<std::uint32_t, 3>;

Place place_of(const glm::vec3& position) {
  Place place;
  for (int c = 0; c < 3; ++c) place[c] = std::bit_cast<std::uint32_t>(position[c] + 0.0f);  // -0 and 0 are one place
  return place;
}

// Decides from the end points alone, in an order that does not depend on the triangle: both sides of an edge agree.
bool is_long(const Mesh& mesh, std::uint32_t a, std::uint32_t b, double max_edge_m) {
  glm::vec3 one = mesh.vertices[a].position_m, other = mesh.vertices[b].position_m;
  if (place_of(other) < place_of(one)) std::swap(one, other);
  return glm::distance(glm::dvec3(one), glm::dvec3(other)) > max_edge_m;
}

// The vertex in the middle of the edge a-b, made once for each pair of vertices. Addition commutes, so doubled vertices along a
// seam get middles at the same bits.
class Midpoints {
 public:
  explicit Midpoints(Mesh& mesh) : mesh_(mesh) {}

  std::uint32_t between(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    const auto [found, is_new] = made_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      Vertex middle = render::between(mesh_.vertices[a], mesh_.vertices[b], 0.5f);
      middle.position_m = (mesh_.vertices[a].position_m + mesh_.vertices[b].position_m) * 0.5f;
      mesh_.vertices.push_back(middle);
      std::vector<TextureCoordinates>& places = mesh_.texture_coordinates;
      if (!places.empty()) places.push_back(render::between(places[a], places[b], 0.5f));
    }
    return found->second;
  }

 private:
  Mesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> made_;
};

struct Triangles {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint16_t> material;

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint16_t which) {
    indices.insert(indices.end(), {a, b, c});
    material.push_back(which);
  }
};

// Splits every long edge of triangle `corner` once; what remains is again triangles with the same winding.
void split(Midpoints& midpoints, std::array<std::uint32_t, 3> corner, std::array<bool, 3> is_long_edge, std::uint16_t material,
           Triangles& out) {
  const int count = is_long_edge[0] + is_long_edge[1] + is_long_edge[2];
  // Edge k runs from corner k to corner k + 1. Turn the triangle so that the pattern starts at edge 0.
  const auto turn = [&] {
    std::rotate(corner.begin(), corner.begin() + 1, corner.end());
    std::rotate(is_long_edge.begin(), is_long_edge.begin() + 1, is_long_edge.end());
  };
  if (count == 1) {
    while (!is_long_edge[0]) turn();
    const std::uint32_t middle = midpoints.between(corner[0], corner[1]);
    out.add(corner[0], middle, corner[2], material);
    out.add(middle, corner[1], corner[2], material);
  } else if (count == 2) {
    while (is_long_edge[2]) turn();
    const std::uint32_t first = midpoints.between(corner[0], corner[1]), second = midpoints.between(corner[1], corner[2]);
    out.add(first, corner[1], second, material);
    out.add(corner[0], first, second, material);
    out.add(corner[0], second, corner[2], material);
  } else {
    std::array<std::uint32_t, 3> middle;
    for (int k = 0; k < 3; ++k) middle[k] = midpoints.between(corner[k], corner[(k + 1) % 3]);
    for (int k = 0; k < 3; ++k) out.add(corner[k], middle[k], middle[(k + 2) % 3], material);
    out.add(middle[0], middle[1], middle[2], material);
  }
}

// One round over all triangles; false where nothing was long.
bool split_all(Mesh& mesh, double max_edge_m) {
  Midpoints midpoints(mesh);
  Triangles out;
  bool any = false;
  for (std::size_t i = 0; i < mesh.triangle_material.size(); ++i) {
    const std::array<std::uint32_t, 3> corner{mesh.indices[3 * i], mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]};
    std::array<bool, 3> long_edge;
    for (int k = 0; k < 3; ++k) long_edge[k] = is_long(mesh, corner[k], corner[(k + 1) % 3], max_edge_m);
    if (long_edge[0] || long_edge[1] || long_edge[2]) {
      split(midpoints, corner, long_edge, mesh.triangle_material[i], out);
      any = true;
    } else {
      out.add(corner[0], corner[1], corner[2], mesh.triangle_material[i]);
    }
  }
  mesh.indices = std::move(out.indices);
  mesh.triangle_material = std::move(out.material);
  return any;
}

// Vertices that one round would add.
std::size_t long_edge_count(const Mesh& mesh, double max_edge_m) {
  std::unordered_map<std::uint64_t, bool> edges;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    if (!is_long(mesh, a, b, max_edge_m)) continue;
    count += edges.try_emplace((std::uint64_t{std::min(a, b)} << 32) | std::max(a, b), true).second;
  }
  return count;
}

}  // namespace

Vertex between(const Vertex& a, const Vertex& b, float share) {
  const glm::vec3 normal = glm::mix(a.normal, b.normal, share);
  const bool cancels = glm::length(normal) < 1e-6f;
  return {glm::mix(a.position_m, b.position_m, share), cancels ? (share > 0.5f ? b.normal : a.normal) : glm::normalize(normal),
          glm::mix(a.color, b.color, share)};
}

TextureCoordinates between(const TextureCoordinates& a, const TextureCoordinates& b, float share) {
  TextureCoordinates result;
  for (std::size_t set = 0; set < 2; ++set) result.uv[set] = glm::mix(a.uv[set], b.uv[set], share);
  const glm::vec3 tangent = glm::mix(glm::vec3(a.tangent), glm::vec3(b.tangent), share);
  const bool cancels = glm::length(tangent) < 1e-6f;
  result.tangent = glm::vec4(cancels ? glm::vec3(a.tangent) : glm::normalize(tangent), a.tangent.w);
  return result;
}

Mesh transformed(const Mesh& mesh, const glm::dmat4& tag_from_object) {
  const glm::dmat3 linear(tag_from_object);
  const double scale = std::cbrt(std::abs(glm::determinant(linear))),
               extent = glm::length(linear[0]) + glm::length(linear[1]) + glm::length(linear[2]);
  if (!std::isfinite(extent) || !(scale > 1e-9 * extent)) {
    throw Error(
        "tag_from_object is singular: it flattens the object; expected a rotation, a scale other than 0 and a translation");
  }
  const glm::dmat3 normal_matrix = glm::inverseTranspose(linear);
  Mesh result = mesh;
  for (Vertex& vertex : result.vertices) {
    vertex.position_m = glm::vec3(linear * glm::dvec3(vertex.position_m) + glm::dvec3(tag_from_object[3]));
    vertex.normal = glm::vec3(glm::normalize(normal_matrix * glm::dvec3(vertex.normal)));
  }
  const bool is_mirrored = glm::determinant(linear) < 0;
  for (TextureCoordinates& place : result.texture_coordinates) {
    const glm::dvec3 tangent = linear * glm::dvec3(place.tangent);
    const double length = glm::length(tangent);
    place.tangent =
        glm::vec4(length > 0 ? glm::vec3(tangent / length) : glm::vec3(0), is_mirrored ? -place.tangent.w : place.tangent.w);
  }
  // A mirror image turns faces inside out: wind them the other way.
  if (is_mirrored) {
    for (std::size_t i = 0; i < result.indices.size(); i += 3) std::swap(result.indices[i + 1], result.indices[i + 2]);
  }
  return result;
}

void append(Mesh& mesh, const Mesh& other) {
  const std::size_t base = mesh.vertices.size(), first_material = mesh.materials.size();
  if (first_material + other.materials.size() > 65536) throw Error("the objects have more than 65536 materials together");
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const std::uint32_t index : other.indices) mesh.indices.push_back(static_cast<std::uint32_t>(base + index));
  for (const std::uint16_t material : other.triangle_material) {
    mesh.triangle_material.push_back(static_cast<std::uint16_t>(first_material + material));
  }
  for (Material material : other.materials) {
    for (MaterialTexture* use : material.texture_uses())
      if (use->is_used()) use->texture += static_cast<int>(mesh.textures.size());
    mesh.materials.push_back(std::move(material));
  }
  mesh.textures.insert(mesh.textures.end(), other.textures.begin(), other.textures.end());
  if (!mesh.has_textures() && !other.has_textures()) return;
  mesh.texture_coordinates.resize(base);
  mesh.texture_coordinates.insert(mesh.texture_coordinates.end(), other.texture_coordinates.begin(),
                                  other.texture_coordinates.end());
  mesh.texture_coordinates.resize(mesh.vertices.size());
}

void subdivide_long_edges(Mesh& mesh, double max_edge_m, std::size_t max_vertices) {
  if (!(max_edge_m > 0)) throw Error("longest edge " + std::to_string(max_edge_m) + " m: expected more than 0");
  while (mesh.vertices.size() + long_edge_count(mesh, max_edge_m) <= max_vertices && split_all(mesh, max_edge_m)) {
  }
}

}  // namespace catchlight::render
