#include "render/cpu/receiver/receiver_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catchlight/util/parallel.hpp"
#include "render/camera/clip_from_camera.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {
namespace {

/// Pixels along a cell. It is interpolated where the shadow goes on evenly: the second differences at its corners are eight times
/// what that may miss.
constexpr int kCell = 4;
static_assert(kCell <= PixelRays::kBeyond, "the outermost corners may lie beyond the frame");
constexpr float kBend = 0.016f;

/// Cells that hold so many pixels.
int whole_cells(int pixels) {
  return (pixels + kCell - 1) / kCell;
}

}  // namespace

/// The shadow that the camera sees.
class ReceiverImage::Seen {
 public:
  Seen(const FrameView& view, const PixelRays& pixel_rays, const ReceiverShadow& shadow)
      : pixel_rays_(pixel_rays),
        shadow_(shadow),
        eye_m_(inverse(view.camera_from_tag).translation_m),
        tag_from_camera_(glm::transpose(view.camera_from_tag.rotation)) {}

  /// The place on the plane that a pixel sees. NaN where it sees none, which has no shadow.
  glm::vec2 place_m(int x, int y) const {
    const glm::vec3 direction = tag_from_camera_ * glm::vec3(pixel_rays_.at(x, y), 1.0f);
    const float depth_m = -eye_m_.z / direction.z;
    if (!(depth_m > static_cast<float>(kNear_m))) return glm::vec2(std::numeric_limits<float>::quiet_NaN());
    return glm::vec2(eye_m_) + depth_m * glm::vec2(direction);
  }

  glm::vec3 at(int x, int y) const { return shadow_.ratio(place_m(x, y)); }

 private:
  const PixelRays& pixel_rays_;
  const ReceiverShadow& shadow_;
  glm::vec3 eye_m_;
  glm::mat3 tag_from_camera_;
};

void ReceiverImage::Span::add(const Span& other) {
  if (other.empty()) return;
  *this = empty() ? other : Span{std::min(begin, other.begin), std::max(end, other.end)};
}

void ReceiverImage::clear() {
  rect_ = {};
  rows_ = 0;
  sharp_.clear();
}

PixelRect ReceiverImage::cell(int column, int row) const {
  return intersect({column * kCell, row * kCell, kCell, kCell}, {0, 0, rect_.width, rect_.height});
}

/// Whether the shadow turns at a corner, across or down. Beyond the rectangle it goes on as it is at its rim, where it may begin.
bool ReceiverImage::is_bent(int column, int row) const {
  const std::size_t middle = corner(column, row);
  const auto turns = [&](std::size_t before, std::size_t after) {
    return std::ranges::any_of(
        corners_, [&](const std::vector<float>& c) { return std::abs(c[before] - 2 * c[middle] + c[after]) > kBend; });
  };
  const auto at = [&](int x, int y) { return corner(std::clamp(x, 0, columns_), std::clamp(y, 0, rows_)); };
  return turns(at(column - 1, row), at(column + 1, row)) || turns(at(column, row - 1), at(column, row + 1));
}

bool ReceiverImage::is_smooth(int column, int row) const {
  const std::size_t above = corner(column, row), below = corner(column, row + 1);
  return (is_bent_[above] | is_bent_[above + 1] | is_bent_[below] | is_bent_[below + 1]) == 0;
}

/// The cells that any corner of is in shadow, and those that a blur may darken.
void ReceiverImage::find_shadowed() {
  shadowed_cells_ = blurred_;
  parallel_for(shadowed_cells_.size(), 0, [&](std::size_t row) {
    Span& span = shadowed_cells_[row];
    const auto is_shadowed = [&](std::size_t corner) {
      return corners_[0][corner] != 1 || corners_[1][corner] != 1 || corners_[2][corner] != 1;
    };
    for (std::size_t end : {row, row + 1})
      for (int column = 0; column <= columns_; ++column)
        if (is_shadowed(corner(column, static_cast<int>(end))))
          span.add({std::max(column - 1, 0), std::min(column + 1, columns_)});
  });
}

