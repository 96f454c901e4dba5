// Which places send light to a point, and how much of it arrives.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace catchlight::render {

/// What each of some points sees of the object and the receiver. The points are added in turn and then numbered from 0. Each has
/// two parts, either of which may be empty: what some of its rays see, which do where little light is left, and what the others
/// do.
class LightLinks {
 public:
  /// A place within a triangle, and the share of what each of its corners sends that arrives.
  struct Surface {
    std::uint32_t triangle;
    std::array<float, 3> share;
  };
  /// A point of the receiver's grid, and the share of what it sends that arrives.
  struct Receiver {
    std::uint32_t grid_point;
    float share;
  };

  void add_surface(const Surface& link) { surface_.push_back(link); }
  void add_receiver(std::size_t grid_point, float share);
  /// What is added from here on belongs to the next part.
  void end_part() { ends_.push_back({surface_.size(), receiver_.size()}); }

  /// Adds `factor` times what arrives at the point by `parts` of its parts. `from_object` and `from_receiver` are what each
  /// vertex and each of the grid's points send: as many values each as `arriving` has. `corners` are the mesh's indices.
  void gather(std::size_t point, std::size_t parts, float factor, std::span<const std::uint32_t> corners,
              std::span<const glm::vec3> from_object, std::span<const glm::vec3> from_receiver,
              std::span<glm::vec3> arriving) const;

 private:
  struct End {
    std::size_t surface, receiver;
  };
  std::vector<Surface> surface_;
  std::vector<Receiver> receiver_;
  std::vector<End> ends_;  ///< of parts
};

}  // namespace catchlight::render
