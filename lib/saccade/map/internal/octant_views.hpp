// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where one camera sees the eight octants of a cube of voxels: the geometry of the conservative tests of fusion.

#include <array>
#include <cstdint>

#include "saccade/map/internal/tsdf_math.hpp"

namespace saccade::fusion {

constexpr int kOctants{8};

/// Octants of a cube of voxels, bit i: octant (i & 1, i >> 1 & 1, i >> 2).
using OctantMask = std::uint8_t;

/// Where the voxel centres of the octants of a cube lie: pixels whose beams may hold them, ranges between which they
/// are. Rounded outwards.
struct OctantViews {
  std::array<std::int32_t, kOctants> u0;  ///< pixels, clamped to the image; 0 where hidden or near
  std::array<std::int32_t, kOctants> v0;
  std::array<std::int32_t, kOctants> u1;
  std::array<std::int32_t, kOctants> v1;
  std::array<float, kOctants> nearest_m;
  std::array<float, kOctants> farthest_m;
  OctantMask hidden;  ///< behind the camera or wholly outside the image
  OctantMask near;    ///< reaching too near to the camera's plane to be projected
  OctantMask inside;  ///< wholly in the image
};

/// @param frame  of the cube's first voxel.
/// @param edge   of the cube in voxels, a power of two ≥ 4.
void view_octants(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, int edge, OctantViews& out);

/// What is known of the octants of a cube without looking at their voxels.
struct KnownOctants {
  OctantMask hidden;          ///< no voxel is seen
  OctantMask free;            ///< every sample is 1
  OctantMask free_or_unseen;  ///< every sample is 1, or there is none; holds for those of `free` as well
  OctantMask inside;          ///< every voxel lies in the image
};
constexpr OctantMask kAllOctants{0xFF};

}  // namespace saccade::fusion
