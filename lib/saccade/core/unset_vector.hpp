// SPDX-License-Identifier: Apache-2.0
#pragma once
// UnsetVector: a std::vector whose new elements are not set.

#include <memory>
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
/// the memory. Elements of a size given to the constructor or to resize have no value until they are written.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace saccade
