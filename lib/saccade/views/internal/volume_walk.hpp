// SPDX-License-Identifier: Apache-2.0
#pragma once
// walk_line: the voxels of a StateVolume along a straight line.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "saccade/views/internal/state_volume.hpp"

namespace saccade {

/// Calls visit(index of the voxel, share of the line at which it is entered) for the line's voxels within the volume's
/// box, in order, until it returns true. Returns true if stopped. O(voxels).
template <class Visit>
bool walk_line(const StateVolume& volume, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, Visit&& visit) {
  const double size_m = volume.voxel_size_m();
  const IndexBox& box = volume.box();
  const std::array<std::int32_t, 3> lo{box.lo.x, box.lo.y, box.lo.z};
  const std::array<std::int32_t, 3> hi{box.hi.x, box.hi.y, box.hi.z};
  const Eigen::Vector3d from = from_m / size_m;
  const Eigen::Vector3d step = (to_m - from_m) / size_m;
  double enter{0.0};
  double leave{1.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (step[i] == 0.0) {
      if (from[i] < lo[axis] || from[i] >= hi[axis]) return false;
      continue;
    }
    const double a = (lo[axis] - from[i]) / step[i];
    const double b = (hi[axis] - from[i]) / step[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return false;
  const std::array<std::ptrdiff_t, 3> stride{1, volume.row(), volume.layer()};
  std::array<double, 3> next;  // share of the line at which the next plane across each axis is passed
  std::array<double, 3> between;
  std::array<std::ptrdiff_t, 3> move;
  std::array<std::int32_t, 3> left;  // voxels to the border
  std::ptrdiff_t index{0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double at = from[i] + enter * step[i];
    const std::int32_t cell = std::clamp(static_cast<std::int32_t>(std::floor(at)), lo[axis], hi[axis] - 1);
    const bool up = step[i] > 0.0;
    index += (cell - lo[axis]) * stride[axis];
    between[axis] = step[i] == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(step[i]);
    next[axis] = step[i] == 0.0 ? between[axis] : ((up ? cell + 1 : cell) - from[i]) / step[i];
    move[axis] = up ? stride[axis] : -stride[axis];
    left[axis] = up ? hi[axis] - 1 - cell : cell - lo[axis];
  }
  for (double t = enter;;) {
    if (visit(static_cast<std::size_t>(index), t)) return true;
    const std::size_t axis =
        next[0] <= next[1] ? (next[0] <= next[2] ? std::size_t{0} : 2) : (next[1] <= next[2] ? std::size_t{1} : 2);
    t = next[axis];
    if (t >= leave || left[axis]-- == 0) return false;
    next[axis] += between[axis];
    index += move[axis];
  }
}

}  // namespace saccade
