// SPDX-License-Identifier: Apache-2.0
#pragma once
// Cost, CostClock, gain_difference: what ours and its peers are compared by.

#include <cmath>
#include <cstdint>
#include <ctime>
#include <span>

#include "saccade/core/clock.hpp"
#include "saccade/core/result.hpp"

namespace saccade::bench {

/// Seconds passed, and those that the process' threads computed: on a busy machine only these can be compared.
struct Cost {
  double wall_s{0.0};
  double cpu_s{0.0};
  [[nodiscard]] Cost operator+(const Cost& other) const { return {wall_s + other.wall_s, cpu_s + other.cpu_s}; }
};

/// Runs from its construction on.
class CostClock {
 public:
  [[nodiscard]] Cost elapsed() const {
    return {1e-3 * wall_.elapsed_ms(), static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC};
  }

 private:
  Stopwatch wall_;
  std::clock_t cpu_{std::clock()};
};

/// Returns the share of scoring rays that are counted differently, pose by pose; 1 where nothing scores.
[[nodiscard]] inline double gain_difference(std::span<const std::uint64_t> gains,
                                            std::span<const std::uint64_t> expected) {
  SACCADE_EXPECTS(gains.size() == expected.size());
  double differ{0.0};
  double total{0.0};
  for (std::size_t i = 0; i < gains.size(); ++i) {
    differ += std::fabs(static_cast<double>(gains[i]) - static_cast<double>(expected[i]));
    total += static_cast<double>(expected[i]);
  }
  return total > 0.0 ? differ / total : 1.0;
}

}  // namespace saccade::bench
