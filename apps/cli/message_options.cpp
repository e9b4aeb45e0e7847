// SPDX-License-Identifier: Apache-2.0
#include "message_options.hpp"

#include <CLI/CLI.hpp>
#include <charconv>

#include "add_value.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "saccade/io/messages/mcap_writer.hpp"
#include "serve.hpp"
#include "server/foxglove/foxglove_hub.hpp"

namespace saccade::cli {
namespace {

std::optional<std::uint16_t> port_in(std::string_view text) {
  std::uint16_t port{0};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return port;
}

Result<std::unique_ptr<messages::MessageSink>> foxglove_sink(const FoxglovePlace& place) {
  server::ServerConfig config;
  config.address = place.address;
  config.port = place.port;
  config.token = server::make_token();
  config.foxglove = std::make_shared<server::FoxgloveHub>();
  config.foxglove_only = true;
  SACCADE_TRY(std::unique_ptr<server::HttpServer> server, server::HttpServer::listen(config));
  announce_foxglove(*server);
  return std::unique_ptr<messages::MessageSink>{
      std::make_unique<server::FoxgloveSink>(config.foxglove, std::move(server))};
}

}  // namespace

Result<FoxglovePlace> foxglove_place(const std::string& text) {
  FoxglovePlace place;
  if (const auto port = port_in(text)) {
    place.port = *port;
    return place;
  }
  const std::size_t colon = text.rfind(':');
  const bool has_port = colon != std::string::npos && (text.find(':') == colon || text[colon - 1] == ']');
  std::string host = has_port ? text.substr(0, colon) : text;
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const auto port = has_port ? port_in(std::string_view{text}.substr(colon + 1)) : place.port;
  const bool is_address = host == "localhost" || host.find_first_of(".:") != std::string::npos;
  if (!port || !is_address) {
    return Error{Errc::invalid_argument, "needs PORT or HOST:PORT with an address of this machine, not '" + text + "'",
                 ""};
  }
  place.address = host;
  place.port = *port;
  return place;
}

void add_message_options(CLI::App& command, MessageOptions& options) {
  add_value(command, "--record", options.record, "FILE.mcap",
            "record the run as messages of ROS 2: map, frontier, candidates, views, depth; for Foxglove and ros2 bag");
  const auto publish = [&options](const std::vector<std::string>& words) {
    for (const std::string& word : words) {
      const std::optional<RosVersion> version = kRosVersionNames.find(word);
      if (!version) usage_error("--publish", unknown_word(word, kRosVersionNames.words));
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
  const auto take = [&options](const std::vector<std::string>& given) {
    const bool has_place = !given.empty() && !given.front().empty() && given.front() != "true";
    const auto place = has_place ? foxglove_place(given.front()) : FoxglovePlace{};
    require_ok(place ? Status{} : Status{place.error()}, "--foxglove");
    options.foxglove = *place;
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--foxglove", take,
          "let Foxglove look on while the run goes on: ws://localhost:8765, or where PORT or HOST:PORT says "
          "(docs/guides/looking-at-runs.md)")
      ->expected(0, 1)
      ->type_name("[PORT|HOST:PORT]");
}

Result<std::unique_ptr<RunMessages>> run_messages(const MessageOptions& options, const PinholeCamera& camera,
                                                  ProgressBar& bar) {
  RunMessagesConfig config;
  config.frame_id = options.frame_id;
  config.failed = [&bar](const Error& error) {
    bar.warn("saccade: " + error.to_string() + "; the run goes on without it");
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
  if (options.foxglove) {
    SACCADE_TRY(std::unique_ptr<messages::MessageSink> sink, foxglove_sink(*options.foxglove));
    messages->add(std::move(sink));
  }
  return messages;
}

}  // namespace saccade::cli
