// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/inverse_kinematics.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "saccade/arm/internal/closed_form.hpp"
#include "saccade/arm/internal/joint_turns.hpp"
#include "saccade/arm/internal/numeric_ik.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

/// Poses per chunk of work: about a millisecond.
constexpr std::size_t kGrain{512};

bool meets(const Pose& T_world_a, const Pose& T_world_b) {
  // ‖Ra − Rb‖ (Frobenius) is √2 times the angle between them, where it is small.
  return (T_world_a.translation() - T_world_b.translation()).norm() <= kIkTolerance &&
         (T_world_a.linear() - T_world_b.linear()).norm() <= kIkTolerance;
}

}  // namespace

Configuration IkTable::solution(std::size_t pose, std::size_t i) const {
  SACCADE_EXPECTS(pose < poses() && i < count(pose));
  const std::size_t at = (first[pose] + i) * static_cast<std::size_t>(dof);
  return Eigen::Map<const Eigen::VectorXd>{values.data() + at, dof};
}

struct InverseKinematics::Solvers {
  std::optional<ClosedForm> closed_form;
  NumericIk numeric;
};

Result<InverseKinematics> InverseKinematics::create(ArmModel arm, const IkConfig& config) {
  if (config.max_turns < 1) return Error{Errc::invalid_argument, "max_turns must be at least one", ""};
  if (config.redundancy_samples < 1)
    return Error{Errc::invalid_argument, "redundancy_samples must be at least one", ""};
  const auto shared = std::make_shared<const ArmModel>(std::move(arm));
  SACCADE_TRY(NumericIk numeric, NumericIk::create(shared, config.numeric));
  InverseKinematics ik{shared, config.max_turns};
  Solvers solvers{std::nullopt, std::move(numeric)};
  if (config.method != IkMethod::numeric) {
    auto closed_form = ClosedForm::find(*shared, config.redundancy_samples);
    if (closed_form) {
      solvers.closed_form = *std::move(closed_form);
    } else if (config.method == IkMethod::closed_form) {
      return closed_form.error();
    } else {
      ik.why_numeric_ = closed_form.error().message;
    }
  }
  ik.solvers_ = std::make_shared<const Solvers>(std::move(solvers));
  return ik;
}

IkMethod InverseKinematics::method() const { return solvers_->closed_form ? IkMethod::closed_form : IkMethod::numeric; }

IkRedundancy InverseKinematics::redundancy() const {
  return solvers_->closed_form ? solvers_->closed_form->redundancy() : IkRedundancy::none;
}

bool InverseKinematics::refines() const { return solvers_->closed_form && !solvers_->closed_form->is_exact(); }

void InverseKinematics::append(const Pose& T_world_camera, const Configuration& reference, Configuration near,
                               int max_turns, std::vector<Configuration>& solutions) const {
  if (!meets(camera_pose(*arm_, near), T_world_camera) && !refine(*arm_, T_world_camera, near)) return;
  append_turns(*arm_, near, reference, max_turns, solutions);
}

void InverseKinematics::append(const Pose& T_world_camera, const Configuration& reference,
                               std::vector<Configuration>& solutions) const {
  const auto& form = solvers_->closed_form;
  if (!form) {
    for (const Configuration& q : solvers_->numeric.solve(T_world_camera, reference)) solutions.push_back(q);
    return;
  }
  for (std::size_t round = 0; round < form->rounds(); ++round) {
    const ClosedForm::Solutions found = form->solve(T_world_camera, reference, round);
    for (std::size_t i = 0; i < found.count; ++i) append(T_world_camera, reference, found.q[i], max_turns_, solutions);
  }
}

bool InverseKinematics::any_of(const Pose& T_world_camera, const Configuration& reference,
                               const std::function<bool(const Configuration&)>& passes) const {
  return any_of(T_world_camera, reference, max_turns_, passes);
}

bool InverseKinematics::any_shape_of(const Pose& T_world_camera, const Configuration& reference,
                                     const std::function<bool(const Configuration&)>& passes) const {
  return any_of(T_world_camera, reference, 1, passes);
}

bool InverseKinematics::any_of(const Pose& T_world_camera, const Configuration& reference, int max_turns,
                               const std::function<bool(const Configuration&)>& passes) const {
  SACCADE_EXPECTS(reference.size() == arm_->dof());
  const auto& form = solvers_->closed_form;
  if (!form) {
    const std::vector<Configuration> found = solvers_->numeric.solve(T_world_camera, reference);
    return std::any_of(found.begin(), found.end(), std::cref(passes));
  }
  std::vector<Configuration> turns;
  for (std::size_t round = 0; round < form->rounds(); ++round) {
    const ClosedForm::Solutions found = form->solve(T_world_camera, reference, round);
    for (std::size_t i = 0; i < found.count; ++i) {
      turns.clear();
      append(T_world_camera, reference, found.q[i], max_turns, turns);
      if (std::any_of(turns.begin(), turns.end(), std::cref(passes))) return true;
    }
  }
  return false;
}

std::vector<Configuration> InverseKinematics::solve(const Pose& T_world_camera) const {
  return solve(T_world_camera, arm_->middle());
}

std::vector<Configuration> InverseKinematics::solve(const Pose& T_world_camera, const Configuration& reference) const {
  SACCADE_EXPECTS(reference.size() == arm_->dof());
  std::vector<Configuration> solutions;
  append(T_world_camera, reference, solutions);
  return solutions;
}

IkTable InverseKinematics::solve_all(std::span<const Pose> T_world_camera, const Configuration& reference,
                                     const Executor& executor) const {
  SACCADE_EXPECTS(reference.size() == arm_->dof());
  const std::size_t poses = T_world_camera.size();
  IkTable table;
  table.dof = arm_->dof();
  table.first.assign(poses + 1, 0);
  std::vector<std::vector<double>> parts((poses + kGrain - 1) / kGrain);
  executor.parallel_for(poses, kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<double>& part = parts[begin / kGrain];
    std::vector<Configuration> solutions;
    for (std::size_t i = begin; i < end; ++i) {
      solutions.clear();
      append(T_world_camera[i], reference, solutions);
      table.first[i + 1] = solutions.size();
      for (const Configuration& q : solutions) part.insert(part.end(), q.data(), q.data() + q.size());
    }
  });
  for (std::size_t i = 0; i < poses; ++i) table.first[i + 1] += table.first[i];
  table.values.reserve(table.solutions() * static_cast<std::size_t>(table.dof));
  for (const std::vector<double>& part : parts) table.values.insert(table.values.end(), part.begin(), part.end());
  return table;
}

}  // namespace saccade
