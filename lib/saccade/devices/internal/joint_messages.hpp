// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages to and from programs that move joints or track a hand, docs/guides/processes.md.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

/// Interval at which positions of a trajectory are sent.
constexpr double kFollowStep_s{0.02};

/// Requests of one line each, without its end.
[[nodiscard]] std::string joints_hello_request(const ProgramJointsConfig& config);
[[nodiscard]] std::string joints_request(std::size_t number);
[[nodiscard]] std::string follow_request(std::size_t number, const Trajectory& trajectory);
[[nodiscard]] std::string stop_request(std::size_t number);
[[nodiscard]] std::string sample_request(std::size_t number);

/// Line from a program of joints.
struct JointAnswer {
  std::size_t number{0};  ///< request that it belongs to
  Configuration q;
  std::optional<double> t_s{};     ///< during a motion: time since it began
  std::optional<double> time_s{};  ///< on the clock of the joints
  bool done{true};                 ///< false: during a motion
};

/// @param dof expected number of positions. Errors: as parse_answer().
[[nodiscard]] Result<JointAnswer> parse_joint_answer(std::string_view line, Eigen::Index dof);
/// Returns the sample; nullopt: the program has no more samples.
[[nodiscard]] Result<std::optional<HandSample>> parse_sample_answer(std::string_view line, std::size_t number);

}  // namespace saccade
