// SPDX-License-Identifier: Apache-2.0
#pragma once
// FoxgloveSession: the socket of one client of the Foxglove WebSocket protocol.

#include <utility>  // Boost.Asio 1.74 lacks it

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <optional>
#include <string>

#include "server/foxglove/foxglove_hub.hpp"
#include "server/server_state.hpp"

namespace saccade::server {

class FoxgloveSession : public Session, public std::enable_shared_from_this<FoxgloveSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// @param subprotocol  choice among those that the client offered.
  FoxgloveSession(ServerState& state, boost::beast::tcp_stream stream, ConnectionSlot seat,
                  std::string_view subprotocol);
  void run(Request request);
  void stop() override;

 private:
  using ErrorCode = boost::beast::error_code;

  void begin(Request request);
  void on_accept(ErrorCode error);
  void read();
  void on_read(ErrorCode error);
  void write();
  void close();
  void finish() override;

  ServerState& state_;
  const ConnectionSlot seat_;
  const std::shared_ptr<FoxgloveHub> hub_;
  const std::string subprotocol_;
  boost::beast::websocket::stream<boost::beast::tcp_stream, /*deflateSupported=*/false> stream_;
  boost::asio::steady_timer grace_;
  boost::beast::flat_buffer buffer_;
  std::optional<FoxgloveHub::ClientId> client_;
  std::optional<FoxgloveFrame> writing_;
  bool reading_{false};
  bool stopping_{false};
  bool finished_{false};
};

}  // namespace saccade::server
