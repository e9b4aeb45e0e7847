// SPDX-License-Identifier: Apache-2.0
#pragma once
// random_depth_row: one row of a depth image as the filters of wrong points have to take it.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace saccade::test {

/// A background, flat or not, with boxes before it, noise, and what is no return.
inline std::vector<float> random_depth_row(std::size_t columns, std::mt19937_64& random) {
  std::uniform_real_distribution<float> share{0.0F, 1.0F};
  const float far_m = 1.5F + 2.5F * share(random);
  const float slope = 0.2F * (share(random) - 0.5F);
  const float noise_m = share(random) < 0.5F ? 0.002F : 0.05F * share(random);
  std::vector<float> row(columns);
  for (std::size_t i = 0; i < columns; ++i)
    row[i] = 1.0F / (1.0F / far_m + slope * static_cast<float>(i) / static_cast<float>(columns));
  for (int box = 0; box < 3; ++box) {
    const float z = 0.6F + 0.8F * share(random);
    const auto begin = static_cast<std::size_t>(share(random) * static_cast<float>(columns));
    const auto end = std::min(columns, begin + 1 + static_cast<std::size_t>(20.0F * share(random)));
    for (std::size_t i = begin; i < end; ++i) row[i] = z;
  }
  for (float& z : row) {
    z += noise_m * (share(random) - 0.5F);
    if (share(random) < 0.01F) z += 0.3F * share(random);
    if (share(random) < 0.01F) z = 0.0F;
    if (share(random) < 0.005F) z = std::numeric_limits<float>::quiet_NaN();
    if (share(random) < 0.005F) z = std::numeric_limits<float>::infinity();
  }
  return row;
}

}  // namespace saccade::test
