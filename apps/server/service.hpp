// SPDX-License-Identifier: Apache-2.0
#pragma once
// Service: handles a server's requests. Clients: the connections that it answers.

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

/// Connections of a service. Any thread may call.
class Clients {
 public:
  virtual ~Clients() = default;
  /// Sends a message, in the order of calls; ignored after the connection has ended. A client that reads too slowly is
  /// disconnected.
  virtual void send(ConnectionId to, SharedMessage message) = 0;
  /// Closes a connection after earlier messages. `code` as in RFC 6455; the reason is short.
  virtual void close(ConnectionId connection, std::uint16_t code, const std::string& reason) = 0;
};

/// An answer to GET /data/….
struct HttpAnswer {
  int status{200};
  std::string content_type{"application/octet-stream"};
  std::string file_name;  ///< name under which the browser saves the answer; empty: it shows it
  std::vector<std::uint8_t> body;
};

struct HttpRequest {
  std::string path;  ///< after /data/, decoded
  std::map<std::string, std::string> query;
};

/// Service. All methods are called one after the other on one thread, which is not the network's, so its state needs no
/// locks. Questions of a connection come in order; ServiceThread chooses the next connection. Few messages wait per
/// connection: a client that sends more is not read from meanwhile.
class Service {
 public:
  virtual ~Service() = default;
  virtual void opened(ConnectionId connection) = 0;
  virtual void received(ConnectionId connection, std::span<const std::uint8_t> message) = 0;
  /// Called after the last message of this connection.
  virtual void closed(ConnectionId connection) = 0;
  [[nodiscard]] virtual HttpAnswer get(const HttpRequest& request) = 0;
};

}  // namespace saccade::server
