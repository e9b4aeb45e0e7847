// SPDX-License-Identifier: Apache-2.0
#pragma once
// HttpSession: the requests of one socket, one after the other.

#include <utility>  // Boost.Asio 1.74 lacks it

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/span_body.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/access.hpp"
#include "server/server_state.hpp"

namespace saccade::server {

class HttpSession : public Session, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ServerState& state, boost::asio::ip::tcp::socket socket);
  void run();
  void stop() override;

 private:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;
  using Body = boost::beast::http::span_body<const char>;
  using ErrorCode = boost::beast::error_code;

  void read();
  void on_read(ErrorCode error);
  void answer_request();
  void answer_page(const Target& target, const std::string& path);
  void answer_data(const Target& target);
  void on_data(HttpAnswer answer);
  void end_data();
  void open_socket();
  [[nodiscard]] bool is_for_foxglove(const Target& target) const;
  void answer_foxglove(const Target& target);
  [[nodiscard]] bool has_token(const Target& target) const;
  /// Whether there is one Host header, and it means this server.
  [[nodiscard]] bool has_own_host() const;
  /// Whether a client without the token may look on: a program, or Foxglove itself.
  [[nodiscard]] bool is_foxglove() const;
  /// Of the browser's own making: another site's page asked.
  [[nodiscard]] bool is_foreign() const;

  /// An answer in a line of text; after a refusal the socket is closed.
  void refuse(boost::beast::http::status status, std::string_view why);
  [[nodiscard]] boost::beast::http::response<Body> begin_answer(boost::beast::http::status status) const;
  void write(boost::beast::http::response<Body> answer);
  void write_some();
  /// Lets the client read what it was told before the socket is closed.
  void linger();
  void discard();
  void finish() override;

  ServerState& state_;
  boost::beast::tcp_stream stream_;
  std::string local_address_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  Request request_;
  std::string text_;        ///< what is answered, where it is text
  HttpAnswer data_;         ///< where it is data
  bool gives_data_{false};  ///< from its question until it is written
  boost::beast::http::response<Body> answer_;
  std::optional<boost::beast::http::response_serializer<Body>> serializer_;
  std::size_t discarded_{0};
  bool finished_{false};
};

}  // namespace saccade::server
