// SPDX-License-Identifier: Apache-2.0
#pragma once
// kMaxLength_m: the limit of lengths and coordinates of scenes, cells and robots.

namespace saccade {

/// Limit of the coordinates and lengths of scenes, cells and robots, metres. Larger numbers are mistakes, such as
/// millimetres or memory that was never set; single precision is coarser than a tenth of a millimetre beyond it.
inline constexpr double kMaxLength_m{1000.0};

}  // namespace saccade
