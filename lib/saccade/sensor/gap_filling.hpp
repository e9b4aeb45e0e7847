// SPDX-License-Identifier: Apache-2.0
#pragma once
// fill_gaps: closes narrow gaps in depth images, as depth warped into another camera has them.

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

struct GapFilling {
  int max_gap_px{0};            ///< widest gap that is closed; 0: none
  double max_step_share{0.02};  ///< a gap between depths that differ by a larger share of them is an edge: left open

  /// invalid_argument for a negative or absurd width, or a share that is not within 0 and 1.
  [[nodiscard]] Status validate() const;
};

/// A pixel without a return (0 or NaN) between two returns of similar depth, at most max_gap_px pixels apart in its
/// row, its column or a diagonal, gets the depth between them, linear in 1/z as on a plane. The narrowest gap decides,
/// in this order at a tie. Nothing is added beyond the outermost returns; free claims (d < 0) are kept and end a gap.
/// Expects a valid configuration. O(pixels · max_gap_px).
[[nodiscard]] DepthImage fill_gaps(const DepthImage& depth, const GapFilling& filling);

/// What a camera's images need, judged by one of them: depth registered to another camera by forward warping comes as a
/// net of returns with gaps of one or two pixels, and is filled (2); where that would add less than a quarter to the
/// returns, nothing is filled.
[[nodiscard]] GapFilling choose_gap_filling(const DepthImage& depth);

}  // namespace saccade
