// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServerState: what the sessions of a server share. Session: one socket, plain or grown to a WebSocket.

#include <atomic>
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

/// Of the network's thread. It lives until it takes itself off the state's list.
class Session {
 public:
  virtual ~Session() = default;
  /// The server ends.
  virtual void stop() = 0;

 protected:
  /// Closes the socket and takes itself off the list.
  virtual void finish() = 0;
  /// What goes wrong in one session, as for lack of memory, ends that one.
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

/// The WebSockets that are open. Any thread may call.
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

  /// Whether a Host header means this server, at this address of this machine.
  [[nodiscard]] bool is_host(std::string_view header, const std::string& local_address) const;

  /// Nothing where as many WebSockets are there as may be. Of the network's thread.
  [[nodiscard]] Seat take_seat();

  /// Files are asked for one at a time, and share one account. Of the network's thread, as is data_answered(), which is
  /// called after each.
  void ask_data(std::function<void()> work);
  void data_answered();

  const ServerConfig config;
  std::set<std::string> host_names;
  std::string cookie;                            ///< its name
  bool foxglove_is_open{false};                  ///< needs no token
  std::map<std::string_view, CachedFile> files;  ///< by path
  std::atomic<Service*> service{nullptr};        ///< null until it serves
  std::atomic<std::size_t> web_sockets{0};       ///< with those that are gone and were not served to their end
  OpenConnections connections;
  ServiceThread service_thread;
  ServiceThread::Account data_account{service_thread};

  // Of the network's thread.
  std::unordered_map<const Session*, std::shared_ptr<Session>> sessions;
  std::size_t data_requests{0};                    ///< under way, until they are written
  std::deque<std::function<void()>> data_waiting;  ///< to be asked
  bool data_asked{false};                          ///< one, by which the service's thread is busy
  ConnectionId last_id{0};
  bool stopping{false};
};

}  // namespace saccade::server
