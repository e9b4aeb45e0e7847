// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connection: questions and answers of one WebSocket, between the network's thread and the service's.

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/http_server.hpp"
#include "server/service.hpp"
#include "server/service_thread.hpp"

namespace saccade::server {

/// Slot of a WebSocket, which counts against the limit while it is held.
using ConnectionSlot = std::shared_ptr<const void>;

/// Connection with limits. A client that has asked too much is not read from. A client that reads slowly gets its next
/// answers after it has read the earlier ones; one that receives too many notices is closed.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  struct Closing {
    std::uint16_t code{1000};
    std::string reason;
    bool urgent{false};  ///< does not wait for a slow reader
  };
  /// Next write of the network; neither: nothing.
  struct Next {
    SharedMessage message;
    std::optional<Closing> closing;
  };

  /// `wake` makes the network's thread call woken(), next() and may_read(); any thread may call it. `seat` is held
  /// while the service has work for the connection.
  Connection(ConnectionId id, const ServerConfig& config, ServiceThread& thread, Service& service, ConnectionSlot seat,
             std::function<void()> wake);

  [[nodiscard]] ConnectionId id() const { return id_; }

  // The network's thread.
  void open();
  void ask(Message message);
  /// Answers a wake. Returns whether the end is urgent.
  [[nodiscard]] bool woken();
  [[nodiscard]] bool may_read();
  /// Returns the next message, which is in progress until written().
  [[nodiscard]] Next next();
  void written();
  /// Ends the connection: nothing more is read or written.
  void end();

  // Any thread.
  void send(SharedMessage message);
  /// Closes the connection; waiting questions are dropped.
  void close(Closing closing);

 private:
  void schedule();  ///< requires the mutex, as all below
  void wake();
  [[nodiscard]] bool reads_slowly() const { return told_bytes_ > config_.max_waiting_bytes / 8; }
  [[nodiscard]] bool asks_too_much() const;
  void close_locked(Closing closing);

  void serve_one();  ///< the service's thread

  const ConnectionId id_;
  const ServerConfig& config_;
  ServiceThread& thread_;
  Service& service_;
  const ConnectionSlot seat_;
  const std::function<void()> wake_;

  ServiceThread::FairShare account_;
  std::mutex mutex_;
  std::deque<Message> asked_;
  std::size_t asked_bytes_{0};
  bool scheduled_{false};  ///< serve_one is scheduled
  bool waits_to_read_{false};
  std::deque<SharedMessage> told_;
  std::size_t under_way_bytes_{0};
  std::size_t told_bytes_{0};  ///< including those in progress
  std::optional<Closing> closing_;
  bool closing_taken_{false};
  bool ended_{false};
  bool wake_pending_{false};
  bool end_told_{false};
};

}  // namespace saccade::server
