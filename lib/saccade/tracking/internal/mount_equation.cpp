// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/mount_equation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "saccade/core/angle.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade {
namespace {

constexpr double kMinTurn_rad{3_deg};
constexpr double kMaxTurn_rad{170_deg};          // beyond it, noise may flip a rotation vector
constexpr double kMaxTurnDifference_rad{2_deg};  // camera and flange turn by one angle, whatever the mount
constexpr int kReweightings{12};

Eigen::Vector3d turn_of(const Pose& T) {
  const Eigen::AngleAxisd turn{T.linear()};
  return turn.angle() * turn.axis();
}

/// Returns Tukey's weights, with the scale from the median residual.
std::vector<double> tukey_weights(const std::vector<double>& residuals, double smallest_scale) {
  const double scale = std::max(1.4826 * median(residuals), smallest_scale);
  std::vector<double> weights;
  for (const double residual : residuals) {
    const double share = residual / (4.685 * scale);
    weights.push_back(share < 1.0 ? (1.0 - share * share) * (1.0 - share * share) : 0.0);
  }
  return weights;
}

/// Returns the rotation R that makes Σ w |α − R β|² smallest.
Eigen::Matrix3d rotation_of(std::span<const MotionPair> motions, const std::vector<double>& weights) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    sum += weights[i] * turn_of(motions[i].T_flange_flange) * turn_of(motions[i].T_camera_camera).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd{sum, Eigen::ComputeFullU | Eigen::ComputeFullV};
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// Returns the translation t that makes Σ w |(R_A − I) t − (R t_B − t_A)|² smallest.
Eigen::Vector3d translation_of(std::span<const MotionPair> motions, const Eigen::Matrix3d& R,
                               const std::vector<double>& weights) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Eigen::Matrix3d lever = motions[i].T_flange_flange.linear() - Eigen::Matrix3d::Identity();
    matrix += weights[i] * lever.transpose() * lever;
    vector += weights[i] * lever.transpose() *
              (R * motions[i].T_camera_camera.translation() - motions[i].T_flange_flange.translation());
  }
  return matrix.fullPivLu().solve(vector);
}

Turns turns_from(const Eigen::Matrix3d& sum, std::size_t count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{sum /
                                                              static_cast<double>(std::max<std::size_t>(count, 1))};
  Turns turns;
  turns.rms_rad = solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  turns.axes_flange = solver.eigenvectors().rowwise().reverse();
  return turns;
}

}  // namespace

void add_motions(std::span<const Pose> T_base_flange, std::span<const Pose> T_world_camera,
                 std::vector<MotionPair>& motions) {
  constexpr std::size_t kMostPoses{60};
  const std::size_t count = T_base_flange.size();
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < std::min(count, kMostPoses); ++k) {
    chosen.push_back(count <= kMostPoses ? k : k * count / kMostPoses);
  }
  for (std::size_t a = 0; a < chosen.size(); ++a) {
    for (std::size_t b = a + 1; b < chosen.size(); ++b) {
      motions.push_back({T_base_flange[chosen[a]].inverse() * T_base_flange[chosen[b]],
                         T_world_camera[chosen[a]].inverse() * T_world_camera[chosen[b]]});
    }
  }
}

Turns turns_of(std::span<const Pose> T_base_flange) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  std::size_t count{0};
  for (std::size_t a = 0; a < T_base_flange.size(); ++a) {
    for (std::size_t b = a + 1; b < T_base_flange.size(); ++b, ++count) {
      const Eigen::Vector3d turn = turn_of(T_base_flange[a].inverse() * T_base_flange[b]);
      sum += turn * turn.transpose();
    }
  }
  return turns_from(sum, count);
}

std::optional<Pose> solve_mount(std::span<const MotionPair> motions) {
  std::vector<MotionPair> used;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (const MotionPair& motion : motions) {
    const Eigen::Vector3d flange = turn_of(motion.T_flange_flange);
    const double turn_rad = flange.norm();
    const double difference_rad = std::abs(turn_rad - turn_of(motion.T_camera_camera).norm());
    if (turn_rad < kMinTurn_rad || turn_rad > kMaxTurn_rad || difference_rad > kMaxTurnDifference_rad) continue;
    used.push_back(motion);
    turned += flange * flange.transpose();
  }
  if (3 * used.size() < motions.size() || used.size() < 2) return std::nullopt;
  if (turns_from(turned, used.size()).rms_rad[1] < kMinTurn_rad) return std::nullopt;

  Pose X{Pose::Identity()};
  std::vector<double> weights(used.size(), 1.0);
  for (int i = 0; i < kReweightings; ++i) {
    X.linear() = rotation_of(used, weights);
    std::vector<double> residuals;
    for (const MotionPair& motion : used) {
      residuals.push_back((turn_of(motion.T_flange_flange) - X.linear() * turn_of(motion.T_camera_camera)).norm());
    }
    weights = tukey_weights(residuals, 1e-4);
  }
  weights.assign(used.size(), 1.0);
  for (int i = 0; i < kReweightings; ++i) {
    X.translation() = translation_of(used, X.linear(), weights);
    std::vector<double> residuals;
    for (const MotionPair& motion : used) {
      const Pose difference = (motion.T_flange_flange * X).inverse() * (X * motion.T_camera_camera);
      residuals.push_back(difference.translation().norm());
    }
    weights = tukey_weights(residuals, 1e-4);
  }
  if (!X.matrix().allFinite()) return std::nullopt;
  return X;
}

}  // namespace saccade
