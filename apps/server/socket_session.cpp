// SPDX-License-Identifier: Apache-2.0
#include "server/socket_session.hpp"

#include <boost/asio/post.hpp>

#include "server/access.hpp"

namespace saccade::server {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::uint16_t kGoingAway{1001};
constexpr std::uint16_t kUnknownData{1003};
constexpr std::size_t kFragmentBytes{
    64U << 10U};  // fragment size of a long message, so that pings get through between fragments
constexpr std::chrono::milliseconds kGrace{2000};      // for the last messages before an urgent end
constexpr std::chrono::milliseconds kGraceAtEnd{200};  // at the end of the program, whose user waits

}  // namespace

SocketSession::SocketSession(ServerState& state, boost::beast::tcp_stream stream, ConnectionSlot seat)
    : state_{state},
      seat_{std::move(seat)},
      stream_{std::move(stream)},
      grace_{stream_.get_executor()},
      buffer_{state.config.max_message_bytes} {}

void SocketSession::run(boost::beast::http::request<boost::beast::http::empty_body> request) {
  state_.sessions.emplace(this, shared_from_this());
  guard([&] { begin(std::move(request)); });
}

void SocketSession::begin(boost::beast::http::request<boost::beast::http::empty_body> request) {
  const auto offered = request[boost::beast::http::field::sec_websocket_protocol];
  boost::beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has its own timeout
  stream_.set_option(
      websocket::stream_base::timeout{state_.config.request_timeout, state_.config.idle_timeout, /*pings=*/true});
  stream_.read_message_max(state_.config.max_message_bytes);
  stream_.write_buffer_bytes(kFragmentBytes);
  stream_.auto_fragment(true);
  stream_.binary(true);
  if (!offered_token({offered.data(), offered.size()}).empty()) {
    stream_.set_option(websocket::stream_base::decorator{[](websocket::response_type& answer) {
      answer.set(boost::beast::http::field::sec_websocket_protocol,
                 boost::string_view{kSubprotocol.data(), kSubprotocol.size()});
    }});
  }
  const auto kept = std::make_shared<decltype(request)>(std::move(request));
  stream_.async_accept(
      *kept, [self = shared_from_this(), kept](ErrorCode error) { self->guard([&] { self->on_accept(error); }); });
}

void SocketSession::on_accept(ErrorCode error) {
  if (error || finished_ || state_.stopping) return finish();
  auto wake = [executor = stream_.get_executor(), weak = weak_from_this()] {
    boost::asio::post(executor, [weak] {
      if (const auto self = weak.lock()) self->guard([&] { self->on_woken(); });
    });
  };
  connection_ = std::make_shared<Connection>(++state_.last_id, state_.config, state_.service_thread,
                                             *state_.service.load(), seat_, std::move(wake));
  state_.connections.add(connection_);
  connection_->open();
  read();
}

void SocketSession::on_woken() {
  if (finished_) return;
  if (connection_->woken() && !std::exchange(in_grace_, true)) end_within(kGrace);
  write();
  if (!reading_ && connection_->may_read()) read();
}

void SocketSession::read() {
  reading_ = true;
  stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->guard([&] { self->on_read(error); });
  });
}

void SocketSession::on_read(ErrorCode error) {
  reading_ = false;
  if (error || finished_) return finish();
  if (!stream_.got_binary()) {
    connection_->close({kUnknownData, "messages are binary", false});
  } else {
    const auto* first = static_cast<const std::uint8_t*>(buffer_.cdata().data());
    connection_->ask(Message{first, first + buffer_.size()});
  }
  buffer_.consume(buffer_.size());
  if (connection_->may_read()) read();
}

void SocketSession::write() {
  if (writing_) return;
  Connection::Next next = connection_->next();
  if (next.closing) return close(*next.closing);
  if (!next.message) return;
  writing_ = std::move(next.message);
  stream_.async_write(boost::asio::buffer(*writing_), [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->writing_.reset();
    if (error || self->finished_) return self->finish();
    self->guard([&] {
      self->connection_->written();
      self->write();
    });
  });
}

void SocketSession::close(const Connection::Closing& closing) {
  const websocket::close_reason reason{static_cast<websocket::close_code>(closing.code), closing.reason};
  stream_.async_close(reason, [self = shared_from_this()](ErrorCode) { self->finish(); });
}

void SocketSession::end_within(std::chrono::milliseconds grace) {
  grace_.expires_after(grace);
  grace_.async_wait([self = shared_from_this()](ErrorCode error) {
    if (!error) self->finish();
  });
}

void SocketSession::stop() {
  if (!connection_) return finish();
  in_grace_ = true;
  end_within(kGraceAtEnd);
  connection_->close({kGoingAway, "the program ends", true});
}

void SocketSession::finish() {
  if (std::exchange(finished_, true)) return;
  grace_.cancel();
  boost::beast::get_lowest_layer(stream_).close();
  if (connection_) {
    state_.connections.remove(connection_->id());
    connection_->end();
  }
  state_.sessions.erase(this);
}

}  // namespace saccade::server
