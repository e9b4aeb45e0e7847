// SPDX-License-Identifier: Apache-2.0
#pragma once
// HeldJoint: seven joints in closed form, with the last or the first of them held at a series of values.

#include <optional>
#include <vector>

#include "saccade/arm/internal/six_axes.hpp"

namespace saccade {

/// Solver for seven joints of which the first six or the last six have a closed form (SixAxes). Holding a joint at
/// either end of an arm only shifts the pose for the other joints. The held joint may slide: an industrial arm on a
/// rail.
class HeldJoint {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit. Expects at least one sample.
  [[nodiscard]] static Result<HeldJoint> find(const ArmModel& arm, int samples);

  [[nodiscard]] bool is_exact() const { return six_.is_exact(); }
  /// Returns the index of the held joint, 0 or 6.
  [[nodiscard]] int joint() const { return joint_; }
  /// Number of values of the joint: first the reference's own, then samples over its limits, or over one turn where it
  /// can turn farther.
  [[nodiscard]] std::size_t rounds() const { return samples_.size() + 1; }
  /// Returns all solutions with the joint's value of a round in which every angle, up to whole turns, is within its
  /// limits. No solution occurs in two rounds. Safe for concurrent use.
  [[nodiscard]] SevenSolutions solve(const Pose& T_world_camera, const Configuration& reference,
                                     std::size_t round) const;

 private:
  struct Sample {
    double value;
    Pose T_back;  ///< undoes the joint's turn: multiplied to the pose from the left (first joint) or the right (last)
  };
  HeldJoint(const ArmModel& arm, int joint, SixAxes six, int samples);
  [[nodiscard]] Sample sample_at(double value) const;

  SixAxes six_;
  int joint_;
  ArmJoint model_;
  Pose T_end_;  // the first joint's frame in the world; the last link's in that of the camera
  std::vector<Sample> samples_;
};

}  // namespace saccade
