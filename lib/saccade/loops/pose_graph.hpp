// SPDX-License-Identifier: Apache-2.0
#pragma once
// PoseGraph: poses and what was measured between them; solve_pose_graph.

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// A measured relative pose: T_from_to maps coordinates of node `to` into node `from`.
struct PoseEdge {
  std::size_t from{0};
  std::size_t to{0};
  Pose T_from_to{Pose::Identity()};
  double rotation_sigma_rad{0.001};   ///< standard deviation per axis
  double translation_sigma_m{0.001};  ///< standard deviation per axis
  bool closure{false};                ///< may be wrong: its pull is limited, and it is dropped where it disagrees
};

struct PoseGraph {
  std::vector<Pose> T_world_node;  ///< first guess; node 0 stays where it is
  std::vector<PoseEdge> edges;
};

struct PoseGraphConfig {
  double robust_scale{2.0};        ///< Cauchy loss of closures, in standard deviations
  double max_closure_sigmas{5.0};  ///< a closure farther off than this is dropped, and the rest solved again
  int max_iterations{50};

  [[nodiscard]] Status validate() const;
};

struct PoseGraphResult {
  std::vector<Pose> T_world_node;
  std::vector<std::size_t> dropped;  ///< indices of edges: closures that disagree with the rest
  double initial_cost{0.0};          ///< half the sum of squared residuals, in standard deviations, after the loss
  double final_cost{0.0};
  int iterations{0};
};

/// Returns the solver's name and version; empty where this build has none.
[[nodiscard]] std::string pose_graph_solver();

/// Returns by how many standard deviations (root mean square over the six axes) an edge is off.
[[nodiscard]] double edge_error_sigmas(const PoseEdge& edge, const std::vector<Pose>& T_world_node);

/// Finds the poses that agree best with the edges, by Levenberg–Marquardt over rotations and translations (Ceres). The
/// farthest closure beyond the limit is dropped and the graph solved again until none is left.
/// Errors: unavailable without Ceres; invalid_argument for an empty graph, edges of nodes that are not there,
/// deviations that are not positive, or a node that no edge joins to node 0. One thread; equal input gives equal bits.
[[nodiscard]] Result<PoseGraphResult> solve_pose_graph(const PoseGraph& graph, const PoseGraphConfig& config = {});

}  // namespace saccade
