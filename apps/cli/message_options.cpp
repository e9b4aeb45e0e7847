// SPDX-License-Identifier: Apache-2.0
#include "message_options.hpp"

#include <iostream>

#include "add_value.hpp"
#include "options.hpp"
#include "saccade/io/messages/mcap_writer.hpp"

namespace saccade::cli {

void add_message_options(CLI::App& command, MessageOptions& options) {
  add_value(command, "--record", options.record, "FILE.mcap",
            "record the run as messages of ROS 2: map, frontier, candidates, views, depth; for Foxglove and ros2 bag");
  const auto publish = [&options](const std::vector<std::string>& words) {
    for (const std::string& word : words) {
      const std::optional<RosVersion> version = kRosVersionNames.find(word);
      if (!version) usage_error("--publish", "must be " + kRosVersionNames.listed() + ", not '" + word + "'");
      options.publish.insert(*version);
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--publish", publish, "publish the run for RViz: over ROS 1 (ros), over ROS 2 (ros2), or both (ros,ros2)")
      ->type_name("ros|ros2")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_value(command, "--frame-id", options.frame_id, "NAME", "frame of the world in messages");
}

Result<std::unique_ptr<RunMessages>> run_messages(const MessageOptions& options, const PinholeCamera& camera) {
  RunMessagesConfig config;
  config.frame_id = options.frame_id;
  config.failed = [](const Error& error) {
    std::cerr << "saccade: " << error.to_string() << "; the run goes on without it" << std::endl;
  };
  auto messages = std::make_unique<RunMessages>(std::move(config), camera);
  if (!options.record.empty()) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(options.record, ignored)) {  // an earlier recording, perhaps of this very run
      return Error{Errc::io_failure, "there is a recording already; remove it, or choose another name",
                   options.record.string()};
    }
    SACCADE_TRY(messages::McapWriter file, messages::McapWriter::create(options.record));
    messages->add(std::make_unique<messages::McapWriter>(std::move(file)));
  }
  for (const RosVersion version : options.publish) {
    SACCADE_TRY(std::string program, publisher_command(version));
    SACCADE_TRY(auto published, ProgramMessages::start({std::move(program), wire_of(version)}));
    messages->add(std::move(published));
  }
  return messages;
}

}  // namespace saccade::cli
