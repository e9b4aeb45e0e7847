// SPDX-License-Identifier: Apache-2.0
#pragma once
// SeededRandom: the only source of random numbers. Equal seeds give equal numbers on every platform.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <random>
#include <utility>

namespace saccade {

/// Random numbers from std::mt19937_64, which is equal everywhere; the distributions of the standard library are not.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : engine_{seed} {}

  /// Returns a number within [0, 1).
  [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  /// Returns a number within [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }

  /// Returns a whole number below `end`, which must be positive.
  [[nodiscard]] std::size_t below(std::size_t end) { return static_cast<std::size_t>(engine_() % end); }

  /// Puts the values in random order (Fisher and Yates).
  template <class Range>
  void shuffle(Range& values) {
    for (std::size_t i = std::size(values); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }

  /// Returns a normally distributed number with mean 0 and standard deviation 1, by the method of Box and Muller.
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
  std::mt19937_64 engine_;
  double spare_{0.0};
  bool has_spare_{false};
};

}  // namespace saccade
