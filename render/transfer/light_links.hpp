// Which places send light to a point, and how much of it arrives.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace catchlight::render {

/// What each of some points sees of the object and the receiver. The points are added in turn and then numbered from 0.
class LightLinks {
 public:
  /// A place within a triangle, and the share of what each of its corners sends that arrives.
  struct Surface {
    std::uint32_t triangle;
    std::array<float, 3> share;
  };

  void add_surface(const Surface& link) { surface_.push_back(link); }
  void add_receiver(std::size_t grid_point, float share) { receiver_.push_back({static_cast<std::uint32_t>(grid_point), share}); }
  /// What is added from here on belongs to the next point.
  void end_point() { ends_.push_back({surface_.size(), receiver_.size()}); }

  /// Adds what arrives at the point. `from_object` and `from_receiver` are what each vertex and each of the grid's points send:
  /// as many values each as `arriving` has. `corners` are the mesh's indices.
  void gather(std::size_t point, std::span<const std::uint32_t> corners, std::span<const glm::vec3> from_object,
              std::span<const glm::vec3> from_receiver, std::span<glm::vec3> arriving) const;

 private:
  struct Receiver {
    std::uint32_t grid_point;
    float share;
  };
  struct End {
    std::size_t surface, receiver;
  };
  std::vector<Surface> surface_;
  std::vector<Receiver> receiver_;
  std::vector<End> ends_;
};

}  // namespace catchlight::render
