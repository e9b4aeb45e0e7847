// SPDX-License-Identifier: Apache-2.0
#pragma once
// DisjointSets: connected components, found by several threads (union-find).

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"

namespace saccade {

/// Disjoint sets of 0, 1, …; each set is named by its smallest member. Any number of threads may join at once: the
/// result depends only on the pairs joined, never on their order.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i) parents_[i] = static_cast<std::uint32_t>(i);
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t i) {
    for (std::uint32_t parent = load(i); parent != i; parent = load(i)) {
      const std::uint32_t above = load(parent);
      at(i).store(above, std::memory_order_relaxed);  // still an ancestor, whatever other threads join
      i = above;
    }
    return i;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t expected{a};
      if (at(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
    }
  }

  /// Numbers the sets by their smallest member. Returns each member's set number and the number of sets.
  [[nodiscard]] std::pair<std::vector<std::uint32_t>, std::uint32_t> numbered() {
    std::vector<std::uint32_t> numbers(parents_.size());
    std::uint32_t next{0};
    for (std::uint32_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t least = root(i);
      numbers[i] = least == i ? next++ : numbers[least];
    }
    return {std::move(numbers), next};
  }

 private:
  [[nodiscard]] std::atomic_ref<std::uint32_t> at(std::uint32_t i) {
    return std::atomic_ref<std::uint32_t>{parents_[i]};
  }
  [[nodiscard]] std::uint32_t load(std::uint32_t i) { return at(i).load(std::memory_order_relaxed); }

  std::vector<std::uint32_t> parents_;
};

}  // namespace saccade
