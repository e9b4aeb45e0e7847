// SPDX-License-Identifier: Apache-2.0
#pragma once
// SeededRandom: uniform and normal numbers that a seed decides, the same on every platform.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace saccade {

/// std::mt19937_64 is the same everywhere; the distributions of the standard library are not.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : engine_{seed} {}

  /// Within [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }

  /// Mean 0, standard deviation 1, by the method of Box and Muller.
  [[nodiscard]] double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    const double angle_rad = 2.0 * std::numbers::pi * unit();
    spare_ = radius * std::sin(angle_rad);
    has_spare_ = true;
    return radius * std::cos(angle_rad);
  }

 private:
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  std::mt19937_64 engine_;
  double spare_{0.0};
  bool has_spare_{false};
};

}  // namespace saccade
