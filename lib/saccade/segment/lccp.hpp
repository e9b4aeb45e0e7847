// SPDX-License-Identifier: Apache-2.0
#pragma once
// LccpConfig, LccpResult and segment_by_convexity: LCCP, supervoxels joined where surfaces bend outwards.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/result.hpp"
#include "saccade/segment/supervoxels.hpp"

namespace saccade {

/// Parameters of segment_by_convexity.
struct LccpConfig {
  double concavity_tolerance_rad{10_deg};  ///< a smaller angle between normals counts as convex
  bool sanity{true};                       ///< supervoxels that touch in one point only are kept apart
  bool extended_convexity{false};          ///< a convex edge needs a third supervoxel with convex edges to both
  bool smooth{true};                       ///< supervoxels with a step between them are kept apart
  double smoothness{0.1};                  ///< the step that is allowed, in voxels
  std::size_t min_supervoxels{0};          ///< a segment with fewer joins the largest one that it touches

  /// @return invalid_argument for a number that is not finite or negative.
  [[nodiscard]] Status validate() const;
};

/// Labels count segments from 0, in the order of their first supervoxels.
struct LccpResult {
  std::vector<std::uint32_t> labels;      ///< one per point; kUnlabelled where there is no point
  std::vector<std::uint32_t> segment_of;  ///< per supervoxel
  std::vector<bool> convex;               ///< per edge of the supervoxels: joined
  std::size_t segments{0};
};

/// Whether the edge between two supervoxels that touch joins them (Stein et al., CVPR 2014, section 3), common
/// neighbours aside. The order of the two changes nothing.
[[nodiscard]] bool is_convex(const Supervoxel& a, const Supervoxel& b, const LccpConfig& config, double voxel_size_m);

/// The segments that result from edges being convex or not, `convex` as many as edges. Extended convexity and the least
/// size are heeded here.
/// O(points + edges · degree), one thread, deterministic.
[[nodiscard]] LccpResult join_convex(const SupervoxelResult& supervoxels, std::vector<bool> convex,
                                     const LccpConfig& config);

/// Locally convex connected patches (Stein et al., CVPR 2014): edges between supervoxels are convex or concave by their
/// centroids and normals, and what convex edges connect is a segment.
/// @return invalid_argument for a bad config.
/// O(points + edges · degree); one thread, deterministic.
[[nodiscard]] Result<LccpResult> segment_by_convexity(const SupervoxelResult& supervoxels,
                                                      const LccpConfig& config = {});

}  // namespace saccade
