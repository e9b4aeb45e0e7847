// SPDX-License-Identifier: Apache-2.0
// Feeds what clients of Foxglove say, a line each, to one client; a line that begins with ! is a message of the run.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "server/foxglove/foxglove_client.hpp"

namespace {

using namespace saccade::server;

void require(bool condition) {
  if (!condition) std::abort();
}

/// Reads all that waits for the client. Texts are JSON; messages are whole, and of one channel each.
std::size_t read_all(FoxgloveClient& client) {
  std::size_t messages = 0;
  while (const auto frame = client.next()) {
    if (frame->is_text) {
      require(nlohmann::json::parse(frame->head, nullptr, false).contains("op") && !frame->message);
    } else {
      require(frame->head.size() == 13 && frame->head.front() == 1 && frame->message != nullptr);
      ++messages;
    }
  }
  require(client.is_idle() && client.may_read());
  return messages;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = std::make_shared<const FoxgloveMessage>();
  const std::vector<FoxgloveChannel> channels{{1, "/map", "a/msg/B", "int32 x", message},
                                              {2, "/tf", "a/msg/C", "", {}}};
  FoxgloveClient client{"fuzz", channels};
  read_all(client);
  std::string_view rest{reinterpret_cast<const char*>(data), size};
  static_cast<void>(foxglove_subprotocol(rest));
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.starts_with('!')) {
      for (const FoxgloveChannel& channel : channels) client.send(channel.id, message);
    } else {
      client.received(!line.starts_with('#'), line, channels);
    }
    require(read_all(client) <= channels.size());
  }
  return 0;
}
