// SPDX-License-Identifier: Apache-2.0
#include "server/http_session.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>

#include "server/foxglove/foxglove_session.hpp"
#include "server/socket_session.hpp"

namespace saccade::server {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using http::field;
using http::status;

constexpr std::uint32_t kMostHeaderBytes{16U << 10U};
constexpr std::size_t kMostDataRequests{16};
constexpr std::size_t kMostDiscardedBytes{256U << 10U};
constexpr std::string_view kDataPrefix{"/data/"};

std::string_view text_of(boost::string_view text) { return {text.data(), text.size()}; }
boost::string_view boost_view(std::string_view text) { return {text.data(), text.size()}; }

std::string address_text(const boost::asio::ip::address& address) {
  namespace ip = boost::asio::ip;
  const bool is_mapped = address.is_v6() && address.to_v6().is_v4_mapped();
  return is_mapped ? ip::make_address_v4(ip::v4_mapped, address.to_v6()).to_string() : address.to_string();
}

/// Returns the policy: the page runs only its own files, embeds no other site, and is embedded by none. Browsers
/// disagree on whether 'self' includes the WebSocket.
std::string content_policy(std::string_view host) {
  std::string policy{
      "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; form-action 'none'; "
      "frame-ancestors 'none'; connect-src 'self'"};
  for (const std::string_view scheme : {" ws://", " wss://"}) policy.append(scheme).append(host);
  return policy;
}

}  // namespace

HttpSession::HttpSession(ServerState& state, boost::asio::ip::tcp::socket socket)
    : state_{state}, stream_{std::move(socket)}, buffer_{2 * kMostHeaderBytes} {
  ErrorCode ignored;
  stream_.socket().set_option(boost::asio::ip::tcp::no_delay{true}, ignored);
  local_address_ = address_text(stream_.socket().local_endpoint(ignored).address());
}

void HttpSession::run() {
  rank_.turn = ++state_.turns;
  state_.sessions.emplace(this, shared_from_this());
  guard([this] { read(); });
}

void HttpSession::stop() { finish(); }

void HttpSession::finish() {
  if (std::exchange(finished_, true)) return;
  stream_.close();
  end_data();
  state_.sessions.erase(this);
}

void HttpSession::read() {
  rank_.in_request = false;
  parser_.emplace();
  parser_->header_limit(kMostHeaderBytes);
  stream_.expires_after(state_.config.request_timeout);
  http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->guard([&] { self->on_read(error); });
  });
}

void HttpSession::on_read(ErrorCode error) {
  if (finished_) return;
  stream_.expires_never();
  request_ = {};
  rank_.in_request = true;
  rank_.turn = ++state_.turns;
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return refuse(status::request_header_fields_too_large, "The headers are too long.");
  }
  if (error == http::error::body_limit) return refuse(status::payload_too_large, "Requests have no body here.");
  if (error && error.category() == http::make_error_code(http::error::bad_version).category() &&
      error != http::error::end_of_stream && error != http::error::partial_message) {
    return refuse(status::bad_request, "This is not a valid request.");
  }
  if (error) return finish();
  const bool has_body = !parser_->is_done();
  request_ = parser_->release();
  if (request_.method() != http::verb::get && request_.method() != http::verb::head) {
    return refuse(status::method_not_allowed, "There is only GET and HEAD here.");
  }
  if (has_body) return refuse(status::payload_too_large, "Requests have no body here.");
  answer_request();
}

bool HttpSession::is_foreign() const {
  const auto site = text_of(request_["Sec-Fetch-Site"]);
  return !site.empty() && site != "same-origin" && site != "none";
}

std::string_view HttpSession::given_token(const Target& target) const {
  const auto given = target.query.find("token");
  if (given != target.query.end()) return given->second;
  const auto header = request_.find(boost_view(kTokenHeader));
  if (header != request_.end()) return text_of(header->value());
  return offered_token(text_of(request_[field::sec_websocket_protocol]));
}

bool HttpSession::has_own_host() const {
  const auto hosts = request_.equal_range(field::host);
  const bool one_host = hosts.first != hosts.second && std::next(hosts.first) == hosts.second;
  return one_host && state_.is_host(text_of(request_[field::host]), local_address_);
}

bool HttpSession::is_foxglove() const {
  const auto [begin, end] = request_.equal_range(field::origin);
  return std::all_of(begin, end, [](const auto& origin) { return is_foxglove_origin(text_of(origin.value())); });
}

