// SPDX-License-Identifier: Apache-2.0
#pragma once
// UninitializedVector: a std::vector that leaves new elements unset and begins at the start of a cache line.

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace saccade {

template <class T>
struct UnsetAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  static constexpr std::align_val_t kAlignment{64};
  /// Allocates without a check for overflow: vectors never ask for more than the address space holds.
  [[nodiscard]] T* allocate(std::size_t count) {
    static_assert(alignof(T) <= static_cast<std::size_t>(kAlignment));
    return static_cast<T*>(::operator new(count * sizeof(T), kAlignment));
  }
  void deallocate(T* memory, std::size_t /*count*/) noexcept { ::operator delete(memory, kAlignment); }
  template <class U>
  void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
};

/// Vector for large arrays that several threads fill. With std::vector, one thread would first write zeros and fetch
/// all of the memory. Elements have no value until they are written, when their number is given to the constructor or
/// to resize. An element whose size divides 64 bytes lies in one cache line.
template <class T>
using UninitializedVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace saccade
