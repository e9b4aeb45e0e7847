// SPDX-License-Identifier: Apache-2.0
#pragma once
// FoxgloveClient: what one client of the Foxglove WebSocket protocol has asked and is to be told, without its socket.

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

/// A message of the WebSocket: `head`, then the content of `message`, if there is one.
struct FoxgloveFrame {
  bool is_text{true};
  std::string head;
  SharedFoxgloveMessage message{};
};

/// The subprotocol that a server answers to those that a client offers (header Sec-WebSocket-Protocol): the first of
/// foxglove.sdk.v1 and foxglove.websocket.v1, which have the same messages here. Empty where there is none.
[[nodiscard]] std::string_view foxglove_subprotocol(std::string_view offered);

/// Keeps at most one message of each channel: a newer one takes the place of one that the client has not read. Sends
/// the newest message of a channel as soon as it is subscribed to.
class FoxgloveClient {
 public:
  /// Begins with what the server is and the channels that it has.
  FoxgloveClient(const std::string& session, std::span<const FoxgloveChannel> channels);

  void advertise(const FoxgloveChannel& channel);
  /// Takes a message that the client has sent. What is wrong with it becomes one status message.
  void received(bool is_text, std::string_view message, std::span<const FoxgloveChannel> channels);
  /// Queues a message for a client that has subscribed to its channel.
  void send(std::uint32_t channel, const SharedFoxgloveMessage& message);

  /// Takes what is to be written next; texts go before messages.
  [[nodiscard]] std::optional<FoxgloveFrame> next();
  [[nodiscard]] bool is_idle() const { return texts_.empty() && waiting_.empty(); }
  /// False for a client that does not read the answers to what it asks.
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
