// SPDX-License-Identifier: Apache-2.0
#pragma once
// Vector kernels of fusion: ranges of image rows, samples of a brick, the running average of a dense brick. They
// perform the operations of tsdf_math.hpp in its order, so every instruction set gives the bits of the scalar
// functions.

#include <array>
#include <cstddef>
#include <cstdint>

#include "saccade/map/brick.hpp"
#include "saccade/map/internal/octant_views.hpp"
#include "saccade/map/internal/tsdf_math.hpp"

namespace saccade::fusion {

/// Alignment of loads and stores in the kernels: one vector of the widest instruction set.
constexpr std::size_t kVectorBytes{64};

/// Observations of a brick's voxels by one frame.
struct BrickSamples {
  alignas(kVectorBytes) std::array<std::int16_t, kBrickVoxels> samples;  ///< tsdf::kNotSeen where unseen
  alignas(kVectorBytes) std::array<std::int32_t, kBrickVoxels> pixels;   ///< index into the image, where a surface is
                                                                         ///< seen
  Mask512 seen;
  Mask512 surface;  ///< seen, and the sample is not 1
};

/// Applies tsdf::pixel_of and tsdf::sample_voxel (eq. 2.1 and the clamp of 2.2) to the 512 voxels. `ranges` is the
/// row-major range image of the camera.
/// @param inside  true when every voxel is known to lie in the image, which then is not tested.
void sample_brick(const tsdf::FusionCamera& camera, const tsdf::BrickFrame& frame, const float* ranges, bool inside,
                  KnownOctants known, BrickSamples& out);

/// Applies tsdf::clearing_sample, average_v and next_w (eq. 2.2 and 2.3) to the voxels in `seen`, and updates both
/// masks. `samples` is aligned to kVectorBytes.
void update_brick(const std::array<std::int16_t, kBrickVoxels>& samples, const Mask512& seen, std::uint16_t max_weight,
                  std::uint16_t free_weight, float clearing_share, DenseBrick& brick);

/// Parts of tsdf::range_of_depth that a whole image shares, and the limits of valid depths.
struct RayLengths {
  const float* dx_squared;  ///< ((u − cx) / fx)² of every column
  int width;
  float min_range_m;
  float max_range_m;
  float truncation_m;
};

/// Bounds of the beams of every column, as BeamBounds of range_image.hpp.
struct ColumnBounds {
  float* clear_m;
  float* reach_m;
  float* nearest_m;
};

/// Turns one row of depths (0, NaN, out of range: none; negative: free up to) into ranges, and widens `bounds` by its
/// beams. Returns the number of returns.
/// @param dy_squared  ((v − cy) / fy)² of the row.
std::size_t ranges_of_row(const RayLengths& rays, float dy_squared, const float* depths_m, float* ranges_m,
                          const ColumnBounds& bounds);

}  // namespace saccade::fusion
