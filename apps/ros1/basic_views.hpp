// SPDX-License-Identifier: Apache-2.0
#pragma once
// BasicViews: view poses around a point, and the number of unknown voxels that each would show. Standard types.

#include <atomic>
#include <functional>

#include "kinfu_types.hpp"

namespace saccade::ros1 {

/// Angles from `first` to `last` inclusive, in steps; degrees.
struct AngleSteps {
  double first{0.0}, last{0.0}, step{1.0};
};

struct BasicConfig {
  double voxel_size{0.02}, max_range{1.0}, radius{1.0};
  std::uint32_t columns{30}, rows{30};
  double half_width_deg{30.0}, half_height_deg{30.0};
  AngleSteps latitude{0.0, 60.0, 10.0};  ///< from the zenith
  AngleSteps longitude{0.0, 330.0, 30.0}, roll{0.0, 330.0, 30.0};
  double occupied_weight{0.0}, unknown_weight{1.0};
};

/// Returns poses around a point that look at it, by latitude, longitude and roll, the last fastest.
std::vector<PlainPose> poses_around(const std::array<double, 3>& point, const BasicConfig& config);

struct BasicFilter {
  std::optional<PlainBox> box;
  std::optional<PlainSphere> sphere;
};

/// Points of voxels with their state: > 0 occupied, 0 unknown, < 0 empty. Voxels that are not listed are empty.
using Occupancy = std::vector<std::array<float, 4>>;

struct BasicCounts {
  std::vector<std::uint32_t> unknown, occupied;  ///< per pose: distinct voxels that its rays meet first
};
/// Returns an error text, or an empty one.
std::string count_voxels(const Occupancy& occupancy, const std::vector<PlainPose>& poses, const BasicFilter& filter,
                         const BasicConfig& config, const std::atomic<bool>& cancelled,
                         const std::function<void(std::size_t done)>& progress, BasicCounts& counts);

}  // namespace saccade::ros1
