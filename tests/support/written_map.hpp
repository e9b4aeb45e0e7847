// SPDX-License-Identifier: Apache-2.0
#pragma once
// set_brick: writes a brick of a map by hand.

#include "saccade/map/tsdf_map.hpp"

namespace saccade::test {

/// Puts a brick in its place, in the one representation that its content has.
inline void set_brick(TsdfSnapshot& map, const Index3& brick, BrickRef content) {
  content.canonicalize(map.config.free_weight);
  Sector& sector = map.grid.writable(parent(brick));
  sector.bricks[static_cast<std::size_t>(child_index(brick))] = std::move(content);
  sector.update_summary(child_index(brick), map.config.free_weight);
}

}  // namespace saccade::test
