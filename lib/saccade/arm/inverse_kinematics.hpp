// SPDX-License-Identifier: Apache-2.0
#pragma once
// InverseKinematics: the configurations that bring the camera to a pose; in closed form where the arm allows it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"

namespace saccade {

enum class IkMethod {
  automatic,    ///< closed form where it applies, otherwise numeric
  closed_form,  ///< SixAxes, SwivelElbow, HeldJoint
  numeric,      ///< NumericIk
};
inline constexpr auto kIkMethodNames = make_names<IkMethod>(
    {{IkMethod::automatic, "automatic"}, {IkMethod::closed_form, "closed form"}, {IkMethod::numeric, "numeric"}});
[[nodiscard]] constexpr std::string_view to_string(IkMethod method) { return kIkMethodNames.of(method); }

/// Degree of freedom that a pose leaves open in closed form, to be sampled (IkConfig::redundancy_samples).
enum class IkRedundancy {
  none,         ///< six joints
  last_joint,   ///< angle of the last joint: HeldJoint
  first_joint,  ///< angle or position of the first joint: HeldJoint
  swivel,       ///< rotation of the elbow about the line from shoulder to wrist: SwivelElbow
};
inline constexpr auto kIkRedundancyNames = make_names<IkRedundancy>({{IkRedundancy::none, "none"},
                                                                     {IkRedundancy::last_joint, "last joint"},
                                                                     {IkRedundancy::first_joint, "first joint"},
                                                                     {IkRedundancy::swivel, "swivel"}});
[[nodiscard]] constexpr std::string_view to_string(IkRedundancy redundancy) {
  return kIkRedundancyNames.of(redundancy);
}

/// Largest error of a solution: metres, and radians.
constexpr double kIkTolerance{1e-9};

/// Parameters of NumericIk, which iterates from many starts.
struct NumericIkConfig {
  int restarts{100};          ///< starts in addition to the reference, drawn within the limits
  int max_solutions{1};       ///< stops at this number of solutions that differ by more than distinct_rad in some joint
  int iterations{60};         ///< limit per start
  double distinct_rad{0.05};  ///< rad; m for prismatic joints
  std::uint64_t seed{1};

  [[nodiscard]] Status validate() const;
};

struct IkConfig {
  IkMethod method{IkMethod::automatic};
  /// Closed form: largest number of whole turns returned for a joint whose limits hold several, nearest to the
  /// reference first. Two cover every turn of a joint with less than ±2π; a wrist of ±47 rad alone has fifteen.
  int max_turns{2};
  /// Closed form of seven joints: samples of the free value (InverseKinematics::redundancy), spread evenly over the
  /// joint's limits or one turn. They follow the reference's own value.
  int redundancy_samples{24};
  NumericIkConfig numeric;
};

/// Solutions of many poses, contiguous.
struct IkTable {
  int dof{0};
  std::vector<std::size_t> first;  ///< first solution of each pose, then the end: poses + 1 entries
  std::vector<double> values;      ///< dof per solution

  [[nodiscard]] std::size_t poses() const { return first.empty() ? 0 : first.size() - 1; }
  [[nodiscard]] std::size_t solutions() const { return first.empty() ? 0 : first.back(); }
  [[nodiscard]] std::size_t count(std::size_t pose) const { return first[pose + 1] - first[pose]; }
  /// Returns the i-th solution of a pose.
  [[nodiscard]] Configuration solution(std::size_t pose, std::size_t i) const;
};

/// Inverse kinematics of an arm. Immutable, cheap to copy, safe for concurrent use.
class InverseKinematics {
 public:
  /// Creates the solver. Answers invalid_argument for a bad configuration; unsupported, with the reason, where the
  /// closed form is requested and does not apply.
  [[nodiscard]] static Result<InverseKinematics> create(ArmModel arm, const IkConfig& config = {});

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  /// Returns closed_form or numeric.
  [[nodiscard]] IkMethod method() const;
  /// Returns the value that a pose leaves open in closed form.
  [[nodiscard]] IkRedundancy redundancy() const;
  /// Tells whether closed-form solutions are refined, because the arm's axes meet or are parallel only approximately,
  /// as after rounding.
  [[nodiscard]] bool refines() const;
  /// Returns why there is no closed form; empty where there is one or none was sought.
  [[nodiscard]] const std::string& why_numeric() const { return why_numeric_; }

  /// Returns all solutions within the limits (closed form; with seven joints: those with one of the sampled values), or
  /// those that were found (numeric). Each is within kIkTolerance of the pose by forward kinematics. The reference
  /// settles values that a pose leaves open: singular joints, whole turns, the first of the sampled values, the numeric
  /// start. It defaults to the arm's middle. An empty result is a valid answer.
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera) const;
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera, const Configuration& reference) const;

  /// Tells whether a solution satisfies `passes`. Tries them in the order of solve(), and searches no further than
  /// needed.
  [[nodiscard]] bool any_of(const Pose& T_world_camera, const Configuration& reference,
                            const std::function<bool(const Configuration&)>& passes) const;
  /// As any_of(), for what depends on the arm's shape alone, such as collisions: of solutions that differ by whole
  /// turns of joints, which can be 128 with seven joints of ±2π, only the one nearest to the reference is tried (closed
  /// form).
  [[nodiscard]] bool any_shape_of(const Pose& T_world_camera, const Configuration& reference,
                                  const std::function<bool(const Configuration&)>& passes) const;

  /// Calls solve() for many poses. The thread count never changes a bit of the result.
  [[nodiscard]] IkTable solve_all(std::span<const Pose> T_world_camera, const Configuration& reference,
                                  const Executor& executor) const;

 private:
  struct Solvers;
  InverseKinematics(std::shared_ptr<const ArmModel> arm, int max_turns) : arm_{std::move(arm)}, max_turns_{max_turns} {}
  [[nodiscard]] bool any_of(const Pose& T_world_camera, const Configuration& reference, int max_turns,
                            const std::function<bool(const Configuration&)>& passes) const;
  /// Appends a solution, refined where necessary, in every whole turn requested.
  void append(const Pose& T_world_camera, const Configuration& reference, Configuration near, int max_turns,
              std::vector<Configuration>& solutions) const;
  void append(const Pose& T_world_camera, const Configuration& reference, std::vector<Configuration>& solutions) const;

  std::shared_ptr<const ArmModel> arm_;
  int max_turns_;
  std::shared_ptr<const Solvers> solvers_;
  std::string why_numeric_;
};

}  // namespace saccade
