// SPDX-License-Identifier: Apache-2.0
#pragma once
// Starts a program, which must answer hello.

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "saccade/devices/internal/external_process.hpp"
#include "saccade/devices/internal/ros_device.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

/// Program that has answered hello, and its answer.
template <class Answer>
struct StartedProgram {
  std::unique_ptr<ExternalProcess> process;
  Answer answer;
};

/// Runs the program and says hello.
/// @param parse converts the line of the answer to Result<Answer>
template <class Answer, class Parse>
[[nodiscard]] Result<StartedProgram<Answer>> start_program(const char* role, const ProgramConfig& config,
                                                           std::string_view hello, const Parse& parse) {
  SACCADE_CHECK(config.validate(role));
  SACCADE_TRY(const std::string command, ros_command_line(role, config.command));
  SACCADE_TRY(auto process, ExternalProcess::start({role, command, config.folder, config.cancelled}));
  const Request request{"hello", config.start_timeout_s};
  SACCADE_TRY(const std::string line, process->ask(request, hello));
  Result<Answer> answer = parse(line);
  if (!answer) return process->refused(request, answer.error());
  return StartedProgram<Answer>{std::move(process), *std::move(answer)};
}

}  // namespace saccade
