// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/lccp.hpp"

#include <utility>

namespace saccade {

SvLccpConfig::SvLccpConfig() {
  supervoxels.voxels.voxel_size_m = 0.01;
  supervoxels.seed_spacing_m = 0.05;
  supervoxels.spatial_weight = 0.1;
  supervoxels.normal_weight = 0.5;
  supervoxels.color_weight = 1.0;
  supervoxels.rounds = 5;
}

SvLccpConfig SvLccpConfig::as_printed() {
  SvLccpConfig config;
  config.supervoxels.rounds = 1;
  config.supervoxels.seeds_settle = false;
  config.supervoxels.min_seed_share = 0.05;
  config.supervoxels.reach = 1.6;  // ⌊1.8 · 5⌋ − 1 steps
  config.supervoxels.moves_in_growth = true;
  config.supervoxels.opposite_is_alike = true;
  config.lccp.sanity = false;
  config.lccp.smooth = false;
  return config;
}

Status SvLccpConfig::validate() const {
  SACCADE_CHECK(supervoxels.validate());
  SACCADE_CHECK(lccp.validate());
  if (max_color_difference >= 0.0) return {};
  return Error{Errc::invalid_argument, "the largest difference of colours is negative or not a number", "SV-LCCP"};
}

void prune_by_color(SupervoxelResult& supervoxels, double max_difference) {
  std::erase_if(supervoxels.edges, [&](const auto& edge) {
    const Eigen::Vector3f& a = supervoxels.supervoxels[edge.first].color;
    const Eigen::Vector3f& b = supervoxels.supervoxels[edge.second].color;
    return (a.cast<double>() - b.cast<double>()).norm() > max_difference;
  });
}

Result<SvLccpResult> segment_by_sv_lccp(const PointCloud& cloud, const SvLccpConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SvLccpResult result;
  SACCADE_TRY(result.supervoxels, find_supervoxels(cloud, config.supervoxels, executor));
  prune_by_color(result.supervoxels, config.max_color_difference);
  SACCADE_TRY(result.segments, segment_by_convexity(result.supervoxels, config.lccp));
  return result;
}

}  // namespace saccade
