// SPDX-License-Identifier: Apache-2.0
#pragma once
// SwivelElbow: closed-form inverse kinematics of seven revolute joints, the first three about axes through one point,
// the last three about axes through another.

#include <Eigen/Core>
#include <vector>

#include "saccade/arm/internal/elbow_triangle.hpp"
#include "saccade/arm/internal/three_turns.hpp"

namespace saccade {

/// Solver for arms with a spherical shoulder S and a spherical wrist W, both beside the axis of the elbow between them,
/// such as KUKA's iiwa. Offsets of the elbow and oblique axes are allowed.
///
/// The pose places W; its distance from S determines q₄ (ElbowTriangle). The swivel of the elbow about the line from S
/// to W remains free. With one chosen, the rotations of the shoulder and of the wrist are known: ThreeTurns each. Apart
/// from limits every swivel is a solution. A fixed value of one of the joints would not be: near a straight elbow it
/// leaves almost no solutions.
class SwivelElbow {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit. Expects at least one sample.
  [[nodiscard]] static Result<SwivelElbow> find(const ArmModel& arm, int samples);

  [[nodiscard]] bool is_exact() const { return exact_; }
  /// Number of swivels: first the one whose shoulder is nearest to the reference's, then samples over one turn.
  [[nodiscard]] std::size_t rounds() const { return samples_.size() + 1; }
  /// Returns all solutions with the swivel of a round in which every angle, up to whole turns, is within its limits.
  /// Where axes 1 and 3, or 5 and 7, are collinear, q₁ or q₅ is the reference's. No solution occurs in two rounds. Safe
  /// for concurrent use.
  [[nodiscard]] SevenSolutions solve(const Pose& T_world_camera, const Configuration& reference,
                                     std::size_t round) const;

 private:
  struct Sample {
    double swivel_rad;
    Eigen::Matrix3d R;  ///< rotation about x by it
  };
  SwivelElbow() = default;

  bool exact_{true};
  JointAxes axes_;
  Eigen::Vector3d p_camera_W_;      // W in the frame of the camera, constant
  Eigen::Matrix3d R_camera_world_;  // rotation of the camera at q = 0
  ElbowTriangle elbow_;
  ThreeTurns shoulder_;
  ThreeTurns wrist_;
  std::vector<Sample> samples_;
};

}  // namespace saccade