PixelRect ReceiverImage::shadowed() const {
  PixelRect box;
  for (int row = 0; row < rows_; ++row) {
    const Span& span = shadowed_cells_[static_cast<std::size_t>(row)];
    if (!span.empty()) box = unite(box, unite(cell(span.begin, row), cell(span.end - 1, row)));
  }
  return {box.x + rect_.x, box.y + rect_.y, box.width, box.height};
}

void ReceiverImage::find_sharp() {
  is_bent_.resize(corners_[0].size());
  parallel_for(static_cast<std::size_t>(rows_) + 1, 0, [&](std::size_t row) {
    for (int column = 0; column <= columns_; ++column)
      is_bent_[corner(column, static_cast<int>(row))] = is_bent(column, static_cast<int>(row)) ? 1 : 0;
  });
  sharp_cells_.assign(static_cast<std::size_t>(rows_), {});
  parallel_for(sharp_cells_.size(), 0, [&](std::size_t row) {
    for (int column = 0; column < columns_; ++column)
      if (!is_smooth(column, static_cast<int>(row))) sharp_cells_[row].add({column, column + 1});
  });
  sharp_.clear();
  for (int row = 0; row < rows_; ++row) {
    const Span& span = sharp_cells_[static_cast<std::size_t>(row)];
    if (!span.empty()) sharp_.push_back(unite(cell(span.begin, row), cell(span.end - 1, row)));
  }
}

std::vector<ReceiverImage::Span> ReceiverImage::around_sharp(int margin) const {
  std::vector<Span> around(sharp_cells_.size());
  for (int row = 0; row < rows_; ++row) {
    const Span& sharp = sharp_cells_[static_cast<std::size_t>(row)];
    if (sharp.empty()) continue;
    const Span wide{std::max(sharp.begin - margin, 0), std::min(sharp.end + margin, columns_)};
    for (int near = std::max(row - margin, 0); near <= std::min(row + margin, rows_ - 1); ++near)
      around[static_cast<std::size_t>(near)].add(wide);
  }
  return around;
}

void ReceiverImage::draw_cell(const Seen& seen, int column, int row) {
  const PixelRect pixels = cell(column, row);
  std::array<std::array<float, kCell>, 3> line;
  const bool smooth = is_smooth(column, row);
  for (int y = pixels.y; y < pixels.y + pixels.height; ++y) {
    if (smooth) interpolate(pixels.x, y, pixels.width, {line[0].data(), line[1].data(), line[2].data()});
    for (int x = 0; x < pixels.width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      store(smooth ? Float4{line[0][i], line[1][i], line[2][i], 1} : float4(seen.at(rect_.x + pixels.x + x, rect_.y + y), 1),
            pixels_.pixel(pixels.x + x, y));
    }
  }
}

void ReceiverImage::draw(const FrameView& view, const FramePlan& plan, const PixelRays& pixel_rays,
                         const ReceiverShadow& shadow) {
  clear();
  if (!plan.draws_receiver) return;
  const Bounds reach{glm::vec3(shadow.reach().min_m, 0), glm::vec3(shadow.reach().max_m, 0)};
  const PixelRect seen_reach = visible_rect(view.camera, plan.distortion_limit, view.camera_from_tag, reach, kNear_m);
  const int reach_px = plan.blur.reach_px(seen_reach);
  rect_ = intersect(grown(seen_reach, whole_cells(reach_px) * kCell), plan.virtual_rect);
  if (rect_.empty()) return clear();
  columns_ = whole_cells(rect_.width), rows_ = whole_cells(rect_.height);
  for (std::vector<float>& plane : corners_) plane.resize(static_cast<std::size_t>(rows_ + 1) * (columns_ + 1));
  const Seen seen(view, pixel_rays, shadow);
  parallel_for(static_cast<std::size_t>(rows_) + 1, 0, [&](std::size_t row) {
    // The texels lie far apart: all are fetched before the first is waited for.
    thread_local std::vector<glm::vec2> places_m;
    places_m.clear();
    for (int column = 0; column <= columns_; ++column) {
      places_m.push_back(seen.place_m(rect_.x + column * kCell, rect_.y + static_cast<int>(row) * kCell));
      shadow.prefetch(places_m.back());
    }
    for (std::size_t column = 0; column < places_m.size(); ++column) {
      const glm::vec3 ratio = shadow.ratio(places_m[column]);
      for (std::size_t c = 0; c < 3; ++c) corners_[c][row * places_m.size() + column] = ratio[static_cast<int>(c)];
    }
  });
  find_sharp();
  blurred_ = around_sharp(whole_cells(reach_px));
  const std::vector<Span> drawn = around_sharp(2 * whole_cells(reach_px));  // what the blurred pixels are made of
  find_shadowed();
  pixels_.width = rect_.width, pixels_.height = rect_.height, pixels_.channels = 4;
  pixels_.data.resize(static_cast<std::size_t>(rect_.width) * rect_.height * 4);
  parallel_for(drawn.size(), 0, [&](std::size_t row) {
    for (int column = drawn[row].begin; column < drawn[row].end; ++column) draw_cell(seen, column, static_cast<int>(row));
  });
}

