// SPDX-License-Identifier: Apache-2.0
#pragma once
// KdlArm: the same arm in Orocos KDL, built joint by joint with KDL's own frames; oracle and peer of ours.

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade::test {

class KdlArm {
 public:
  explicit KdlArm(const ArmModel& arm)
      : chain_{chain_of(arm)}, forward_{chain_}, jacobian_{chain_}, inverse_{chain_}, dof_{arm.dof()} {}

  [[nodiscard]] Pose camera_pose(const Configuration& q) {
    KDL::Frame frame;
    forward_.JntToCart(values(q), frame);
    return from_kdl(frame);
  }

  [[nodiscard]] Jacobian camera_jacobian(const Configuration& q) {
    KDL::Jacobian jacobian{static_cast<unsigned>(dof_)};
    jacobian_.JntToJac(values(q), jacobian);
    return jacobian.data;
  }

  /// One solution by Levenberg–Marquardt, limits ignored; false: none.
  [[nodiscard]] bool solve(const Pose& T_world_camera, Configuration& q) {
    KDL::JntArray out{static_cast<unsigned>(dof_)};
    if (inverse_.CartToJnt(values(q), to_kdl(T_world_camera), out) < 0) return false;
    q = out.data;
    return true;
  }

 private:
  static KDL::Vector to_kdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
  static KDL::Frame to_kdl(const Pose& T) {
    return {KDL::Rotation{to_kdl(T.linear().col(0)), to_kdl(T.linear().col(1)), to_kdl(T.linear().col(2))},
            to_kdl(T.translation())};
  }
  static Pose from_kdl(const KDL::Frame& frame) {
    Pose T;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) T(row, column) = frame.M(row, column);
      T(row, 3) = frame.p(row);
    }
    return T;
  }
  static KDL::Chain chain_of(const ArmModel& arm) {
    KDL::Chain chain;
    chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::None}, to_kdl(arm.T_world_base())});
    for (const ArmJoint& joint : arm.joints()) {
      // The joint's origin is a rigid segment; the joint then stands in its own frame.
      chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::None}, to_kdl(joint.T_parent_joint)});
      const auto kind = joint.kind == JointKind::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
      chain.addSegment(KDL::Segment{KDL::Joint{joint.name, KDL::Vector::Zero(), to_kdl(joint.axis_joint), kind}});
    }
    chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::None}, to_kdl(arm.T_link_camera())});
    return chain;
  }
  static KDL::JntArray values(const Configuration& q) {
    KDL::JntArray array{static_cast<unsigned>(q.size())};
    array.data = q;
    return array;
  }

  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive forward_;
  KDL::ChainJntToJacSolver jacobian_;
  KDL::ChainIkSolverPos_LMA inverse_;
  int dof_;
};

}  // namespace saccade::test
