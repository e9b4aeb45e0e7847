// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages to and from programs that move joints or track a hand, docs/processes.md.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

/// Positions of a trajectory are sent this far apart.
constexpr double kFollowStep_s{0.02};

/// One line each, without its end.
[[nodiscard]] std::string joints_hello_request(const ProgramJointsConfig& config);
[[nodiscard]] std::string joints_request(std::size_t number);
[[nodiscard]] std::string follow_request(std::size_t number, const Trajectory& trajectory);
[[nodiscard]] std::string stop_request(std::size_t number);
[[nodiscard]] std::string sample_request(std::size_t number);

/// A line that a program of joints says.
struct JointAnswer {
  std::size_t number{0};  ///< request that it belongs to
  Configuration q;
  std::optional<double> t_s{};     ///< on the way: since the motion began
  std::optional<double> time_s{};  ///< on the clock of the joints
  bool done{true};                 ///< false: on the way
};

/// @param dof positions that there must be
/// Errors: as parse_answer().
[[nodiscard]] Result<JointAnswer> parse_joint_answer(std::string_view line, Eigen::Index dof);
/// nullopt: the program has no more samples.
[[nodiscard]] Result<std::optional<HandSample>> parse_sample_answer(std::string_view line, std::size_t number);

}  // namespace saccade
