// SPDX-License-Identifier: Apache-2.0
#pragma once
// Service: what stands behind a server. Clients: whom it speaks to.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace saccade::server {

/// One WebSocket, from its opening to its end; never used again.
using ConnectionId = std::uint64_t;
/// A whole WebSocket message.
using Message = std::vector<std::uint8_t>;
using SharedMessage = std::shared_ptr<const Message>;

/// Any thread may call.
class Clients {
 public:
  virtual ~Clients() = default;
  /// In the order of calls; to a connection that has ended, nothing. One that reads too slowly is ended.
  virtual void send(ConnectionId to, SharedMessage message) = 0;
  /// After what was sent before. `code` as of RFC 6455; the reason is short.
  virtual void close(ConnectionId connection, std::uint16_t code, const std::string& reason) = 0;
};

/// An answer to GET /data/….
struct HttpAnswer {
  int status{200};
  std::string content_type{"application/octet-stream"};
  std::string file_name;  ///< the browser keeps the answer under this name; empty: it shows it
  std::vector<std::uint8_t> body;
};

struct HttpRequest {
  std::string path;  ///< after /data/, decoded
  std::map<std::string, std::string> query;
};

/// All of this is called on one thread, which is not that of the network, one call after the other: what a service
/// keeps needs no locks. Questions of a connection come in their order; whose is next ServiceThread says. A connection
/// has few messages waiting: whoever sends more is not read from meanwhile.
class Service {
 public:
  virtual ~Service() = default;
  virtual void opened(ConnectionId connection) = 0;
  virtual void received(ConnectionId connection, std::span<const std::uint8_t> message) = 0;
  /// After the last message of this connection.
  virtual void closed(ConnectionId connection) = 0;
  [[nodiscard]] virtual HttpAnswer get(const HttpRequest& request) = 0;
};

}  // namespace saccade::server
