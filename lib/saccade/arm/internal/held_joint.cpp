// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/held_joint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace saccade {
namespace {

constexpr double kSameValue{1e-6};  // samples this near to the reference's value are skipped; rad or m

/// Returns the arm without its first or last joint, which is fixed at 0. Bodies are dropped.
Result<ArmModel> without_joint(const ArmModel& arm, int joint) {
  ArmDescription description = arm.description();
  for (ArmLink& link : description.links) link.bodies.clear();
  const Pose T_parent_joint = arm.joint(joint).T_parent_joint;
  description.joints.erase(description.joints.begin() + joint);
  if (joint == 0) {
    description.links.erase(description.links.begin());
    description.T_world_base = description.T_world_base * T_parent_joint;
  } else {
    description.links.pop_back();
    description.T_link_flange = T_parent_joint;
    description.T_flange_camera = Pose::Identity();
  }
  return ArmModel::create(std::move(description));
}

std::vector<double> values_of(const ArmJoint& joint, int count) {
  const JointLimits& limits = joint.limits;
  const bool farther = joint.kind != JointKind::prismatic && !(limits.upper - limits.lower <= 2.0 * std::numbers::pi);
  if (!farther) return spread_over(limits.lower, limits.upper, count);
  return spread_over(-std::numbers::pi, std::numbers::pi, count);
}

}  // namespace

Result<HeldJoint> HeldJoint::find(const ArmModel& arm, int samples) {
  SACCADE_EXPECTS(samples >= 1);
  if (arm.dof() != 7) return no_closed_form(arm, "it has " + std::to_string(arm.dof()) + " joints, not seven");
  for (const int joint : {6, 0}) {
    SACCADE_TRY(const ArmModel rest, without_joint(arm, joint));
    if (auto six = SixAxes::find(rest)) return HeldJoint{arm, joint, *std::move(six), samples};
  }
  return no_closed_form(arm, "neither the first six nor the last six of its seven joints have one");
}

HeldJoint::HeldJoint(const ArmModel& arm, int joint, SixAxes six, int samples)
    : six_{std::move(six)},
      joint_{joint},
      model_{arm.joint(joint)},
      T_end_{joint == 0 ? arm.T_world_base() * model_.T_parent_joint : arm.T_link_camera().inverse(Eigen::Isometry)} {
  for (const double value : values_of(model_, samples)) samples_.push_back(sample_at(value));
}

HeldJoint::Sample HeldJoint::sample_at(double value) const {
  Pose undone = Pose::Identity();
  if (model_.kind == JointKind::prismatic) {
    undone.translation() = -value * model_.axis_joint;
  } else {
    undone.linear() = rotation_about(model_.axis_joint, -value);
  }
  return {value, joint_ == 0 ? T_end_ * undone * T_end_.inverse(Eigen::Isometry) : T_end_ * undone};
}

SevenSolutions HeldJoint::solve(const Pose& T_world_camera, const Configuration& reference, std::size_t round) const {
  SACCADE_EXPECTS(reference.size() == 7 && round < rounds());
  SevenSolutions solutions;
  const double own = std::clamp(reference[joint_], model_.limits.lower, model_.limits.upper);
  if (round > 0) {
    const double apart = samples_[round - 1].value - own;
    if (std::fabs(model_.kind == JointKind::prismatic ? apart : wrapped(apart)) < kSameValue) return solutions;
  }
  const Sample at = round == 0 ? sample_at(own) : samples_[round - 1];
  const ClosedFormSolutions found = joint_ == 0 ? six_.solve(at.T_back * T_world_camera, reference.tail(6))
                                                : six_.solve(T_world_camera * at.T_back, reference.head(6));
  for (; solutions.count < found.count; ++solutions.count) {
    Eigen::Matrix<double, 7, 1>& q = solutions.q[solutions.count];
    q[joint_] = at.value;
    q.segment<6>(joint_ == 0 ? 1 : 0) = found.q[solutions.count];
  }
  return solutions;
}

}  // namespace saccade
