// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "saccade/devices/internal/joint_messages.hpp"
#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/devices/internal/program.hpp"
#include "saccade/devices/programs.hpp"

namespace saccade {

ProgramHand::ProgramHand(ProgramConfig config, std::unique_ptr<ExternalProcess> process)
    : config_{std::move(config)}, process_{std::move(process)} {}
ProgramHand::~ProgramHand() = default;

Result<std::unique_ptr<ProgramHand>> ProgramHand::start(const ProgramConfig& config) {
  SACCADE_TRY(auto started, start_program<Ready>("hand", config, hello_request("hand"), parse_ready));
  return std::unique_ptr<ProgramHand>{new ProgramHand{config, std::move(started.process)}};
}

Result<std::optional<HandSample>> ProgramHand::next() {
  const std::size_t number = asked_++;
  const Request request{"sample " + std::to_string(number), config_.timeout_s};
  SACCADE_TRY(const std::string line, process_->ask(request, sample_request(number)));
  auto answer = parse_sample_answer(line, number);
  if (!answer) return process_->refused(request, answer.error());
  return *answer;
}

}  // namespace saccade
