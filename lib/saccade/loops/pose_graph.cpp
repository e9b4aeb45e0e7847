// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/pose_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#ifdef SACCADE_HAS_CERES
#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/version.h>
#endif

namespace saccade {
namespace {

Error graph_error(const char* what) { return {Errc::invalid_argument, what, "pose graph"}; }

Status check_graph(const PoseGraph& graph) {
  if (graph.T_world_node.empty()) return graph_error("there are no poses");
  const std::size_t nodes = graph.T_world_node.size();
  std::vector<bool> joined(nodes, false);
  joined[0] = true;
  for (const PoseEdge& edge : graph.edges) {
    if (edge.from >= nodes || edge.to >= nodes || edge.from == edge.to) {
      return graph_error("an edge joins a pose that is not there, or one with itself");
    }
    if (!(edge.rotation_sigma_rad > 0.0) || !(edge.translation_sigma_m > 0.0)) {
      return graph_error("standard deviations must be positive");
    }
  }
  for (bool grew = true; grew;) {
    grew = false;
    for (const PoseEdge& edge : graph.edges) {
      if (edge.closure || joined[edge.from] == joined[edge.to]) continue;  // closures may be dropped
      joined[edge.from] = joined[edge.to] = grew = true;
    }
  }
  if (std::find(joined.begin(), joined.end(), false) != joined.end()) {
    return graph_error("a pose hangs on no edge, or on closures alone");
  }
  return {};
}

#ifdef SACCADE_HAS_CERES

/// A node as Ceres' parameters: a quaternion (x, y, z, w) and a translation.
struct NodeParameters {
  std::array<double, 4> q{};
  std::array<double, 3> t{};
};

NodeParameters to_parameters(const Pose& T) {
  const Eigen::Quaterniond q{T.linear()};
  const Eigen::Vector3d t = T.translation();
  return {{q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}};
}

Pose to_pose(const NodeParameters& node) {
  Pose T{Pose::Identity()};
  T.linear() = Eigen::Map<const Eigen::Quaterniond>{node.q.data()}.normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>{node.t.data()};
  return T;
}

/// Twice the vector part of the rotation's error, and the translation's, in standard deviations.
struct EdgeResidual {
  PoseEdge edge;

  template <class T>
  bool operator()(const T* q_from, const T* t_from, const T* q_to, const T* t_to, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> from{q_from};
    const Eigen::Map<const Eigen::Quaternion<T>> to{q_to};
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> at_from{t_from};
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> at_to{t_to};
    const Eigen::Quaternion<T> measured = Eigen::Quaterniond{edge.T_from_to.linear()}.cast<T>();
    const Eigen::Quaternion<T> off = measured.conjugate() * (from.conjugate() * to);
    const Eigen::Matrix<T, 3, 1> shift = from.conjugate() * (at_to - at_from) - edge.T_from_to.translation().cast<T>();
    const T sign = off.w() < T(0) ? T(-1) : T(1);
    for (int k = 0; k < 3; ++k) {
      residual[k] = T(2) * sign * off.vec()[k] / T(edge.rotation_sigma_rad);
      residual[3 + k] = shift[k] / T(edge.translation_sigma_m);
    }
    return true;
  }
};

PoseGraphResult solve_once(const PoseGraph& graph, const std::vector<bool>& dropped, const PoseGraphConfig& config) {
  std::vector<NodeParameters> nodes;
  for (const Pose& T : graph.T_world_node) nodes.push_back(to_parameters(T));
  ceres::EigenQuaternionManifold manifold;
  ceres::CauchyLoss loss{config.robust_scale};
  ceres::Problem::Options borrowed;
  borrowed.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  borrowed.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem{borrowed};
  for (NodeParameters& node : nodes) {
    problem.AddParameterBlock(node.q.data(), 4, &manifold);
    problem.AddParameterBlock(node.t.data(), 3);
  }
  problem.SetParameterBlockConstant(nodes[0].q.data());
  problem.SetParameterBlockConstant(nodes[0].t.data());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (dropped[i]) continue;
    const PoseEdge& edge = graph.edges[i];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<EdgeResidual, 6, 4, 3, 4, 3>(new EdgeResidual{edge}),  // Ceres owns them
        edge.closure ? &loss : nullptr, nodes[edge.from].q.data(), nodes[edge.from].t.data(), nodes[edge.to].q.data(),
        nodes[edge.to].t.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = config.max_iterations;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  PoseGraphResult result;
  for (const NodeParameters& node : nodes) result.T_world_node.push_back(to_pose(node));
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size());
  return result;
}

#endif

}  // namespace

Status PoseGraphConfig::validate() const {
  if (!(robust_scale > 0.0) || !(max_closure_sigmas > 0.0)) return graph_error("limits must be positive");
  if (max_iterations < 1) return graph_error("at least one iteration is needed");
  return {};
}

std::string pose_graph_solver() {
#ifdef SACCADE_HAS_CERES
  return "Ceres " CERES_VERSION_STRING;
#else
  return {};
#endif
}

double edge_error_sigmas(const PoseEdge& edge, const std::vector<Pose>& T_world_node) {
  const Pose T_from_to = T_world_node.at(edge.from).inverse() * T_world_node.at(edge.to);
  const double turn = rotation_angle_rad(edge.T_from_to.inverse() * T_from_to) / edge.rotation_sigma_rad;
  const double shift = (T_from_to.translation() - edge.T_from_to.translation()).norm() / edge.translation_sigma_m;
  return std::sqrt((turn * turn + shift * shift) / 6.0);
}

Result<PoseGraphResult> solve_pose_graph(const PoseGraph& graph, const PoseGraphConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(check_graph(graph));
#ifdef SACCADE_HAS_CERES
  std::vector<bool> dropped(graph.edges.size(), false);
  std::vector<std::size_t> order;
  int iterations{0};
  for (;;) {
    PoseGraphResult result = solve_once(graph, dropped, config);
    result.iterations = iterations += result.iterations;
    std::size_t farthest = graph.edges.size();
    double limit = config.max_closure_sigmas;
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
      if (dropped[i] || !graph.edges[i].closure) continue;
      const double off = edge_error_sigmas(graph.edges[i], result.T_world_node);
      if (off <= limit) continue;
      limit = off;
      farthest = i;
    }
    if (farthest == graph.edges.size()) {
      std::sort(order.begin(), order.end());
      result.dropped = std::move(order);
      return result;
    }
    dropped[farthest] = true;
    order.push_back(farthest);
  }
#else
  return Error{Errc::unavailable, "this build closes no loops: it lacks libceres-dev", "pose graph"};
#endif
}

}  // namespace saccade
