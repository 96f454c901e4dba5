// Polygons cut into triangles.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/mesh_file/mesh_import.hpp"

namespace catchlight::render {
namespace {

/// Clipping ears takes up to the third power of the corners.
constexpr std::size_t kMaxClippedCorners = 1000;

/// The polygon as it looks from where it winds counter-clockwise (Newell's normal).
std::vector<glm::dvec2> flattened(const std::vector<glm::dvec3>& position_m) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < position_m.size(); ++i)
    normal += glm::cross(position_m[i] - position_m[0], position_m[(i + 1) % position_m.size()] - position_m[0]);
  const glm::dvec3 size = glm::abs(normal);
  const int across = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
  const int u = (across + 1) % 3, v = (across + 2) % 3;
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& p : position_m) flat.emplace_back(normal[across] < 0 ? -p[u] : p[u], p[v]);
  return flat;
}

/// Twice the signed area: above 0 where a, b, c wind counter-clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether corner `i` of what remains can be cut off.
bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& remaining, std::size_t i) {
  const std::size_t count = remaining.size();
  const glm::dvec2 a = flat[remaining[(i + count - 1) % count]], b = flat[remaining[i]], c = flat[remaining[(i + 1) % count]];
  if (!(turn(a, b, c) > 0)) return false;
  return std::none_of(remaining.begin(), remaining.end(), [&](std::uint32_t other) {
    const glm::dvec2& p = flat[other];
    return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
  });
}

}  // namespace

void triangulate(const std::vector<glm::dvec3>& position_m, std::vector<std::uint32_t>& corners) {
  const std::vector<glm::dvec2> flat = flattened(position_m);
  const std::size_t count = flat.size();
  bool is_convex = true;
  for (std::size_t i = 0; i < count; ++i) is_convex &= turn(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) >= 0;
  std::vector<std::uint32_t> remaining(count);
  std::iota(remaining.begin(), remaining.end(), 0u);
  while (!is_convex && count <= kMaxClippedCorners && remaining.size() > 3) {
    std::size_t ear = 0;
    while (ear < remaining.size() && !is_ear(flat, remaining, ear)) ++ear;
    if (ear == remaining.size()) break;  // crosses itself
    const std::size_t before = (ear + remaining.size() - 1) % remaining.size(), after = (ear + 1) % remaining.size();
    corners.insert(corners.end(), {remaining[before], remaining[ear], remaining[after]});
    remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  for (std::size_t i = 1; i + 1 < remaining.size(); ++i)
    corners.insert(corners.end(), {remaining[0], remaining[i], remaining[i + 1]});
}

}  // namespace catchlight::render
