// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/closed_form.hpp"

#include <utility>

namespace saccade {

Result<ClosedForm> ClosedForm::find(const ArmModel& arm, int redundancy_samples) {
  if (arm.dof() == 7) {
    if (auto swivel = SwivelElbow::find(arm, redundancy_samples)) return ClosedForm{*std::move(swivel)};
    SACCADE_TRY(HeldJoint held, HeldJoint::find(arm, redundancy_samples));
    return ClosedForm{std::move(held)};
  }
  SACCADE_TRY(SixAxes six, SixAxes::find(arm));
  return ClosedForm{std::move(six)};
}

bool ClosedForm::is_exact() const {
  return std::visit([](const auto& form) { return form.is_exact(); }, form_);
}

IkRedundancy ClosedForm::redundancy() const {
  if (std::holds_alternative<SwivelElbow>(form_)) return IkRedundancy::swivel;
  const auto* held = std::get_if<HeldJoint>(&form_);
  if (held == nullptr) return IkRedundancy::none;
  return held->joint() == 0 ? IkRedundancy::first_joint : IkRedundancy::last_joint;
}

std::size_t ClosedForm::rounds() const {
  if (const auto* swivel = std::get_if<SwivelElbow>(&form_)) return swivel->rounds();
  const auto* held = std::get_if<HeldJoint>(&form_);
  return held == nullptr ? 1 : held->rounds();
}

ClosedForm::Solutions ClosedForm::solve(const Pose& T_world_camera, const Configuration& reference,
                                        std::size_t round) const {
  Solutions solutions;
  const auto take = [&solutions](const auto& found) {
    for (; solutions.count < found.count; ++solutions.count) solutions.q[solutions.count] = found.q[solutions.count];
  };
  if (const auto* six = std::get_if<SixAxes>(&form_)) take(six->solve(T_world_camera, reference));
  if (const auto* swivel = std::get_if<SwivelElbow>(&form_)) take(swivel->solve(T_world_camera, reference, round));
  if (const auto* held = std::get_if<HeldJoint>(&form_)) take(held->solve(T_world_camera, reference, round));
  return solutions;
}

}  // namespace saccade
