// SPDX-License-Identifier: Apache-2.0
#pragma once
// FoxgloveHub: channels, their newest messages, and the clients that look on. FoxgloveSink: a run's messages for it.

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

/// Any thread may call. Publishing never waits for a client, for which at most one message of each channel waits.
class FoxgloveHub {
 public:
  using ClientId = std::uint64_t;

  FoxgloveHub();

  /// Keeps a copy as the newest of its topic, and queues it for those who have subscribed. The first message of a topic
  /// makes its channel known. Its layout is CDR.
  void publish(std::string_view topic, const messages::MessageType& type, messages::Time time,
               std::span<const std::byte> bytes);
  /// Waits until every client was written every message that waits for it. False when `patience` is over before.
  [[nodiscard]] bool wait_until_written(std::chrono::milliseconds patience);

  /// A client comes. `wake` is called, by any thread, when there is something for it; it returns at once, and does not
  /// call the hub.
  [[nodiscard]] ClientId join(std::function<void()> wake);
  /// After it `wake` is not called any more.
  void leave(ClientId client);
  void received(ClientId client, bool is_text, std::string_view message);
  /// Called when what it returned before is written.
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
  /// @param server  that serves the hub for this sink alone; it ends with it. May be null.
  FoxgloveSink(std::shared_ptr<FoxgloveHub> hub, std::unique_ptr<HttpServer> server);
  ~FoxgloveSink() override;

  [[nodiscard]] messages::Wire wire() const override { return messages::Wire::cdr; }
  [[nodiscard]] Status add(std::string_view topic, const messages::MessageType& type, messages::Time time,
                           std::span<const std::byte> bytes) override;
  /// Gives clients two seconds, at most, to read the last messages.
  [[nodiscard]] Status finish() override;

 private:
  std::shared_ptr<FoxgloveHub> hub_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace saccade::server
