// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServerState: state shared by the sessions of a server. Session: one socket, plain or upgraded to a WebSocket.

#include <atomic>
#include <compare>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/connection.hpp"
#include "server/http_server.hpp"
#include "server/service_thread.hpp"
#include "server/web_page.hpp"

namespace saccade::server {

/// Session on the network's thread. It lives until it removes itself from the state's list.
class Session {
 public:
  /// Rank among the sockets when there is no room for another one: the least gives way. Sessions with the token stay.
  struct Rank {
    bool has_token{true};
    bool in_request{true};  ///< an answer is in progress
    std::uint64_t turn{0};  ///< count of the sockets and requests before it
    friend auto operator<=>(const Rank&, const Rank&) = default;
  };

  virtual ~Session() = default;
  [[nodiscard]] virtual Rank rank() const { return {}; }
  /// Called when the server ends.
  virtual void stop() = 0;

 protected:
  /// Closes the socket and removes the session from the list.
  virtual void finish() = 0;
  /// Runs work; an exception, such as for lack of memory, ends only this session.
  template <class Work>
  void guard(Work&& work) {
    try {
      work();
    } catch (const std::exception&) {
      finish();
    }
  }
};

struct CachedFile {
  PageFile file;
  std::string etag;
};

/// Open WebSockets. Any thread may call.
class OpenConnections {
 public:
  [[nodiscard]] std::shared_ptr<Connection> find(ConnectionId id);
  void add(const std::shared_ptr<Connection>& connection);
  void remove(ConnectionId id);

 private:
  std::mutex mutex_;
  std::unordered_map<ConnectionId, std::shared_ptr<Connection>> connections_;
};

struct ServerState {
  explicit ServerState(ServerConfig server_config);

  /// Tells whether a Host header names this server, at this address of this machine.
  [[nodiscard]] bool is_host(std::string_view header, const std::string& local_address) const;

  /// Returns a slot; null when all are taken. On the network's thread.
  [[nodiscard]] ConnectionSlot take_seat();

  /// Ends the session of least rank that has not shown the token: the one that has been silent for longest, if any.
  /// Returns false where there is none. On the network's thread.
  [[nodiscard]] bool make_room();

  /// Requests a file. Files are served one at a time, and share one account. On the network's thread, as is
  /// data_answered(), which must be called after each.
  void ask_data(std::function<void()> work);
  void data_answered();

  const ServerConfig config;
  std::set<std::string> host_names;
  bool foxglove_is_open{false};                  ///< needs no token
  std::map<std::string_view, CachedFile> files;  ///< by path
  std::atomic<Service*> service{nullptr};        ///< null until it serves
  std::atomic<std::size_t> web_sockets{0};       ///< including closed ones that are not fully served
  OpenConnections connections;
  ServiceThread service_thread;
  ServiceThread::FairShare data_account{service_thread};

  // On the network's thread.
  std::unordered_map<const Session*, std::shared_ptr<Session>> sessions;
  std::size_t data_requests{0};                    ///< in progress, until they are written
  std::deque<std::function<void()>> data_waiting;  ///< not yet started
  bool data_asked{false};                          ///< one is being served by the service's thread
  ConnectionId last_id{0};
  std::uint64_t turns{0};  ///< sockets and requests so far
  bool stopping{false};
};

}  // namespace saccade::server
