// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/six_axes.hpp"

#include <utility>

namespace saccade {

Result<SixAxes> SixAxes::find(const ArmModel& arm) {
  auto wrist = SphericalWrist::find(arm);
  if (wrist) return SixAxes{*std::move(wrist)};
  if (auto parallel = ParallelAxes::find(arm)) return SixAxes{*std::move(parallel)};
  if (auto shoulder = SphericalShoulder::find(arm)) return SixAxes{*std::move(shoulder)};
  return wrist.error();
}

bool SixAxes::is_exact() const {
  return std::visit([](const auto& form) { return form.is_exact(); }, form_);
}

ClosedFormSolutions SixAxes::solve(const Pose& T_world_camera, const Configuration& reference) const {
  return std::visit([&](const auto& form) { return form.solve(T_world_camera, reference); }, form_);
}

}  // namespace saccade
