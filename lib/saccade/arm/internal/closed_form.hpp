// SPDX-License-Identifier: Apache-2.0
#pragma once
// ClosedForm: the closed form that fits an arm, of six joints or of seven.

#include <array>
#include <cstddef>
#include <variant>

#include "saccade/arm/internal/held_joint.hpp"
#include "saccade/arm/internal/six_axes.hpp"
#include "saccade/arm/internal/swivel_elbow.hpp"
#include "saccade/arm/inverse_kinematics.hpp"

namespace saccade {

/// SixAxes, or for seven joints SwivelElbow, else HeldJoint. Immutable, safe for concurrent use.
class ClosedForm {
 public:
  /// unsupported, saying what about the arm does not fit. Expects one sample at least.
  [[nodiscard]] static Result<ClosedForm> find(const ArmModel& arm, int redundancy_samples);

  /// Whether axes meet, and are parallel, to the last digits. If not, solutions are near ones, to be refined.
  [[nodiscard]] bool is_exact() const;
  [[nodiscard]] IkRedundancy redundancy() const;
  /// How often solve() must be asked for all solutions: once, or for each value of what a pose leaves open.
  [[nodiscard]] std::size_t rounds() const;

  struct Solutions {
    std::array<Configuration, 8> q;  ///< the first `count` are set
    std::size_t count{0};
  };
  /// One round. All its solutions in which every angle, give or take whole turns, is within its limits.
  [[nodiscard]] Solutions solve(const Pose& T_world_camera, const Configuration& reference, std::size_t round) const;

 private:
  using Form = std::variant<SixAxes, SwivelElbow, HeldJoint>;
  explicit ClosedForm(Form form) : form_{std::move(form)} {}
  Form form_;
};

}  // namespace saccade
