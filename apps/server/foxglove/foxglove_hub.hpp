// SPDX-License-Identifier: Apache-2.0
#pragma once
// FoxgloveHub: channels, their newest messages, and the connected clients. FoxgloveSink: a run's messages for it.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "saccade/io/messages/message_sink.hpp"
#include "server/foxglove/foxglove_client.hpp"

namespace saccade::server {

class HttpServer;

/// Hub. Any thread may call it. Publishing never waits for a client; at most one message per channel waits for each.
class FoxgloveHub {
 public:
  using ClientId = std::uint64_t;

  FoxgloveHub();

  /// Stores a copy as the newest of its topic, and queues it for subscribers. The first message of a topic advertises
  /// its channel. Its layout is CDR.
  void publish(std::string_view topic, const messages::MessageType& type, messages::Time time,
               std::span<const std::byte> bytes);
  /// Waits until all waiting messages are written to their clients. Returns false when `patience` ends before.
  [[nodiscard]] bool wait_until_written(std::chrono::milliseconds patience);

  /// Adds a client. Any thread may call `wake` when there is something for it; it must return at once, and must not
  /// call the hub.
  [[nodiscard]] ClientId join(std::function<void()> wake);
  /// Removes a client; `wake` is not called afterwards.
  void leave(ClientId client);
  void received(ClientId client, bool is_text, std::string_view message);
  /// Returns the next frame. Call it when the previous one is written.
  [[nodiscard]] std::optional<FoxgloveFrame> next(ClientId client);
  [[nodiscard]] bool may_read(ClientId client);

 private:
  struct Member {
    FoxgloveClient client;
    std::function<void()> wake;
    bool is_writing{false};
  };
  [[nodiscard]] FoxgloveChannel& channel_of(std::string_view topic, const messages::MessageType& type);
  [[nodiscard]] bool is_all_written() const;

  std::mutex mutex_;
  std::condition_variable written_;
  const std::string session_;
  std::vector<FoxgloveChannel> channels_;
  std::unordered_map<ClientId, Member> members_;
  ClientId last_id_{0};
};

/// Publishes messages on a hub.
class FoxgloveSink final : public messages::MessageSink {
 public:
  /// @param server  server of the hub for this sink alone, which ends with it. May be null.
  FoxgloveSink(std::shared_ptr<FoxgloveHub> hub, std::unique_ptr<HttpServer> server);
  ~FoxgloveSink() override;

  [[nodiscard]] messages::Wire wire() const override { return messages::Wire::cdr; }
  [[nodiscard]] Status add(std::string_view topic, const messages::MessageType& type, messages::Time time,
                           std::span<const std::byte> bytes) override;
  /// Gives clients at most two seconds to read the last messages.
  [[nodiscard]] Status finish() override;

 private:
  std::shared_ptr<FoxgloveHub> hub_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace saccade::server
