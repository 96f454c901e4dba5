#include "render/cache/content_hash.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace catchlight::render {

void ContentHash::add_bytes(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
    add_word(word);
  }
  add_word(size);
}

std::string ContentHash::text() const {
  std::array<char, 33> digits;
  std::snprintf(digits.data(), digits.size(), "%016llx%016llx", static_cast<unsigned long long>(state_[0]),
                static_cast<unsigned long long>(state_[1]));
  return digits.data();
}

}  // namespace catchlight::render
