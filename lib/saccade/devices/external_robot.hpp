// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExternalRobot: a robot behind a program of the user's, docs/processes.md.

#include <memory>
#include <string>

#include "saccade/core/result.hpp"
#include "saccade/robot/robot.hpp"

namespace saccade {

class ExternalProcess;

struct ExternalRobotConfig {
  std::string command;           ///< as a shell would run it
  double start_timeout_s{30.0};  ///< until it has said that it is ready
  double move_timeout_s{60.0};

  [[nodiscard]] Status validate() const;
};

/// One caller at a time. Destroying it ends the program, as ExternalProcess does.
class ExternalRobot final : public Robot {
 public:
  /// Starts the program and waits until it is ready. Errors as ExternalCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ExternalRobot>> start(const ExternalRobotConfig& config);
  ~ExternalRobot() override;

  /// The first pose: the program finds its own way, or declines when it is asked to go.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) override;
  /// unavailable: the robot reports an error, and may be asked again. Any other error is final.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) override;
  /// Why the last pose was not reached, in the robot's words; empty without any.
  [[nodiscard]] const std::string& why_not_reached() const { return why_not_reached_; }

 private:
  ExternalRobot(ExternalRobotConfig config, std::unique_ptr<ExternalProcess> process);

  ExternalRobotConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::string why_not_reached_;
  std::size_t asked_{0};
};

}  // namespace saccade
