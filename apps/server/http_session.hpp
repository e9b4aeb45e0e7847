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
  [[nodiscard]] Rank rank() const override { return rank_; }

 private:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;
  using Body = boost::beast::http::span_body<const char>;
  using ErrorCode = boost::beast::error_code;

  void read();
  void on_read(ErrorCode error);
  void answer_request();
  void answer_page(const std::string& path);
  void answer_data(const Target& target);
  void on_data(HttpAnswer answer);
  void end_data();
  void open_socket();
  [[nodiscard]] bool is_for_foxglove(const Target& target) const;
  void answer_foxglove(bool has_token);
  /// Returns the token that the request gives: in a header, or as ?token=; empty without one.
  [[nodiscard]] std::string_view given_token(const Target& target) const;
  /// Tells whether there is exactly one Host header, and it names this server.
  [[nodiscard]] bool has_own_host() const;
  /// Tells whether a client without the token may watch: a program, or Foxglove itself.
  [[nodiscard]] bool is_foxglove() const;
  /// Tells, by a header that browsers set themselves, whether another site's page sent the request.
  [[nodiscard]] bool is_foreign() const;

  /// Answers with a line of text; after a refusal the socket is closed.
  void refuse(boost::beast::http::status status, std::string_view why);
  [[nodiscard]] boost::beast::http::response<Body> begin_answer(boost::beast::http::status status) const;
  void write(boost::beast::http::response<Body> answer);
  void write_some();
  /// Lets the client read the answer before the socket is closed.
  void linger();
  void discard();
  void finish() override;

  ServerState& state_;
  boost::beast::tcp_stream stream_;
  std::string local_address_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  Request request_;
  std::string text_;        ///< answer, where it is text
  HttpAnswer data_;         ///< answer, where it is data
  bool gives_data_{false};  ///< from the request until it is written
  boost::beast::http::response<Body> answer_;
  std::optional<boost::beast::http::response_serializer<Body>> serializer_;
  std::size_t discarded_{0};
  Rank rank_{false, false, 0};
  bool finished_{false};
};

}  // namespace saccade::server
