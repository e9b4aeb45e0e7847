// SPDX-License-Identifier: Apache-2.0
#pragma once
// fill_gaps: closes narrow gaps in depth images, as depth warped into another camera has them.

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

struct GapFilling {
  int max_gap_px{0};            ///< widest gap that is closed; 0: none
  double max_step_share{0.02};  ///< gaps between depths that differ by a larger share are edges and stay open

  /// Answers invalid_argument for a negative or absurd width, or a share outside 0 to 1.
  [[nodiscard]] Status validate() const;
};

/// Fills pixels without a return (0 or NaN) between two returns of similar depth, at most max_gap_px pixels apart in a
/// row, a column or a diagonal. The new depth is linear in 1/z between the two, as on a plane. The narrowest gap
/// decides, in this order at a tie. Nothing is added beyond the outermost returns. Free claims (d < 0) are kept and end
/// a gap. Expects a valid configuration. O(pixels · max_gap_px).
[[nodiscard]] DepthImage fill_gaps(const DepthImage& depth, const GapFilling& filling);

/// Chooses the filling that a camera's images need, judged by one image. Depth registered to another camera by forward
/// warping comes as a net of returns with gaps of one or two pixels, and is filled (2). Nothing is filled where that
/// would add less than a quarter to the returns.
[[nodiscard]] GapFilling choose_gap_filling(const DepthImage& depth);

}  // namespace saccade
