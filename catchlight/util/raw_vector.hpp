// Memory that is written before it is read need not be zeroed first.
#pragma once

#include <memory>
#include <new>
#include <vector>

namespace catchlight {

/// Elements made without a value get none: resize() leaves numbers as the memory was.
template <class T>
struct RawAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = RawAllocator<U>;
  };

  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) noexcept {}  // as the standard asks: not explicit

  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
};

/// A vector for pixels of which resize() and RawVector(n) leave the new ones unwritten; all else is std::vector's.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace catchlight
