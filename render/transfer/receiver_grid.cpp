#include "render/transfer/receiver_grid.hpp"

#include <algorithm>
#include <cmath>

#include "render/mesh/bounds.hpp"

namespace catchlight::render {
namespace {

constexpr int kRimCells = 4;      // cells over which the receiver's shadow fades to nothing
constexpr int kCoveredRings = 2;  // rings of covered points that are filled from their neighbours

bool fill_from_neighbours(const ReceiverGrid& grid, const std::vector<char>& covered, int x, int y, std::span<glm::vec3> values) {
  const std::size_t count = values.size() / grid.points();
  std::vector<glm::vec3> sum(count, glm::vec3(0));
  int open = 0;
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, grid.rows - 1); ++ny) {
    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, grid.columns - 1); ++nx) {
      const std::size_t neighbour = static_cast<std::size_t>(ny) * grid.columns + nx;
      if (covered[neighbour]) continue;
      ++open;
      for (std::size_t i = 0; i < count; ++i) sum[i] += values[neighbour * count + i];
    }
  }
  if (open == 0) return false;
  const std::span<glm::vec3> out = values.subspan((static_cast<std::size_t>(y) * grid.columns + x) * count, count);
  for (std::size_t i = 0; i < count; ++i) out[i] = sum[i] / static_cast<float>(open);
  return true;
}

}  // namespace

glm::vec2 ReceiverGrid::place_m(std::size_t point) const {
  const auto place = [](float from, float to, std::size_t i, int count) {
    return count > 1 ? from + (to - from) * static_cast<float>(i) / static_cast<float>(count - 1) : from;
  };
  return {place(min_m.x, max_m.x, point % columns, columns), place(min_m.y, max_m.y, point / columns, rows)};
}

std::optional<std::size_t> ReceiverGrid::nearest(const glm::vec2& place_m) const {
  if (points() == 0 || max_m.x <= min_m.x || max_m.y <= min_m.y) return std::nullopt;
  const glm::vec2 cell = (place_m - min_m) / (max_m - min_m) * glm::vec2(columns - 1, rows - 1) + 0.5f;
  if (!(cell.x >= 0 && cell.y >= 0 && cell.x < static_cast<float>(columns) && cell.y < static_cast<float>(rows)))
    return std::nullopt;
  return static_cast<std::size_t>(cell.y) * columns + static_cast<std::size_t>(cell.x);
}

ReceiverGrid receiver_grid_for(const Mesh& mesh_tag, int points_across) {
  const auto [low, high] = bounds_of(mesh_tag);
  if (points_across < 2 || !(high.z > 0)) return {};
  // Twice the height away the object fills 1 % of the cosine-weighted sky or less.
  const glm::vec2 margin(2 * high.z);
  ReceiverGrid grid{glm::vec2(low) - margin, glm::vec2(high) + margin, 0, 0};
  const glm::vec2 size = grid.max_m - grid.min_m;
  const float cell = std::max(size.x, size.y) / static_cast<float>(points_across - 1);
  grid.columns = static_cast<int>(std::ceil(size.x / cell - 1e-3f)) + 1;
  grid.rows = static_cast<int>(std::ceil(size.y / cell - 1e-3f)) + 1;
  grid.max_m = grid.min_m + cell * glm::vec2(grid.columns - 1, grid.rows - 1);
  return grid;
}

void fill_covered(const ReceiverGrid& grid, std::vector<char> covered, std::span<glm::vec3> values) {
  for (int ring = 0; ring < kCoveredRings; ++ring) {
    const std::vector<char> before = covered;
    for (int y = 0; y < grid.rows; ++y) {
      for (int x = 0; x < grid.columns; ++x) {
        const std::size_t p = static_cast<std::size_t>(y) * grid.columns + x;
        if (before[p]) covered[p] = !fill_from_neighbours(grid, before, x, y, values);
      }
    }
  }
}

void fade_rim(const ReceiverGrid& grid, std::span<const glm::vec3> beyond, std::span<glm::vec3> values) {
  const int cells = std::min({kRimCells, (grid.columns - 1) / 2, (grid.rows - 1) / 2});
  if (cells < 1) return;
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const int from_rim = std::min({x, y, grid.columns - 1 - x, grid.rows - 1 - y});
      if (from_rim >= cells) continue;
      const float t = static_cast<float>(from_rim) / static_cast<float>(cells), kept = t * t * (3 - 2 * t);
      const std::size_t first = (static_cast<std::size_t>(y) * grid.columns + x) * beyond.size();
      for (std::size_t i = 0; i < beyond.size(); ++i) values[first + i] = glm::mix(beyond[i], values[first + i], kept);
    }
  }
}

}  // namespace catchlight::render
