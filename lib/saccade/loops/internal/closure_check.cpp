// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/internal/closure_check.hpp"

#include <array>
#include <limits>

namespace saccade::internal::loops {

std::optional<Pose> verified_closure(const PointImage& old_surface, const PointImage& measured,
                                     const PinholeCamera& camera, const Pose& T_old_new_tracked,
                                     const LoopConfig& config, const Executor& executor) {
  IcpConfig icp;
  icp.iterations = {20, 10, 6};
  icp.min_agreement = config.min_agreement;
  icp.min_inlier_share = config.min_inlier_share;
  icp.max_rmse_m = config.max_rmse_m;
  icp.min_constraint = config.min_constraint;
  icp.max_translation_m = 0.5;
  icp.max_rotation_rad = 0.5;
  std::optional<IcpResult> best;
  for (const Pose& T_start : std::array<Pose, 2>{T_old_new_tracked, Pose::Identity()}) {
    IcpResult found = align(measured, old_surface, camera, T_start, executor, icp);
    if (found.converged && (!best || found.agreement > best->agreement)) best = std::move(found);
  }
  if (!best) return std::nullopt;
  return best->T_model_camera;
}

std::vector<double> ways_from(std::size_t node, std::size_t nodes, const std::vector<PoseEdge>& edges) {
  std::vector<double> ways(nodes, std::numeric_limits<double>::infinity());
  ways[node] = 0.0;
  for (bool shorter = true; shorter;) {
    shorter = false;
    // Odometry joins neighbours: a pass in either direction settles all between two closures.
    const auto relax = [&](const PoseEdge& edge) {
      const double length = edge.closure ? 0.0 : DriftModel::travel_m(edge.T_from_to);
      if (ways[edge.from] + length < ways[edge.to]) {
        ways[edge.to] = ways[edge.from] + length;
        shorter = true;
      }
      if (ways[edge.to] + length < ways[edge.from]) {
        ways[edge.from] = ways[edge.to] + length;
        shorter = true;
      }
    };
    for (const PoseEdge& edge : edges) relax(edge);
    for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) relax(*edge);
  }
  return ways;
}

}  // namespace saccade::internal::loops
