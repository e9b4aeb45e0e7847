// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/mount_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

/// One round of refinement: the points used, the limit of pairs, and whether views move individually too.
struct Round {
  int stride;
  double max_distance_m;
  bool views_free;
  int iterations;
};
constexpr std::array<Round, 5> kRounds{
    {{8, 0.10, false, 12}, {8, 0.05, false, 8}, {4, 0.03, true, 6}, {4, 0.02, true, 8}, {2, 0.02, true, 3}}};
constexpr double kMaxNormalAngle_rad{0.6};
constexpr double kConverged{2e-6};         // step in metres and radians, per pixel of stride
constexpr double kLargestStep{0.05};       // metres, radians and seconds together
constexpr double kIndependentShare{0.05};  // share of points that count as independent, since neighbours share errors

using Matrix67d = Eigen::Matrix<double, 6, 7>;

/// Accuracy of flange poses, per axis, estimated from the views' individual motions.
struct FlangeSigma {
  static constexpr double kLeast_rad{0.005_deg};
  static constexpr double kLeast_m{0.00005};
  double rotation_rad{0.1_deg};
  double translation_m{0.001};

  /// Returns the weights in units of the pairs' equations, 1/mm².
  [[nodiscard]] Vector6d weights() const {
    Vector6d weights;
    weights << Eigen::Vector3d::Constant(1e-6 / (rotation_rad * rotation_rad)),
        Eigen::Vector3d::Constant(1e-6 / (translation_m * translation_m));
    return weights;
  }
};

/// Point-to-plane distances r of one pair of views, and their derivatives by the unknowns.
struct PairEquations {
  std::size_t measured{0};
  std::size_t model{0};
  Matrix6d JtJ{Matrix6d::Zero()};  ///< derivative by the twist of the measured view's points, seen from the model view
  Vector6d Jtr{Vector6d::Zero()};
  Matrix67d by_mount{Matrix67d::Zero()};   ///< derivative of that twist by mount and clock offset
  Matrix6d by_measured{Matrix6d::Zero()};  ///< by the measured view's own motion; by the model view's it is −I
};

/// Normal equations, only the lower half of H: mount (6), clock offset (1), then each view's own motion (6).
struct JointEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

constexpr Eigen::Index kShared{7};

Eigen::Index first_of(std::size_t view) { return kShared + 6 * static_cast<Eigen::Index>(view); }

/// Adds a pair's equations `times` times.
void add_pair(const PairEquations& pair, double times, JointEquations& joint) {
  const Eigen::Index i = first_of(pair.measured);
  const Eigen::Index j = first_of(pair.model);
  const Matrix6d JtJ = times * kIndependentShare * pair.JtJ;
  const Vector6d Jtr = times * kIndependentShare * pair.Jtr;
  const Matrix67d at_mount = JtJ * pair.by_mount;
  const Matrix6d at_measured = JtJ * pair.by_measured;
  joint.H.topLeftCorner<7, 7>() += pair.by_mount.transpose() * at_mount;
  joint.H.block<6, 6>(i, i) += pair.by_measured.transpose() * at_measured;
  joint.H.block<6, 6>(j, j) += JtJ;
  joint.H.block<6, 7>(i, 0) += pair.by_measured.transpose() * at_mount;
  joint.H.block<6, 7>(j, 0) -= at_mount;
  if (i < j) {
    joint.H.block<6, 6>(j, i) -= at_measured;
  } else {
    joint.H.block<6, 6>(i, j) -= at_measured.transpose();
  }
  joint.g.head<7>() += pair.by_mount.transpose() * Jtr;
  joint.g.segment<6>(i) += pair.by_measured.transpose() * Jtr;
  joint.g.segment<6>(j) -= Jtr;
}

/// Returns the matrix that maps a twist (rotation vector, translation) from frame b to frame a.
Matrix6d adjoint(const Pose& T_a_b) {
  const Eigen::Vector3d t = T_a_b.translation();
  Eigen::Matrix3d cross;
  cross << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
  Matrix6d matrix = Matrix6d::Zero();
  matrix.topLeftCorner<3, 3>() = T_a_b.linear();
  matrix.bottomRightCorner<3, 3>() = T_a_b.linear();
  matrix.bottomLeftCorner<3, 3>() = cross * T_a_b.linear();
  return matrix;
}

Vector6d logarithm(const Pose& T) {
  const Eigen::AngleAxisd turn{T.linear()};
  Vector6d x;
  x << turn.angle() * turn.axis(), T.translation();
  return x;
}

