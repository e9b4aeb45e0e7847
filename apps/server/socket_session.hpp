// SPDX-License-Identifier: Apache-2.0
#pragma once
// SocketSession: one WebSocket on the network's thread. Its Connection decides what it may do.

#include <utility>  // Boost.Asio 1.74 lacks it

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <memory>

#include "server/server_state.hpp"

namespace saccade::server {

class SocketSession : public Session, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(ServerState& state, boost::beast::tcp_stream stream, ConnectionSlot seat);
  void run(boost::beast::http::request<boost::beast::http::empty_body> request);
  void stop() override;

 private:
  using ErrorCode = boost::beast::error_code;

  void on_accept(ErrorCode error);
  void on_woken();
  void read();
  void on_read(ErrorCode error);
  void write();
  void close(const Connection::Closing& closing);
  void end_within(std::chrono::milliseconds grace);
  void finish() override;
  void begin(boost::beast::http::request<boost::beast::http::empty_body> request);

  ServerState& state_;
  const ConnectionSlot seat_;
  boost::beast::websocket::stream<boost::beast::tcp_stream, /*deflateSupported=*/false> stream_;
  boost::asio::steady_timer grace_;
  boost::beast::flat_buffer buffer_;
  std::shared_ptr<Connection> connection_;
  SharedMessage writing_;
  bool reading_{false};
  bool in_grace_{false};
  bool finished_{false};
};

}  // namespace saccade::server
