// SPDX-License-Identifier: Apache-2.0
#pragma once
// ClosedForm: the closed-form solution for an arm of six or seven joints.

#include <array>
#include <cstddef>
#include <variant>

#include "saccade/arm/internal/held_joint.hpp"
#include "saccade/arm/internal/six_axes.hpp"
#include "saccade/arm/internal/swivel_elbow.hpp"
#include "saccade/arm/inverse_kinematics.hpp"

namespace saccade {

/// Closed form: SixAxes, or for seven joints SwivelElbow, otherwise HeldJoint. Immutable, safe for concurrent use.
class ClosedForm {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit. Expects at least one sample.
  [[nodiscard]] static Result<ClosedForm> find(const ArmModel& arm, int redundancy_samples);

  /// Tells whether axes meet, and are parallel, to the last digits. If not, solutions are approximate and need
  /// refinement.
  [[nodiscard]] bool is_exact() const;
  [[nodiscard]] IkRedundancy redundancy() const;
  /// Returns the number of calls of solve() needed for all solutions: one, or one per value of the free parameter.
  [[nodiscard]] std::size_t rounds() const;

  struct Solutions {
    std::array<Configuration, 8> q;  ///< the first `count` are set
    std::size_t count{0};
  };
  /// Solves one round. Returns all its solutions in which every angle, up to whole turns, is within its limits.
  [[nodiscard]] Solutions solve(const Pose& T_world_camera, const Configuration& reference, std::size_t round) const;

 private:
  using Form = std::variant<SixAxes, SwivelElbow, HeldJoint>;
  explicit ClosedForm(Form form) : form_{std::move(form)} {}
  Form form_;
};

}  // namespace saccade
