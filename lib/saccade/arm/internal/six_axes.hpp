// SPDX-License-Identifier: Apache-2.0
#pragma once
// SixAxes: the closed form that fits six joints that turn.

#include <variant>

#include "saccade/arm/internal/parallel_axes.hpp"
#include "saccade/arm/internal/spherical_shoulder.hpp"
#include "saccade/arm/internal/spherical_wrist.hpp"

namespace saccade {

/// Immutable, safe for concurrent use.
class SixAxes {
 public:
  /// unsupported, saying what about the arm does not fit the most usual form.
  [[nodiscard]] static Result<SixAxes> find(const ArmModel& arm);

  /// Whether axes meet, and are parallel, to the last digits. If not, solutions are near ones, to be refined.
  [[nodiscard]] bool is_exact() const;
  /// All solutions in which every angle, give or take whole turns, is within its limits.
  [[nodiscard]] ClosedFormSolutions solve(const Pose& T_world_camera, const Configuration& reference) const;

 private:
  using Form = std::variant<SphericalWrist, ParallelAxes, SphericalShoulder>;
  explicit SixAxes(Form form) : form_{std::move(form)} {}
  Form form_;
};

}  // namespace saccade
