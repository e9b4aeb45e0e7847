// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connection: what one WebSocket has asked and what it is to be told, between the network's thread and the service's.

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

/// Counts while it is held: one of the WebSockets that may be there at once.
using Seat = std::shared_ptr<const void>;

/// Holds a connection to its limits. One that has asked too much is not read from; one that is told more than it reads
/// gets its next answers when it has read those before; one that others tell too much is ended.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  struct Closing {
    std::uint16_t code{1000};
    std::string reason;
    bool urgent{false};  ///< does not wait for a slow reader
  };
  /// What the network writes next; neither: nothing.
  struct Next {
    SharedMessage message;
    std::optional<Closing> closing;
  };

  /// `wake` lets the network's thread call woken(), next() and may_read(); any thread calls it.
  /// `seat` is held as long as the service has something to do for it.
  Connection(ConnectionId id, const ServerConfig& config, ServiceThread& thread, Service& service, Seat seat,
             std::function<void()> wake);

  [[nodiscard]] ConnectionId id() const { return id_; }

  // The network's thread.
  void open();
  void ask(Message message);
  /// Answers a wake. Whether the end is urgent.
  [[nodiscard]] bool woken();
  [[nodiscard]] bool may_read();
  /// The message is under way until written().
  [[nodiscard]] Next next();
  void written();
  /// Nothing comes any more, and nothing is written.
  void end();

  // Any thread.
  void send(SharedMessage message);
  /// Questions that wait are not asked any more.
  void close(Closing closing);

 private:
  void schedule();  ///< with the mutex held, as all below
  void wake();
  [[nodiscard]] bool reads_slowly() const { return told_bytes_ > config_.max_waiting_bytes / 8; }
  [[nodiscard]] bool asks_too_much() const;
  void close_locked(Closing closing);

  void serve_one();  ///< the service's thread

  const ConnectionId id_;
  const ServerConfig& config_;
  ServiceThread& thread_;
  Service& service_;
  const Seat seat_;
  const std::function<void()> wake_;

  ServiceThread::Account account_;
  std::mutex mutex_;
  std::deque<Message> asked_;
  std::size_t asked_bytes_{0};
  bool scheduled_{false};  ///< serve_one is under way
  bool waits_to_read_{false};
  std::deque<SharedMessage> told_;
  std::size_t under_way_bytes_{0};
  std::size_t told_bytes_{0};  ///< with those under way
  std::optional<Closing> closing_;
  bool closing_taken_{false};
  bool ended_{false};
  bool wake_pending_{false};
  bool end_told_{false};
};

}  // namespace saccade::server
