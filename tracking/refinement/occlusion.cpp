#include "tracking/refinement/occlusion.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kFittingWeight = 0.4;  ///< mean weight of a cell's pixels below which it is occluded
constexpr double kMinPixels = 5;        ///< a cell needs so many to tell
constexpr int kMinCells = 3;            ///< smaller faults are for the robust loss
constexpr double kMinShare = 0.45;  ///< share of the pixels that has to stay: another print would match in as much as its border
constexpr std::size_t kMinOfPart = 40;

/// The cells of one part and the ring around them.
class CellMap {
 public:
  CellMap(const CameraModel& camera, const TagPart& part, const RigidTransform& camera_from_target)
      : view_(camera, camera_from_target * part.target_from_tag, part.size_m, part.pattern->cells_across()),
        margin_(part.pattern->margin()),
        side_(part.pattern->cells_across() + 2 * margin_),
        weight_(static_cast<std::size_t>(side_ * side_)),
        count_(weight_.size()) {}

  /// The pixel's place in cells, from the map's own corner; empty where it is on none.
  std::optional<glm::dvec2> place_of(const TagPixel& pixel) const {
    const auto point = view_.at(pixel.place.ideal_px);
    if (!point) return std::nullopt;
    const glm::dvec2 place = point->cell + static_cast<double>(margin_);
    const bool is_on_map = place.x >= 0 && place.y >= 0 && place.x < side_ && place.y < side_;
    return is_on_map ? std::optional(place) : std::nullopt;
  }

  void add(const glm::dvec2& place, double weight) {
    weight_[index(place)] += weight;
    count_[index(place)] += 1;
  }

  int occluded_cells() const {
    int cells = 0;
    for (std::size_t cell = 0; cell < weight_.size(); ++cell) cells += is_occluded(cell);
    return cells;
  }

  /// Whether the place is in an occluded cell, or within half a cell of one.
  bool is_suspect(const glm::dvec2& place) const {
    constexpr double kReach = 0.5;
    for (const glm::dvec2& corner : {glm::dvec2(-kReach, -kReach), {kReach, -kReach}, {kReach, kReach}, {-kReach, kReach}})
      if (is_occluded(index(glm::clamp(place + corner, glm::dvec2(0), glm::dvec2(side_ - 0.001))))) return true;
    return false;
  }

 private:
  std::size_t index(const glm::dvec2& place) const {
    return static_cast<std::size_t>(static_cast<int>(place.y) * side_ + static_cast<int>(place.x));
  }

  bool is_occluded(std::size_t cell) const { return count_[cell] >= kMinPixels && weight_[cell] < kFittingWeight * count_[cell]; }

  TagView view_;
  int margin_, side_;
  std::vector<double> weight_, count_;
};

/// Cells that look like the other ink.
struct Inverted {
  int to_white = 0, to_black = 0;
};

Inverted inverted_cells(const CameraModel& camera, const ResponseTable& response, const TagPart& part, const TagLight& light,
                        const RigidTransform& camera_from_target) {
  constexpr double kMiddle = 0.3, kSame = 0.3;  // how far from a cell's middle, in cells; how far from an ink, in white
  const int cells = part.pattern->cells_across();
  const TagView view(camera, camera_from_target * part.target_from_tag, part.size_m, cells);
  std::vector<double> sums(static_cast<std::size_t>(cells * cells)), counts(sums.size());
  for (const TagPixel& pixel : part.pixels) {
    const auto point = view.at(pixel.place.ideal_px);
    if (!point) continue;
    const glm::dvec2 cell = glm::floor(point->cell), from_middle = glm::abs(point->cell - cell - 0.5);
    if (from_middle.x > kMiddle || from_middle.y > kMiddle) continue;
    if (cell.x < 0 || cell.y < 0 || cell.x >= cells || cell.y >= cells) continue;
    const auto index = static_cast<std::size_t>(static_cast<int>(cell.y) * cells + static_cast<int>(cell.x));
    sums[index] += pixel.code;
    counts[index] += 1;
  }
  const double white_code = response.code(light.black + (1 - kSame) * light.gain).value;
  const double black_code = response.code(light.black + kSame * light.gain).value;
  Inverted result;
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const auto index = static_cast<std::size_t>(row * cells + column);
      if (counts[index] == 0) continue;
      const double seen = sums[index] / counts[index];
      const auto ink = part.pattern->white(column, row);
      result.to_white += ink == 0.0f && seen > white_code;
      result.to_black += ink == 1.0f && seen < black_code;
    }
  return result;
}

}  // namespace

bool shows_another_print(const CameraModel& camera, const ResponseTable& response, const std::vector<TagPart>& parts,
                         const DirectParameters& at) {
  constexpr int kMinCells = 3;  // families differ in five bits at least
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Inverted inverted = inverted_cells(camera, response, parts[i], at.light[i], at.camera_from_target);
    if (std::min(inverted.to_white, inverted.to_black) >= kMinCells) return true;
  }
  return false;
}

std::optional<Unoccluded> leave_out_occluded(const CameraModel& camera, const DirectModel& model, const DirectParameters& at,
                                             const std::vector<Residual>& residuals, const RobustLoss& loss) {
  Unoccluded result;
  std::size_t index = 0, kept = 0;
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    const TagPart& part = model.parts()[i];
    CellMap map(camera, part, at.camera_from_target);
    std::vector<std::optional<glm::dvec2>> places;
    for (const TagPixel& pixel : part.pixels) {
      const Residual& residual = residuals[index++];
      places.push_back(map.place_of(pixel));
      if (residual.known && places.back()) map.add(*places.back(), loss.weight(residual.code));
    }
    const bool is_whole = map.occluded_cells() < kMinCells;
    TagPart left{part.pattern, part.size_m, part.target_from_tag, {}};
    for (std::size_t k = 0; k < part.pixels.size(); ++k)
      if (is_whole || (places[k] && !map.is_suspect(*places[k]))) left.pixels.push_back(part.pixels[k]);
    if (left.pixels.size() < kMinOfPart) continue;
    kept += left.pixels.size();
    result.parts.push_back(std::move(left));
    result.light.push_back(at.light[i]);
  }
  result.kept_share = static_cast<double>(kept) / static_cast<double>(std::max<std::size_t>(index, 1));
  if (kept == index || result.kept_share < kMinShare) return std::nullopt;
  return result;
}

}  // namespace catchlight::tracking
