// SPDX-License-Identifier: Apache-2.0
#pragma once
// firm_best: the exact best of many items, found without evaluating all.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace saccade {

/// Replaces bounds by values until the best `count` items are certain. `looked` is the number of evaluated items, which
/// then come first; `firm` the number of those before the first that another might beat.
struct FirmBest {
  std::size_t looked{0};
  std::size_t firm{0};
};

/// @param items  by decreasing bound; afterwards evaluated items come first, by decreasing value
/// @param beyond bound of missing items; −∞: none is missing
/// @param value_of(item) its bound, or its value after look(span of items), which may lower it
/// Items are evaluated in batches of 16 for every thread count, so threads never change the result.
template <class Item, class ValueOf, class Look>
FirmBest firm_best(std::vector<Item>& items, double beyond, std::size_t count, const ValueOf& value_of,
                   const Look& look) {
  constexpr std::size_t kBatch{16};
  FirmBest best;
  const auto by_value = [&](const Item& a, const Item& b) { return value_of(a) > value_of(b); };
  while (best.looked < items.size() && best.firm < count) {
    const std::size_t end = std::min(best.looked + kBatch, items.size());
    const std::size_t looked_before = best.looked;
    look(best.looked, end);
    best.looked = end;
    const auto looked_end = items.begin() + static_cast<std::ptrdiff_t>(best.looked);
    const auto batch = items.begin() + static_cast<std::ptrdiff_t>(looked_before);
    std::stable_sort(batch, looked_end, by_value);
    std::inplace_merge(items.begin(), batch, looked_end, by_value);
    const double to_come = std::max(
        beyond, best.looked < items.size() ? value_of(items[best.looked]) : -std::numeric_limits<double>::infinity());
    best.firm = static_cast<std::size_t>(
        std::find_if(items.begin(), looked_end, [&](const Item& item) { return !(value_of(item) >= to_come); }) -
        items.begin());
  }
  return best;
}

}  // namespace saccade
