// SPDX-License-Identifier: Apache-2.0
#pragma once
// half_seen_box: a map, written by hand, of a box on a table whose top and one side were seen.

#include <cmath>

#include "support/written_map.hpp"

namespace saccade::test {

/// The table's top is at z = 0, its inside unknown. The box is 10 cm long in each direction, its side towards +x seen.
inline VoxelState half_seen_box_at(const Eigen::Vector3d& p) {
  const bool inside = std::abs(p.x()) < 0.05 && std::abs(p.y()) < 0.05 && p.z() > 0.0 && p.z() < 0.1;
  if (inside) return p.z() > 0.09 || p.x() > 0.04 ? VoxelState::occupied : VoxelState::unknown;
  if (p.z() > 0.0) return VoxelState::empty;
  return p.z() > -0.02 ? VoxelState::occupied : VoxelState::unknown;
}

inline TsdfSnapshot half_seen_box() { return written_map(half_seen_box_at); }

}  // namespace saccade::test
