// SPDX-License-Identifier: Apache-2.0
#pragma once
// UnsetVector: a std::vector whose new elements are not set, and which begins where a line of cache does.

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
  /// Vectors ask for no more than there are addresses.
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

/// For large arrays that several threads fill: with std::vector one thread would write zeros first, and fetch all of
/// the memory. Elements of a size given to the constructor or to resize have no value until they are written. An
/// element whose size divides 64 bytes is in one line of cache.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace saccade
