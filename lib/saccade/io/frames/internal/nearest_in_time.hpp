// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_in_time: pairs what was taken together.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace saccade {

/// Returns the element nearest in time among `sorted`, the earlier one at a tie; nullptr beyond the tolerance.
template <class T, class Time>
const T* nearest_in_time(const std::vector<T>& sorted, double time_s, double tolerance_s, Time time_of) {
  const auto after = std::lower_bound(sorted.begin(), sorted.end(), time_s,
                                      [&](const T& element, double t) { return time_of(element) < t; });
  const T* best = after != sorted.end() ? &*after : nullptr;
  if (after != sorted.begin()) {
    const T* before = &*std::prev(after);
    if (best == nullptr || time_s - time_of(*before) <= time_of(*best) - time_s) best = before;
  }
  return best != nullptr && std::abs(time_of(*best) - time_s) <= tolerance_s ? best : nullptr;
}

}  // namespace saccade