/// Returns the full matrix of a lower half, regularised where it is singular.
Eigen::MatrixXd regular(const JointEquations& joint) {
  Eigen::MatrixXd H = joint.H.selfadjointView<Eigen::Lower>();
  H.diagonal().array() += 1e-9 * joint.H.diagonal().maxCoeff();
  return H;
}

/// Returns x of H x = −g.
Eigen::VectorXd solve_joint(const JointEquations& joint) { return regular(joint).ldlt().solve(-joint.g); }

/// Views of one refinement, and their equations at a mount and an offset.
class Comparison {
 public:
  Comparison(std::span<const MountView> views, const PinholeCamera& camera, const FlangeRecord& record,
             const Executor& executor)
      : views_{views}, camera_{camera}, record_{record}, executor_{executor} {
    for (const MountView& view : views) points_.push_back(&view.points);
    T_camera_own_.assign(views.size(), Pose::Identity());
  }

  void choose_pairs(const MountEstimate& at, const HandEyeConfig& config) {
    pairs_ = overlapping_pairs(points_, camera_, poses(at), config.min_overlap, config.max_pairs, executor_);
  }

  void choose_level(int stride) {
    if (stride == stride_) return;
    stride_ = stride;
    levels_.clear();
    for (const MountView& view : views_) levels_.emplace_back(view.points, stride);
  }

  /// Returns the equations pair by pair. Camera i is at C_i = A_i X E_i, where E_i is the view's own motion. x, δ and
  /// η_i move it by the twist ε_i = Ad(E_i⁻¹) (x + δ v_i) + η_i in its own frame, where v_i is its flange's twist seen
  /// from the mount. Seen from view j, the points of view i then move by Ad(T_j_i) ε_i − ε_j.
  [[nodiscard]] std::vector<PairEquations> equations(const MountEstimate& at, double max_distance_m) const {
    const std::vector<Pose> T_base_camera = poses(at);
    const Matrix6d to_mount = adjoint(at.T_flange_camera.inverse());
    std::vector<Matrix67d> by_mount(views_.size(), Matrix67d::Zero());
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Matrix6d to_own = adjoint(T_camera_own_[i].inverse());
      by_mount[i].leftCols<6>() = to_own;
      if (!views_[i].time_s) continue;
      by_mount[i].col(6) = to_own * to_mount * record_.twist_at(*views_[i].time_s + at.clock_offset_s);
    }
    std::vector<PairEquations> by_pair(pairs_.size());
    const Executor alone;
    executor_.parallel_for(pairs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto [i, j] = pairs_[k];
        const Pose T_j_i = T_base_camera[j].inverse() * T_base_camera[i];
        const Alignment alignment{*points_[j], camera_, {max_distance_m, kMaxNormalAngle_rad}};
        const NormalEquations sums = alignment.linearize(T_j_i, levels_[i], alone);
        const Matrix6d moves = adjoint(T_j_i);
        by_pair[k] = {i,    j, sums.JtJ.selfadjointView<Eigen::Lower>(), sums.Jtr, moves * by_mount[i] - by_mount[j],
                      moves};
      }
    });
    return by_pair;
  }

  /// Combines all pairs with the prior on the flange poses.
  [[nodiscard]] JointEquations joint(const std::vector<PairEquations>& by_pair, const FlangeSigma& sigma) const {
    const Eigen::Index size = first_of(views_.size());
    JointEquations joint{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
    for (const PairEquations& pair : by_pair) add_pair(pair, 1.0, joint);
    for (std::size_t view = 0; view < views_.size(); ++view) add_prior(view, 1.0, sigma, joint);
    return joint;
  }

  void add_prior(std::size_t view, double times, const FlangeSigma& sigma, JointEquations& joint) const {
    const Vector6d weights = times * sigma.weights();
    joint.H.diagonal().segment<6>(first_of(view)) += weights;
    joint.g.segment<6>(first_of(view)) += weights.cwiseProduct(logarithm(T_camera_own_[view]));
  }

  void move_views(const Eigen::VectorXd& step) {
    for (std::size_t view = 0; view < views_.size(); ++view) {
      T_camera_own_[view] = T_camera_own_[view] * exponential(step.segment<6>(first_of(view)));
    }
  }

  /// Estimates the accuracy per axis from the views' own motions and their certainty (a step of
  /// expectation–maximisation).
  [[nodiscard]] FlangeSigma flange_sigma(const JointEquations& joint) const {
    const Eigen::Index size = joint.H.rows();
    const Eigen::MatrixXd covariance_mm2 = regular(joint).ldlt().solve(Eigen::MatrixXd::Identity(size, size));
    double rotation{0.0};
    double translation{0.0};
    for (std::size_t view = 0; view < views_.size(); ++view) {
      const Vector6d own = logarithm(T_camera_own_[view]);
      const auto variances = 1e-6 * covariance_mm2.diagonal().segment<6>(first_of(view));
      rotation += own.head<3>().squaredNorm() + variances.head<3>().sum();
      translation += own.tail<3>().squaredNorm() + variances.tail<3>().sum();
    }
    const double count = 3.0 * static_cast<double>(views_.size());
    return {std::max(std::sqrt(rotation / count), FlangeSigma::kLeast_rad),
            std::max(std::sqrt(translation / count), FlangeSigma::kLeast_m)};
  }

  [[nodiscard]] const std::vector<ViewPair>& pairs() const { return pairs_; }

  /// Returns the covariance by deleting one view at a time, with one Gauss–Newton step each. Errors of neighbouring
  /// pixels, and of one view's flange pose, are correlated; those of different views are independent.
  [[nodiscard]] Matrix7d jackknife(const std::vector<PairEquations>& by_pair, const FlangeSigma& sigma) const {
    const JointEquations all = joint(by_pair, sigma);
    std::vector<Vector7d> without(views_.size());
    executor_.parallel_for(views_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t view = begin; view < end; ++view) {
        JointEquations rest = all;
        for (const PairEquations& pair : by_pair) {
          if (pair.measured == view || pair.model == view) add_pair(pair, -1.0, rest);
        }
        add_prior(view, -1.0, sigma, rest);
        rest.H.diagonal().segment<6>(first_of(view)).array() += 1.0;
        without[view] = solve_joint(rest).head<7>();
      }
    });
    Vector7d mean = Vector7d::Zero();
    const auto n = static_cast<double>(views_.size());
    for (const Vector7d& x : without) mean += x / n;
    Matrix7d covariance = Matrix7d::Zero();
    for (const Vector7d& x : without) covariance += (n - 1.0) / n * (x - mean) * (x - mean).transpose();
    return covariance;
  }

 private:
  [[nodiscard]] std::vector<Pose> poses(const MountEstimate& at) const {
    std::vector<Pose> poses = camera_poses(views_, record_, at.T_flange_camera, at.clock_offset_s);
    for (std::size_t view = 0; view < poses.size(); ++view) poses[view] = poses[view] * T_camera_own_[view];
    return poses;
  }

  std::span<const MountView> views_;
  const PinholeCamera& camera_;
  const FlangeRecord& record_;
  const Executor& executor_;
  std::vector<const PointImage*> points_;
  std::vector<Pose> T_camera_own_;  ///< E_i of each view
  std::vector<ViewPair> pairs_;
  int stride_{0};
  std::deque<Level> levels_;
};

}  // namespace

