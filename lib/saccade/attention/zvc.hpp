// SPDX-License-Identifier: Apache-2.0
#pragma once
// detect_by_zvc: the adaptive zero-velocity-crossings detector. Finds where a hand acted by its speed near and far.

#include <cstddef>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

/// Defaults that reproduce the thesis' Tables 2.2–2.4.
struct ZvcConfig {
  int half_window{4};       ///< B: the mean filter is 2 B + 1 samples wide; ends are repeated
  double near_m{0.10};      ///< r1
  double far_m{0.25};       ///< r2
  double threshold{1.385};  ///< ZVCTh
  bool drop_at_ends{true};  ///< ignores slow segments whose r1 neighbourhood meets an end of the trajectory

  /// Returns the printed parameters of the thesis: ZVCTh = 1.72, without a rule for ends.
  [[nodiscard]] static ZvcConfig as_printed();
  /// Answers invalid_argument for a value out of range.
  [[nodiscard]] Status validate() const;
};

/// Slow samples first … last.
struct SlowSegment {
  std::size_t first{0};
  std::size_t last{0};
  bool at_end{false};  ///< the r1 neighbourhood of a sample meets an end of the trajectory
};

struct ZvcResult {
  std::vector<HandAction> actions;     ///< points of interest by increasing time; saliency: v̄(r2) / v̄(r1)
  std::vector<SlowSegment> segments;   ///< all, including those dropped at ends
  std::vector<double> near_speed_m_s;  ///< v̄(r1) per sample
  std::vector<double> far_speed_m_s;   ///< v̄(r2) per sample
};

/// Finds actions. Thesis §2.2.4, eq. 2.14, 2.15: a slow segment, v̄(r1) · ZVCTh < v̄(r2), is a point of interest at its
/// middle sample.
/// @return invalid_argument for a bad configuration or a bad sample (see usable_samples). One thread; deterministic.
/// O(samples · samples within r2).
[[nodiscard]] Result<ZvcResult> detect_by_zvc(const HandTrajectory& trajectory, const ZvcConfig& config = {});

}  // namespace saccade
