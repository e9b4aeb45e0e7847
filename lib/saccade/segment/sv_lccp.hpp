// SPDX-License-Identifier: Apache-2.0
#pragma once
// SvLccpConfig, segment_by_sv_lccp: supervoxels by place, normal and colour, joined where surfaces bend outwards and
// colours are alike.

#include "saccade/core/executor.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/supervoxels.hpp"

namespace saccade {

/// Parameters of segment_by_sv_lccp: thesis Table 4.2. What it leaves open is as for LCCP, but for the rounds, which
/// are those of the paper of VCCS: a seed's own colour says less of what is around it than the mean does.
struct SvLccpConfig {
  SvLccpConfig();

  SupervoxelConfig supervoxels;  ///< V_lccp 1 cm, S_lccp 5 cm, weights α_p 0.1, α_n 0.5, α_c 1; 5 rounds
  LccpConfig lccp;
  double max_color_difference{0.1};  ///< T_lccp, between colours in [0, 1]

  /// @return an error of the parts; invalid_argument for a T_lccp that is negative or no number.
  [[nodiscard]] Status validate() const;
};

struct SvLccpResult {
  SupervoxelResult supervoxels;  ///< with the edges that are left
  LccpResult segments;
};

/// Takes away the edges between supervoxels whose colours are farther apart: ‖c₁ − c₂‖ > T_lccp, thesis eq. (4.15).
/// Where the cloud has no colours none is.
void prune_by_color(SupervoxelResult& supervoxels, double max_difference);

/// SV-LCCP with colours (thesis §4.1.2): find_supervoxels, prune_by_color, segment_by_convexity.
/// @return an error of the cloud or the config. O(points). The thread count never changes a bit of the result.
[[nodiscard]] Result<SvLccpResult> segment_by_sv_lccp(const PointCloud& cloud, const SvLccpConfig& config,
                                                      const Executor& executor);

}  // namespace saccade
