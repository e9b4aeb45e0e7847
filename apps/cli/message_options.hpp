// SPDX-License-Identifier: Apache-2.0
#pragma once
// MessageOptions: where a run goes as messages of ROS; run_messages, the recorder that sends them.

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "command.hpp"
#include "saccade/devices/program_messages.hpp"
#include "saccade/io/runs/run_messages.hpp"

namespace saccade::cli {

struct MessageOptions {
  std::filesystem::path record;  ///< MCAP file; empty: none
  std::string frame_id{"world"};
  std::set<RosVersion> publish;  ///< where it is published
};

/// Adds --record, --publish and --frame-id.
void add_message_options(CLI::App& command, MessageOptions& options);

/// Opens what the options name; a sink that fails later is said once on stderr. Errors: those of the sinks.
[[nodiscard]] Result<std::unique_ptr<RunMessages>> run_messages(const MessageOptions& options,
                                                                const PinholeCamera& camera);

}  // namespace saccade::cli
