// SPDX-License-Identifier: Apache-2.0
#pragma once
// unknown_surfels: discs on the frontier between empty and unknown space, as surfels beside those of seen surfaces.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

struct UnknownSurfelConfig {
  /// Surfels of seen surfaces count from this weight w_s on: fewer observations may be no surface.
  double min_weight{1.0};
  /// A voxel is seen if the surfels in it have this area, relative to a face of the voxel. Discs overlap, so that a
  /// surface across a voxel has more than one face.
  double seen_share{0.5};

  /// Answers invalid_argument for a weight or share that is negative or not finite.
  [[nodiscard]] Status validate() const;
};

/// Confidence of unknown surfels; that of seen surfels is 0 in a cloud of both kinds. Monica and Aleotti,
/// "Surfel-based next best view planning", RA-L 2018.
constexpr float kUnknownConfidence{1.0F};

/// Returns a disc for each voxel of the frontier: unknown, without seen surfels in it, and with an empty neighbour or a
/// side of the workspace. Its centre is that of the voxel, moved by half a voxel towards the open sides, which the
/// normal points to; its ball contains the voxel's faces; its weight is kUnknownConfidence. By voxel layers, rows,
/// columns.
/// @param free_space  what is known to be empty; its voxels may be much coarser than surfels
/// @return invalid_argument for a bad config or too large a workspace.
/// O(voxels of the workspace + surfels). The thread count never changes a bit.
[[nodiscard]] Result<std::vector<SurfelDisc>> unknown_surfels(const TsdfSnapshot& free_space, const SurfelMap& surfels,
                                                              const UnknownSurfelConfig& config,
                                                              const Executor& executor);

}  // namespace saccade
