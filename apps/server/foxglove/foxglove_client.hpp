// SPDX-License-Identifier: Apache-2.0
#pragma once
// FoxgloveClient: protocol state of one client of the Foxglove WebSocket protocol, without its socket.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade::server {

struct FoxgloveMessage {
  std::uint64_t time_ns{0};
  std::vector<std::byte> content;
};
using SharedFoxgloveMessage = std::shared_ptr<const FoxgloveMessage>;

struct FoxgloveChannel {
  std::uint32_t id{0};
  std::string topic;
  std::string schema_name;  ///< as in ROS 2: sensor_msgs/msg/PointCloud2
  std::string schema;       ///< text of the definition
  SharedFoxgloveMessage newest{};
};

/// WebSocket message: `head`, then the content of `message`, if there is one.
struct FoxgloveFrame {
  bool is_text{true};
  std::string head;
  SharedFoxgloveMessage message{};
};

/// Returns the server's choice among the subprotocols that a client offers (header Sec-WebSocket-Protocol): the first
/// of foxglove.sdk.v1 and foxglove.websocket.v1, which have equal messages here. Empty where there is none.
[[nodiscard]] std::string_view foxglove_subprotocol(std::string_view offered);

/// Client with at most one waiting message per channel: a newer one replaces an unread one. Sends the newest message of
/// a channel on subscription.
class FoxgloveClient {
 public:
  /// Begins with the server's description and its channels.
  FoxgloveClient(const std::string& session, std::span<const FoxgloveChannel> channels);

  void advertise(const FoxgloveChannel& channel);
  /// Handles a message of the client. Errors in it become one status message.
  void received(bool is_text, std::string_view message, std::span<const FoxgloveChannel> channels);
  /// Queues a message for a client that has subscribed to its channel.
  void send(std::uint32_t channel, const SharedFoxgloveMessage& message);

  /// Returns what to write next; texts precede messages.
  [[nodiscard]] std::optional<FoxgloveFrame> next();
  [[nodiscard]] bool is_idle() const { return texts_.empty() && waiting_.empty(); }
  /// Returns false for a client that does not read the answers to its requests.
  [[nodiscard]] bool may_read() const;

 private:
  struct Waiting {
    std::uint32_t channel{0};
    SharedFoxgloveMessage message;
  };
  struct Wrong {
    int level{2};  ///< 1: warning, 2: error
    std::string text;
  };

  [[nodiscard]] std::optional<Wrong> answer(std::string_view text, std::span<const FoxgloveChannel> channels);
  [[nodiscard]] std::optional<Wrong> subscribe(std::uint32_t subscription, std::uint32_t channel,
                                               std::span<const FoxgloveChannel> channels);
  [[nodiscard]] std::optional<Wrong> unsubscribe(std::uint32_t subscription);

  std::deque<std::string> texts_;
  std::deque<Waiting> waiting_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  ///< by channel
};

}  // namespace saccade::server
