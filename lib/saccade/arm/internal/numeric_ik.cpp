// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/numeric_ik.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <numbers>
#include <utility>

#include "saccade/arm/internal/joint_turns.hpp"
#include "saccade/arm/kinematics.hpp"

// KDL's solver and OMPL's library both carry this decomposition as a weak symbol; Debian 12's OMPL has that of an older
// Eigen with another layout. The one loaded first serves both, and KDL aborts with OMPL's. A program with its own
// instance, from the headers that KDL was built with, provides it to all.
template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace saccade {
namespace {

KDL::Vector to_kdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame to_kdl(const Pose& T) {
  const Eigen::Matrix3d& R = T.linear();
  return {KDL::Rotation{R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)},
          to_kdl(T.translation())};
}

/// Returns the chain from the world to the camera.
KDL::Chain chain_of(const ArmModel& arm) {
  const KDL::Joint rigid{KDL::Joint::None};
  KDL::Chain chain;
  chain.addSegment(KDL::Segment{rigid, to_kdl(arm.T_world_base())});
  for (const ArmJoint& joint : arm.joints()) {
    const KDL::Frame T_parent_joint = to_kdl(joint.T_parent_joint);
    const auto kind = joint.kind == JointKind::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    const KDL::Joint axis{joint.name, T_parent_joint.p, T_parent_joint.M * to_kdl(joint.axis_joint), kind};
    chain.addSegment(KDL::Segment{axis, T_parent_joint});
  }
  chain.addSegment(KDL::Segment{rigid, to_kdl(arm.T_link_camera())});
  return chain;
}

/// Length by which KDL weighs rotations: a radian counts as much as half a metre.
constexpr double kRotationWeight_m{0.5};
constexpr double kLmaTolerance{1e-6};

class Lma {
 public:
  Lma(const ArmModel& arm, int iterations)
      : chain_{chain_of(arm)},
        solver_{chain_, weights(), kLmaTolerance, iterations},
        in_{static_cast<unsigned>(arm.dof())},
        out_{static_cast<unsigned>(arm.dof())} {}

  bool solve(const KDL::Frame& goal, Configuration& q) {
    in_.data = q;
    if (solver_.CartToJnt(in_, goal, out_) < 0 || !out_.data.allFinite()) {
      if (out_.data.allFinite()) q = out_.data;
      return false;
    }
    q = out_.data;
    return true;
  }

 private:
  static Eigen::Matrix<double, 6, 1> weights() {
    Eigen::Matrix<double, 6, 1> weights;
    weights << 1.0, 1.0, 1.0, kRotationWeight_m, kRotationWeight_m, kRotationWeight_m;
    return weights;
  }
  KDL::Chain chain_;
  KDL::ChainIkSolverPos_LMA solver_;
  KDL::JntArray in_;
  KDL::JntArray out_;
};

/// Clamps to the limits, in the turn nearest to the reference.
void put_on_limits(const ArmModel& arm, Configuration& q) {
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joint(i);
    if (joint.kind != JointKind::prismatic) q[i] = std::remainder(q[i], 2.0 * std::numbers::pi);
    q[i] = std::clamp(q[i], joint.limits.lower, joint.limits.upper);
  }
}

/// Tells whether the last link's origin, which the pose determines, is within the length of the stretched links from
/// the first joint. This rejects most unreachable poses without a start.
bool may_reach(const ArmModel& arm, const Pose& T_world_camera) {
  constexpr double kSlack_m{1e-6};
  const Eigen::Vector3d last = T_world_camera * (arm.T_link_camera().inverse(Eigen::Isometry).translation());
  const Eigen::Vector3d first = arm.T_world_base() * arm.joint(0).T_parent_joint.translation();
  return !((last - first).norm() > reach_bound_m(arm) - arm.T_link_camera().translation().norm() + kSlack_m);
}

bool differs(const Configuration& a, const Configuration& b, double by) {
  return (a - b).lpNorm<Eigen::Infinity>() > by;
}

}  // namespace

Status NumericIkConfig::validate() const {
  if (restarts < 0 || max_solutions < 1 || iterations < 1)
    return Error{Errc::invalid_argument, "restarts must not be negative; solutions and iterations must be at least one",
                 ""};
  if (!(distinct_rad > 0.0)) return Error{Errc::invalid_argument, "distinct_rad must be positive", ""};
  return {};
}

Result<NumericIk> NumericIk::create(std::shared_ptr<const ArmModel> arm, const NumericIkConfig& config) {
  SACCADE_EXPECTS(arm != nullptr);
  SACCADE_CHECK(config.validate());
  return NumericIk{std::move(arm), config};
}

std::vector<Configuration> NumericIk::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == arm_->dof());
  if (!may_reach(*arm_, T_world_camera)) return {};
  const KDL::Frame goal = to_kdl(T_world_camera);
  Lma lma{*arm_, config_.iterations};
  SeededRandom random{config_.seed};
  std::vector<Configuration> found;
  std::vector<Configuration> turns;
  for (int start = 0; start <= config_.restarts; ++start) {
    Configuration q = start == 0 ? reference : sample_configuration(*arm_, random);
    for (const bool again : {false, true}) {
      turns.clear();
      if (lma.solve(goal, q) && refine(*arm_, T_world_camera, q)) append_turns(*arm_, q, reference, 1, turns);
      if (!turns.empty() || again) break;
      put_on_limits(*arm_, q);
    }
    if (turns.empty()) continue;
    bool is_new = true;
    for (const Configuration& known : found) is_new = is_new && differs(known, turns.front(), config_.distinct_rad);
    if (is_new) found.push_back(turns.front());
    if (static_cast<int>(found.size()) == config_.max_solutions) break;
  }
  return found;
}

bool refine(const ArmModel& arm, const Pose& T_world_camera, Configuration& q) {
  constexpr int kIterations{10};
  constexpr double kDamping{1e-12};
  for (int i = 0; i <= kIterations; ++i) {
    const ArmPoses poses = forward_kinematics(arm, q);
    const Eigen::Matrix<double, 6, 1> miss = twist_between(poses.T_world_camera, T_world_camera);
    if (!miss.allFinite()) return false;
    // A tenth of the tolerance, so that other ways of measuring agree as well.
    if (miss.head<3>().norm() <= 0.1 * kIkTolerance && miss.tail<3>().norm() <= 0.1 * kIkTolerance) return true;
    if (i == kIterations) break;
    const Jacobian J = camera_jacobian(arm, poses);
    Eigen::Matrix<double, 6, 6> JJt = J * J.transpose();
    JJt.diagonal().array() += kDamping;
    q += J.transpose() * JJt.ldlt().solve(miss);
  }
  return false;
}

}  // namespace saccade
