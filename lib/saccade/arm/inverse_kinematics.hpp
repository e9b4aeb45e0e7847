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
  automatic,    ///< closed form where it applies, else numeric
  closed_form,  ///< SixAxes, SwivelElbow, HeldJoint
  numeric,      ///< NumericIk
};
inline constexpr auto kIkMethodNames = make_names<IkMethod>(
    {{IkMethod::automatic, "automatic"}, {IkMethod::closed_form, "closed form"}, {IkMethod::numeric, "numeric"}});
[[nodiscard]] constexpr std::string_view to_string(IkMethod method) { return kIkMethodNames.of(method); }

/// What a pose leaves open in closed form, and what is therefore given values (IkConfig::redundancy_samples).
enum class IkRedundancy {
  none,         ///< six joints
  last_joint,   ///< its angle: HeldJoint
  first_joint,  ///< its angle or way: HeldJoint
  swivel,       ///< the elbow's turn about the line from shoulder to wrist: SwivelElbow
};
inline constexpr auto kIkRedundancyNames = make_names<IkRedundancy>({{IkRedundancy::none, "none"},
                                                                     {IkRedundancy::last_joint, "last joint"},
                                                                     {IkRedundancy::first_joint, "first joint"},
                                                                     {IkRedundancy::swivel, "swivel"}});
[[nodiscard]] constexpr std::string_view to_string(IkRedundancy redundancy) {
  return kIkRedundancyNames.of(redundancy);
}

/// What a solution may miss its pose by: metres, and radians.
constexpr double kIkTolerance{1e-9};

/// NumericIk, by iteration from many starts.
struct NumericIkConfig {
  int restarts{100};          ///< starts besides the reference, drawn within the limits
  int max_solutions{1};       ///< stops when it has found so many that differ by more than distinct_rad in some joint
  int iterations{60};         ///< of each start, at most
  double distinct_rad{0.05};  ///< rad; m for prismatic joints
  std::uint64_t seed{1};

  [[nodiscard]] Status validate() const;
};

struct IkConfig {
  IkMethod method{IkMethod::automatic};
  /// Closed form: a joint whose limits hold several whole turns of an angle is given in so many of them at most, those
  /// nearest to the reference. Two hold every turn of a joint with less than ±2π; a wrist of ±47 rad alone has fifteen.
  int max_turns{2};
  /// Closed form of seven joints: values of what a pose leaves open (InverseKinematics::redundancy), spread evenly over
  /// the joint's limits or one turn. They come after the reference's own.
  int redundancy_samples{24};
  NumericIkConfig numeric;
};

/// Solutions of many poses, one after the other.
struct IkTable {
  int dof{0};
  std::vector<std::size_t> first;  ///< of each pose, and the end: poses + 1 entries
  std::vector<double> values;      ///< dof per solution

  [[nodiscard]] std::size_t poses() const { return first.empty() ? 0 : first.size() - 1; }
  [[nodiscard]] std::size_t solutions() const { return first.empty() ? 0 : first.back(); }
  [[nodiscard]] std::size_t count(std::size_t pose) const { return first[pose + 1] - first[pose]; }
  /// The i-th solution of a pose.
  [[nodiscard]] Configuration solution(std::size_t pose, std::size_t i) const;
};

/// Immutable, cheap to copy, safe for concurrent use.
class InverseKinematics {
 public:
  /// invalid_argument for a bad configuration; unsupported, with the reason, where the closed form is asked for and
  /// does not apply.
  [[nodiscard]] static Result<InverseKinematics> create(ArmModel arm, const IkConfig& config = {});

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  /// closed_form or numeric.
  [[nodiscard]] IkMethod method() const;
  /// What a pose leaves open in closed form.
  [[nodiscard]] IkRedundancy redundancy() const;
  /// Whether the closed form is refined, because the arm's axes only nearly meet or are parallel, as after rounding.
  [[nodiscard]] bool refines() const;
  /// Why there is no closed form; empty where there is one or none was looked for.
  [[nodiscard]] const std::string& why_numeric() const { return why_numeric_; }

  /// All solutions within the limits (closed form; of seven joints: those with one of the sampled values),
  /// or those that were found (numeric), each within kIkTolerance of the pose by forward kinematics. The reference
  /// settles what a pose leaves open: singular joints, whole turns, the first of the sampled values, the numeric
  /// start; it is the arm's middle where it is left out. No solution is a valid answer.
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera) const;
  [[nodiscard]] std::vector<Configuration> solve(const Pose& T_world_camera, const Configuration& reference) const;

  /// Whether some solution passes. They are tried in the order of solve(), and no more are looked for than it takes.
  [[nodiscard]] bool any_of(const Pose& T_world_camera, const Configuration& reference,
                            const std::function<bool(const Configuration&)>& passes) const;

  /// solve() for many poses. The thread count never changes a bit of the result.
  [[nodiscard]] IkTable solve_all(std::span<const Pose> T_world_camera, const Configuration& reference,
                                  const Executor& executor) const;

 private:
  struct Solvers;
  InverseKinematics(std::shared_ptr<const ArmModel> arm, int max_turns) : arm_{std::move(arm)}, max_turns_{max_turns} {}
  /// Refined where it must be, in every turn that is asked for.
  void append(const Pose& T_world_camera, const Configuration& reference, Configuration near,
              std::vector<Configuration>& solutions) const;
  void append(const Pose& T_world_camera, const Configuration& reference, std::vector<Configuration>& solutions) const;

  std::shared_ptr<const ArmModel> arm_;
  int max_turns_;
  std::shared_ptr<const Solvers> solvers_;
  std::string why_numeric_;
};

}  // namespace saccade
