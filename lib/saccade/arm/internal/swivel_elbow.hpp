// SPDX-License-Identifier: Apache-2.0
#pragma once
// SwivelElbow: closed-form inverse kinematics of seven joints that turn, the first three about axes through one point,
// the last three about axes through another.

#include <Eigen/Core>
#include <vector>

#include "saccade/arm/internal/elbow_triangle.hpp"
#include "saccade/arm/internal/three_turns.hpp"

namespace saccade {

/// Solves arms with a spherical shoulder S and a spherical wrist W, both beside the axis of the elbow between them,
/// such as KUKA's iiwa. Offsets of the elbow and oblique axes are no obstacle.
///
/// The pose places W: its distance from S settles q₄ (ElbowTriangle). What is left open is the swivel of the elbow
/// about the line from S to W; with one chosen, the turns of the shoulder and of the wrist are known: ThreeTurns each.
/// Every swivel will do but for limits, which a fixed value of one of the joints would not: near a straight elbow that
/// leaves next to nothing.
class SwivelElbow {
 public:
  /// unsupported, saying what about the arm does not fit. Expects one sample at least.
  [[nodiscard]] static Result<SwivelElbow> find(const ArmModel& arm, int samples);

  [[nodiscard]] bool is_exact() const { return exact_; }
  /// Swivels: first the one that has the shoulder stand nearest to the reference's, then samples over one turn.
  [[nodiscard]] std::size_t rounds() const { return samples_.size() + 1; }
  /// All solutions with the swivel of a round in which every angle, give or take whole turns, is within its limits.
  /// Where axes 1 and 3, or 5 and 7, end up in one line, q₁ or q₅ is the reference's. No solution is given in two
  /// rounds. Safe for concurrent use.
  [[nodiscard]] SevenSolutions solve(const Pose& T_world_camera, const Configuration& reference,
                                     std::size_t round) const;

 private:
  struct Sample {
    double swivel_rad;
    Eigen::Matrix3d R;  ///< the turn about x by it
  };
  SwivelElbow() = default;

  bool exact_{true};
  JointAxes axes_;
  Eigen::Vector3d p_camera_W_;      // in the frame of the camera, always the same
  Eigen::Matrix3d R_camera_world_;  // rotation of the camera at q = 0
  ElbowTriangle elbow_;
  ThreeTurns shoulder_;
  ThreeTurns wrist_;
  std::vector<Sample> samples_;
};

}  // namespace saccade
