// The edges along which an object's picture may change within a pixel: its outline, and where surfaces meet at an angle.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

class MeshOutline {
 public:
  /// Finds the edges. Triangles share one where their corners' positions are the same, whatever the vertices' numbers.
  explicit MeshOutline(const Mesh& mesh);

  /// Calls `draw` with the ends of each edge that may be seen from `eye_m` as an outline (one of its triangles faces the eye, the
  /// other does not, or there is no other) or as a crease (normals or materials differ across it, and one faces the eye).
  void for_each_seen(const glm::vec3& eye_m, const std::function<void(const glm::vec3&, const glm::vec3&)>& draw);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Edge {
    std::uint32_t from, to;             ///< vertices
    std::uint32_t triangle, neighbour;  ///< kNone: there is no other
    bool is_crease;
  };

  const Mesh& mesh_;
  std::vector<glm::vec4> planes_;  ///< of the triangles: normal, and its product with a corner
  std::vector<Edge> edges_;
  std::vector<char> faces_eye_;
};

/// Calls `mark` once or more for every pixel (centres are integers) that the segment crosses within [0, width) x [0, height).
void for_each_crossed_pixel(const glm::dvec2& from_px, const glm::dvec2& to_px, int width, int height,
                            const std::function<void(int, int)>& mark);

}  // namespace catchlight::render