std::vector<Pose> camera_poses(std::span<const MountView> views, const FlangeRecord& record,
                               const Pose& T_flange_camera, double clock_offset_s) {
  std::vector<Pose> poses;
  for (const MountView& view : views) {
    const Pose T_base_flange = view.time_s ? record.at(*view.time_s + clock_offset_s) : view.T_base_flange;
    poses.push_back(T_base_flange * T_flange_camera);
  }
  return poses;
}

MountEstimate refine_mount(std::span<const MountView> views, const PinholeCamera& camera, const FlangeRecord& record,
                           const MountEstimate& start, const HandEyeConfig& config, const Executor& executor) {
  Comparison comparison{views, camera, record, executor};
  MountEstimate estimate = start;
  FlangeSigma sigma;
  for (const Round& round : kRounds) {
    comparison.choose_pairs(estimate, config);
    comparison.choose_level(round.stride);
    for (int i = 0; i < round.iterations; ++i) {
      const JointEquations joint = comparison.joint(comparison.equations(estimate, round.max_distance_m), sigma);
      Eigen::VectorXd step = solve_joint(
          round.views_free ? joint
                           : JointEquations{joint.H.topLeftCorner<kShared, kShared>(), joint.g.head<kShared>()});
      if (step.norm() > kLargestStep) step *= kLargestStep / step.norm();
      estimate.T_flange_camera = estimate.T_flange_camera * exponential(step.head<6>());
      estimate.clock_offset_s += step[6];
      if (round.views_free) {
        comparison.move_views(step);
        sigma = comparison.flange_sigma(joint);
      }
      ++estimate.iterations;
      if (step.norm() < kConverged * round.stride) break;
    }
  }
  estimate.pairs = comparison.pairs().size();
  estimate.flange_rotation_sigma_rad = sigma.rotation_rad;
  estimate.flange_translation_sigma_m = sigma.translation_m;
  estimate.covariance = comparison.jackknife(comparison.equations(estimate, kRounds.back().max_distance_m), sigma);
  return estimate;
}

}  // namespace saccade
