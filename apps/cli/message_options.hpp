// SPDX-License-Identifier: Apache-2.0
#pragma once
// MessageOptions: where a run goes as messages of ROS; run_messages, the recorder that sends them to a file and
// Foxglove.

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "command.hpp"
#include "saccade/devices/program_messages.hpp"
#include "saccade/io/runs/run_messages.hpp"

namespace saccade::cli {

class ProgressBar;

/// Where Foxglove may connect.
struct FoxglovePlace {
  std::string address{"127.0.0.1"};
  std::uint16_t port{8765};  ///< Foxglove's own
};

struct MessageOptions {
  std::filesystem::path record;  ///< MCAP file; empty: none
  std::string frame_id{"world"};
  std::set<RosVersion> publish;  ///< where it is published
  std::optional<FoxglovePlace> foxglove{};
};

/// Understands "9000", "0.0.0.0" and "0.0.0.0:9000", "[::1]:9000"; invalid_argument for anything else.
[[nodiscard]] Result<FoxglovePlace> foxglove_place(const std::string& text);

/// Adds --record, --publish, --frame-id and --foxglove.
void add_message_options(CLI::App& command, MessageOptions& options);

/// Opens what the options name, and says on standard error where Foxglove connects. `bar`, which outlives
/// RunMessages::finish, warns once of a sink that fails later. Errors: those of the sinks.
[[nodiscard]] Result<std::unique_ptr<RunMessages>> run_messages(const MessageOptions& options,
                                                                const PinholeCamera& camera, ProgressBar& bar);

}  // namespace saccade::cli