bool HttpSession::is_for_foxglove(const Target& target) const {
  if (state_.config.foxglove == nullptr) return false;
  return target.path == "/foxglove" || (target.path == "/" && state_.config.foxglove_only);
}

void HttpSession::answer_foxglove(bool has_token) {
  if (!has_token) {
    if (!state_.foxglove_is_open) {
      return refuse(status::forbidden, "Foxglove's address is what the program printed: it ends with its token.");
    }
    if (!has_own_host()) return refuse(status::forbidden, "This name is not known here: localhost is.");
    if (!is_foxglove()) return refuse(status::forbidden, "Pages of another origin get nothing here.");
  }
  if (!beast::websocket::is_upgrade(request_) || request_.method() != http::verb::get) {
    return refuse(status::upgrade_required, "This is Foxglove's place: open it there as a Foxglove WebSocket.");
  }
  std::string offered;
  for (auto [header, end] = request_.equal_range(field::sec_websocket_protocol); header != end; ++header) {
    offered.append(offered.empty() ? "" : ",").append(text_of(header->value()));
  }
  const std::string_view subprotocol = foxglove_subprotocol(offered);
  if (subprotocol.empty()) {
    return refuse(status::bad_request, "The subprotocol is foxglove.sdk.v1 or foxglove.websocket.v1 here.");
  }
  ConnectionSlot seat = state_.take_seat();
  if (!seat) return refuse(status::service_unavailable, "Too many are connected.");
  const auto session = std::make_shared<FoxgloveSession>(state_, std::move(stream_), std::move(seat), subprotocol);
  finished_ = true;  // another session owns the socket now
  state_.sessions.erase(this);
  session->run(std::move(request_));
}

void HttpSession::answer_request() {
  const auto target = parse_target(text_of(request_.target()));
  const std::string_view given = target ? given_token(*target) : std::string_view{};
  const bool has_token = is_same_token(given, state_.config.token);
  rank_.has_token = rank_.has_token || has_token;
  if (target && is_for_foxglove(*target)) return answer_foxglove(has_token);
  const std::string_view host = text_of(request_[field::host]);
  if (!has_own_host()) {
    return refuse(status::forbidden, "This name is not known here: start the program with --host NAME.");
  }
  for (auto [origin, end] = request_.equal_range(field::origin); origin != end; ++origin) {
    if (!is_origin_of(text_of(origin->value()), host)) {
      return refuse(status::forbidden, "Pages of another origin get nothing here.");
    }
  }
  if (!target) return refuse(status::bad_request, "This is not a valid path.");
  const std::string path = target->path == "/" ? "index.html" : target->path.substr(1);
  const bool to_socket = target->path == "/socket";
  const bool to_page = !to_socket && !target->path.starts_with(kDataPrefix);
  if (!has_token && !(to_page && given.empty())) {
    return refuse(status::forbidden, "Open the address that the program printed: it ends with its token.");
  }
  if (to_page) return answer_page(path);
  if (is_foreign()) return refuse(status::forbidden, "Pages of another site get nothing here.");
  if (state_.service == nullptr) return refuse(status::service_unavailable, "The program is not ready yet.");
  if (to_socket) return open_socket();
  answer_data(*target);
}

void HttpSession::answer_page(const std::string& path) {
  const auto found = state_.files.find(path);
  if (found == state_.files.end()) return refuse(status::not_found, "There is no such file.");
  const CachedFile& cached = found->second;
  const bool unchanged = text_of(request_[field::if_none_match]) == cached.etag;
  http::response<Body> answer = begin_answer(unchanged ? status::not_modified : status::ok);
  answer.set(field::content_type, boost_view(cached.file.content_type));
  answer.set(field::cache_control, "no-cache");
  answer.set(field::etag, cached.etag);
  const auto content = cached.file.content;
  if (!unchanged) answer.body() = {reinterpret_cast<const char*>(content.data()), content.size()};
  write(std::move(answer));
}

void HttpSession::open_socket() {
  if (!beast::websocket::is_upgrade(request_) || request_.method() != http::verb::get) {
    return refuse(status::upgrade_required, "This is the WebSocket's place.");
  }
  ConnectionSlot seat = state_.take_seat();
  if (!seat) return refuse(status::service_unavailable, "Too many pages are open.");
  const auto socket = std::make_shared<SocketSession>(state_, std::move(stream_), std::move(seat));
  finished_ = true;  // another session owns the socket now
  state_.sessions.erase(this);
  socket->run(std::move(request_));
}

