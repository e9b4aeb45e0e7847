// SPDX-License-Identifier: Apache-2.0
#include "server/foxglove/foxglove_session.hpp"

#include <boost/asio/post.hpp>

namespace saccade::server {
namespace {

namespace foxglove_websocket = boost::beast::websocket;

constexpr std::size_t kFragmentOf{64U << 10U};  // fragment size of a map, so that pings get through between fragments
constexpr std::chrono::milliseconds kLastGrace{200};  // after the program's end was requested

}  // namespace

FoxgloveSession::FoxgloveSession(ServerState& state, boost::beast::tcp_stream stream, ConnectionSlot seat,
                                 std::string_view subprotocol)
    : state_{state},
      seat_{std::move(seat)},
      hub_{state.config.foxglove},
      subprotocol_{subprotocol},
      stream_{std::move(stream)},
      grace_{stream_.get_executor()},
      buffer_{state.config.max_message_bytes} {}

void FoxgloveSession::run(Request request) {
  state_.sessions.emplace(this, shared_from_this());
  guard([&] { begin(std::move(request)); });
}

void FoxgloveSession::begin(Request request) {
  boost::beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has its own timeout
  stream_.set_option(foxglove_websocket::stream_base::timeout{state_.config.request_timeout, state_.config.idle_timeout,
                                                              /*pings=*/true});
  stream_.set_option(foxglove_websocket::stream_base::decorator{[this](foxglove_websocket::response_type& answer) {
    answer.set(boost::beast::http::field::sec_websocket_protocol, subprotocol_);
  }});
  stream_.read_message_max(state_.config.max_message_bytes);
  stream_.write_buffer_bytes(kFragmentOf);
  stream_.auto_fragment(true);
  const auto kept = std::make_shared<Request>(std::move(request));
  stream_.async_accept(
      *kept, [self = shared_from_this(), kept](ErrorCode error) { self->guard([&] { self->on_accept(error); }); });
}

void FoxgloveSession::on_accept(ErrorCode error) {
  if (error || finished_ || state_.stopping) return finish();
  client_ = hub_->join([executor = stream_.get_executor(), weak = weak_from_this()] {
    boost::asio::post(executor, [weak] {
      if (const auto self = weak.lock()) self->guard([&] { self->write(); });
    });
  });
  write();
  read();
}

void FoxgloveSession::read() {
  if (finished_ || reading_ || !hub_->may_read(*client_)) return;
  reading_ = true;
  stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->guard([&] { self->on_read(error); });
  });
}

void FoxgloveSession::on_read(ErrorCode error) {
  reading_ = false;
  if (error || finished_) return finish();
  hub_->received(*client_, stream_.got_text(), {static_cast<const char*>(buffer_.cdata().data()), buffer_.size()});
  buffer_.consume(buffer_.size());
  write();
  read();
}

void FoxgloveSession::write() {
  if (finished_ || writing_ || stopping_) return;
  writing_ = hub_->next(*client_);
  if (!writing_) return;
  stream_.text(writing_->is_text);
  std::array<boost::asio::const_buffer, 2> parts{boost::asio::buffer(writing_->head), {}};
  if (writing_->message) {
    parts[1] = boost::asio::buffer(writing_->message->content.data(), writing_->message->content.size());
  }
  stream_.async_write(parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->writing_.reset();
    if (error || self->finished_) return self->finish();
    self->guard([&] {
      if (self->stopping_) return self->close();
      self->write();
      self->read();
    });
  });
}

void FoxgloveSession::stop() {
  if (!client_) return finish();
  if (finished_ || std::exchange(stopping_, true)) return;
  grace_.expires_after(kLastGrace);
  grace_.async_wait([self = shared_from_this()](ErrorCode error) {
    if (!error) self->finish();
  });
  if (!writing_) close();
}

void FoxgloveSession::close() {
  const foxglove_websocket::close_reason reason{foxglove_websocket::close_code::going_away, "the run is over"};
  stream_.async_close(reason, [self = shared_from_this()](ErrorCode) { self->finish(); });
}

void FoxgloveSession::finish() {
  if (std::exchange(finished_, true)) return;
  grace_.cancel();
  boost::beast::get_lowest_layer(stream_).close();
  if (client_) hub_->leave(*client_);
  state_.sessions.erase(this);
}

}  // namespace saccade::server
