// SPDX-License-Identifier: Apache-2.0
#pragma once
// SixAxes: the closed-form solution for six revolute joints.

#include <variant>

#include "saccade/arm/internal/parallel_axes.hpp"
#include "saccade/arm/internal/spherical_shoulder.hpp"
#include "saccade/arm/internal/spherical_wrist.hpp"

namespace saccade {

/// Closed form of six joints. Immutable, safe for concurrent use.
class SixAxes {
 public:
  /// Answers unsupported, naming the property of the arm that does not fit the most usual form.
  [[nodiscard]] static Result<SixAxes> find(const ArmModel& arm);

  /// Tells whether axes meet, and are parallel, to the last digits. If not, solutions are approximate and need
  /// refinement.
  [[nodiscard]] bool is_exact() const;
  /// Returns all solutions in which every angle, up to whole turns, is within its limits.
  [[nodiscard]] ClosedFormSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  using Form = std::variant<SphericalWrist, ParallelAxes, SphericalShoulder>;
  explicit SixAxes(Form form) : form_{std::move(form)} {}
  Form form_;
};

}  // namespace saccade
