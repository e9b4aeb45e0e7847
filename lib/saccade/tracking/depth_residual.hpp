// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthResidual: how far the map's surface lies from measured depths, gathered over many images in fixed memory.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Gathers |ray cast − measured| along z. A pixel is valid when its measured depth is a return (> 0, finite); it takes
/// part when the ray cast met a surface there. One thread.
class DepthResidual {
 public:
  /// size_mismatch when the images differ in size; then nothing is added. O(pixels).
  [[nodiscard]] Status add(const DepthImage& measured, const DepthImage& map_cast);

  [[nodiscard]] std::uint64_t valid() const { return valid_; }
  [[nodiscard]] std::uint64_t taking_part() const { return taking_part_; }
  /// Share of the valid pixels that took part; 0 without valid pixels.
  [[nodiscard]] double share() const;
  /// Median of the residuals, to half of kStep_m; residuals beyond kLargest_m count as kLargest_m. 0 without any.
  [[nodiscard]] double median_m() const;

  static constexpr double kStep_m{1e-5};
  static constexpr double kLargest_m{1.0};

 private:
  std::vector<std::uint64_t> histogram_;  ///< by steps of kStep_m
  std::uint64_t valid_{0};
  std::uint64_t taking_part_{0};
};

}  // namespace saccade
