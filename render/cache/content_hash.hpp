// Hashes of what something is made from.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace catchlight::render {

/// 128 bits out of two FNV-1a hashes over 64-bit words (Fowler, Noll & Vo) with different starts. Guards against accidents, not
/// attacks.
class ContentHash {
 public:
  void add_bytes(const void* data, std::size_t size);

  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T> || std::is_same_v<T, glm::vec3> ||
                  std::is_same_v<T, glm::dvec3> || std::is_same_v<T, glm::dmat3>);
    add_bytes(&value, sizeof value);
  }

  /// Values without gaps between their members.
  template <typename T, typename Allocator>
  void add(const std::vector<T, Allocator>& values) {
    add_bytes(values.data(), values.size() * sizeof(T));
  }

  std::array<std::uint64_t, 2> value() const { return state_; }

  /// 32 hexadecimal digits.
  std::string text() const;

 private:
  void add_word(std::uint64_t word) {
    for (std::uint64_t& state : state_) {
      state = (state ^ word) * 0x100000001b3u;
      state ^= state >> 29;  // multiplication only carries upwards; whole words need their high bits brought down
    }
  }

  std::array<std::uint64_t, 2> state_{0xcbf29ce484222325u, 0x6c62272e07bb0142u};
};

}  // namespace catchlight::render