/// From the cells' corners; (x, y) and what follows lie in `rect`.
void ReceiverImage::interpolate(int x, int y, int count, const std::array<float*, 3>& ratio) const {
  if (count == 0) return;
  const float down = static_cast<float>(y % kCell) / kCell;
  const std::size_t above = corner(x / kCell, y / kCell), below = above + static_cast<std::size_t>(columns_ + 1);
  const auto at_row = [&](const std::vector<float>& c, std::size_t i) {
    return c[above + i] + (c[below + i] - c[above + i]) * down;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    float* to = ratio[c];
    float left = at_row(corners_[c], 0);
    int across = x % kCell;
    for (int cell = 0, i = 0; i < count; ++cell, across = 0) {
      const float right = at_row(corners_[c], static_cast<std::size_t>(cell) + 1), step = (right - left) * (1.0f / kCell);
      if (across == 0 && i + kCell <= count) {
        store(splat(left) + Float4{0, 1, 2, 3} * splat(step), to + i);
        i += kCell;
      } else {
        for (; across < kCell && i < count; ++across, ++i) to[i] = left + static_cast<float>(across) * step;
      }
      left = right;
    }
  }
}

bool ReceiverImage::read_row(int x, int y, int count, const std::array<float*, 3>& ratio) const {
  const int row = y - rect_.y, left = x - rect_.x, right = left + count;
  const bool is_inside = row >= 0 && row < rect_.height;
  const auto within = [&](const std::vector<Span>& cells) {
    const Span span = is_inside ? cells[static_cast<std::size_t>(row / kCell)] : Span{};
    const int begin = std::clamp(kCell * span.begin, left, right), last = std::min(kCell * span.end, rect_.width);
    return Span{begin, std::clamp(last, begin, right)};
  };
  const auto from = [&](int column) {
    const std::ptrdiff_t i = column - left;
    return std::array{ratio[0] + i, ratio[1] + i, ratio[2] + i};
  };
  const Span shadowed = within(shadowed_cells_), blurred = within(blurred_);
  const auto fill = [&](int begin, int end) {
    for (float* plane : from(begin)) std::fill_n(plane, end - begin, 1.0f);
  };
  if (shadowed.begin == shadowed.end) {
    fill(left, right);
    return false;
  }
  fill(left, shadowed.begin);
  if (blurred.begin == blurred.end) {
    interpolate(shadowed.begin, row, shadowed.end - shadowed.begin, from(shadowed.begin));
  } else {
    interpolate(shadowed.begin, row, blurred.begin - shadowed.begin, from(shadowed.begin));
    const std::array<float*, 3> to = from(blurred.begin);
    for (int i = 0; i < blurred.end - blurred.begin; ++i)
      for (std::size_t c = 0; c < 3; ++c) to[c][i] = pixels_.pixel(blurred.begin + i, row)[c];
    interpolate(blurred.end, row, shadowed.end - blurred.end, from(blurred.end));
  }
  fill(shadowed.end, right);
  return true;
}

}  // namespace catchlight::render