void HttpSession::answer_data(const Target& target) {
  if (state_.data_requests >= kMostDataRequests) {
    return refuse(status::service_unavailable, "Too many files are asked for at once.");
  }
  ++state_.data_requests;
  gives_data_ = true;
  HttpRequest request{target.path.substr(kDataPrefix.size()), target.query};
  request.query.erase("token");
  state_.ask_data([self = shared_from_this(), request = std::move(request)]() mutable {
    HttpAnswer answer;
    try {
      if (!self->state_.service_thread.hurries()) answer = self->state_.service.load()->get(request);
    } catch (const std::exception&) {
      const std::string_view text{"A bug in the program."};
      answer = {500, "text/plain; charset=utf-8", "", {text.begin(), text.end()}};
    }
    auto executor = self->stream_.get_executor();
    boost::asio::post(executor, [self = std::move(self), answer = std::move(answer)]() mutable {
      self->state_.data_answered();
      if (!self->finished_) self->guard([&] { self->on_data(std::move(answer)); });
    });
  });
}

/// Ends the answer. It counts until it is written, because it takes memory until then.
void HttpSession::end_data() {
  if (std::exchange(gives_data_, false)) --state_.data_requests;
}

void HttpSession::on_data(HttpAnswer data) {
  data_ = std::move(data);
  http::response<Body> answer = begin_answer(http::int_to_status(static_cast<unsigned>(data_.status)));
  answer.set(field::content_type, data_.content_type);
  answer.set(field::cache_control, "no-store");
  if (!data_.file_name.empty()) answer.set(field::content_disposition, attachment(data_.file_name));
  answer.body() = {reinterpret_cast<const char*>(data_.body.data()), data_.body.size()};
  write(std::move(answer));
}

http::response<HttpSession::Body> HttpSession::begin_answer(http::status code) const {
  const bool is_request = request_.version() != 0 && request_.method() != http::verb::unknown;
  http::response<Body> answer{code, request_.version() == 10 ? 10U : 11U};
  answer.set("X-Content-Type-Options", "nosniff");
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("Cross-Origin-Resource-Policy", "same-origin");
  answer.set("Cross-Origin-Opener-Policy", "same-origin");
  answer.keep_alive(is_request && request_.keep_alive());
  return answer;
}

void HttpSession::refuse(http::status code, std::string_view why) {
  text_ = std::string{why} + "\n";
  http::response<Body> answer = begin_answer(code);
  answer.set(field::content_type, "text/plain; charset=utf-8");
  answer.set(field::cache_control, "no-store");
  if (code == status::method_not_allowed) answer.set(field::allow, "GET, HEAD");
  if (code == status::service_unavailable) answer.set(field::retry_after, "1");
  answer.keep_alive(false);
  answer.body() = {text_.data(), text_.size()};
  write(std::move(answer));
}

void HttpSession::write(http::response<Body> answer) {
  answer_ = std::move(answer);
  const std::string_view host = text_of(request_[field::host]);
  answer_.set("Content-Security-Policy",
              content_policy(state_.is_host(host, local_address_) ? host : std::string_view{"localhost"}));
  if (answer_.result() != status::not_modified) answer_.content_length(answer_.body().size());
  serializer_.emplace(answer_);
  serializer_->split(true);
  write_some();
}

void HttpSession::write_some() {
  const bool head_only = request_.method() == http::verb::head || answer_.result() == status::not_modified;
  if (serializer_->is_done() || (head_only && serializer_->is_header_done())) {
    data_ = {};
    end_data();
    return answer_.keep_alive() ? read() : linger();
  }
  stream_.expires_after(state_.config.request_timeout);  // for this part
  http::async_write_some(stream_, *serializer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (self->finished_) return;
    if (error) return self->finish();
    self->guard([&] { self->write_some(); });
  });
}

void HttpSession::linger() {
  rank_.in_request = false;
  ErrorCode ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  stream_.expires_after(state_.config.request_timeout);
  discard();
}

void HttpSession::discard() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(kMostHeaderBytes),
                          [self = shared_from_this()](ErrorCode error, std::size_t bytes) {
                            self->discarded_ += bytes;
                            if (error || self->discarded_ > kMostDiscardedBytes) return self->finish();
                            self->guard([&] { self->discard(); });
                          });
}

}  // namespace saccade::server
