// SPDX-License-Identifier: Apache-2.0
#include "server/http_server.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <random>
#include <thread>

#include "server/http_session.hpp"
#include "server/server_state.hpp"

namespace saccade::server {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kPlainSockets{
    64};  ///< besides WebSockets; further ones take the place of those without the token
constexpr int kPortTries{16};
constexpr std::chrono::milliseconds kPauseWithoutFiles{100};  ///< when the process has too many files open

/// Returns the name of this machine; "localhost" where it has none.
std::string machine_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  const std::string text = host_name(name.data());
  return text.empty() ? "localhost" : text;
}

/// Listener on one address.
class Listener {
 public:
  Listener(asio::io_context& network, ServerState& state) : state_{state}, acceptor_{network}, pause_{network} {}

  [[nodiscard]] error_code open(const tcp::endpoint& endpoint) {
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address{true}, error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) close();
    return error;
  }
  [[nodiscard]] std::uint16_t port() const {
    error_code ignored;
    return acceptor_.local_endpoint(ignored).port();
  }
  void close() {
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  }
  void accept() {
    if (!acceptor_.is_open()) return;
    acceptor_.async_accept([this](error_code error, tcp::socket socket) { on_accept(error, std::move(socket)); });
  }

 private:
  void on_accept(error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error == asio::error::no_descriptors || error == asio::error::no_memory ||
        error == asio::error::no_buffer_space) {
      pause_.expires_after(kPauseWithoutFiles);
      pause_.async_wait([this](error_code) { accept(); });
      return;
    }
    accept();
    if (error) return;
    const bool full = state_.sessions.size() >= state_.config.max_connections + kPlainSockets;
    if (full && !state_.make_room()) return;
    std::make_shared<HttpSession>(state_, std::move(socket))->run();
  }

  ServerState& state_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
};

class BeastServer final : public HttpServer {
 public:
  explicit BeastServer(const ServerConfig& config)
      : state_{config}, first_{network_, state_}, second_{network_, state_} {}
  BeastServer(const BeastServer&) = delete;
  BeastServer& operator=(const BeastServer&) = delete;
  ~BeastServer() override;

  [[nodiscard]] Status open();

  void serve(Service& service) override { state_.service = &service; }
  void post(std::function<void()> work) override {
    if (!ending_) state_.service_thread.post(std::move(work));
  }
  void send(ConnectionId to, SharedMessage message) override {
    if (const auto connection = state_.connections.find(to)) connection->send(std::move(message));
  }
  void close(ConnectionId id, std::uint16_t code, const std::string& reason) override {
    if (const auto connection = state_.connections.find(id)) connection->close({code, reason, false});
  }
  [[nodiscard]] std::uint16_t port() const override { return port_; }
  [[nodiscard]] std::string url() const override { return "http://" + host() + "/?token=" + state_.config.token; }
  [[nodiscard]] std::string foxglove_url() const override {
    const std::string place = "ws://" + host() + "/foxglove";
    return state_.foxglove_is_open ? place : place + "?token=" + state_.config.token;
  }

 private:
  [[nodiscard]] std::string host() const;  ///< with its port
  [[nodiscard]] Status listen_on(const asio::ip::address& address);
  void run_network();

  ServerState state_;
  asio::io_context network_{1};
  asio::executor_work_guard<asio::io_context::executor_type> stays_{network_.get_executor()};
  Listener first_;
  Listener second_;  ///< for the other kind of loopback address
  asio::ip::address address_;
  std::uint16_t port_{0};
  std::atomic<bool> ending_{false};
  std::thread network_thread_;
};

BeastServer::~BeastServer() {
  if (!network_thread_.joinable()) return;
  ending_ = true;
  state_.service_thread.hurry();
  asio::post(network_, [this] {
    state_.stopping = true;
    state_.data_waiting.clear();
    first_.close();
    second_.close();
    const auto sessions = state_.sessions;  // a copy, because they remove themselves
    for (const auto& [key, session] : sessions) session->stop();
    stays_.reset();
  });
  network_thread_.join();
  state_.service_thread.finish();
}

/// Browsers resolve "localhost" to 127.0.0.1 or ::1, so no other program may listen on the other one.
Status BeastServer::listen_on(const asio::ip::address& address) {
  const bool is_local = address == asio::ip::address_v4::loopback();
  for (int attempt = 1;; ++attempt) {
    error_code error = first_.open({address, state_.config.port});
    if (!error && is_local) {
      error = second_.open({asio::ip::address_v6::loopback(), first_.port()});
      if (error != asio::error::address_in_use) return {};  // without IPv6 no program can listen there
      first_.close();
      if (state_.config.port == 0 && attempt < kPortTries) continue;
    }
    if (!error) return {};
    const std::string where = state_.config.address + ":" + std::to_string(state_.config.port);
    if (error == asio::error::address_in_use) {
      return Error{Errc::unavailable, "the port is taken; choose another one, or 0 for any that is free", where};
    }
    return Error{Errc::unavailable, "cannot listen there: " + error.message(), where};
  }
}

Status BeastServer::open() {
  error_code error;
  address_ = state_.config.address == "localhost" ? asio::ip::address{asio::ip::address_v4::loopback()}
                                                  : asio::ip::make_address(state_.config.address, error);
  if (error) return Error{Errc::invalid_argument, "is not an IPv4 or IPv6 address", state_.config.address};
  SACCADE_CHECK(listen_on(address_));
  port_ = first_.port();
  state_.foxglove_is_open = state_.config.foxglove_only && address_.is_loopback();
  if (address_.is_unspecified()) {
    state_.host_names.insert(machine_name());
  } else {
    state_.host_names.insert(address_.to_string());
  }
  first_.accept();
  second_.accept();
  network_thread_ = std::thread{[this] { run_network(); }};
  return {};
}

void BeastServer::run_network() {
  for (;;) {
    try {
      network_.run();
      return;
    } catch (const std::exception&) {
      // The session with the failed handler has ended with it; the others continue.
    }
  }
}

std::string BeastServer::host() const {
  std::string host{"localhost"};
  if (address_.is_unspecified()) {
    host = machine_name();
  } else if (!address_.is_loopback()) {
    host = address_.is_v6() ? "[" + address_.to_string() + "]" : address_.to_string();
  }
  return host + ":" + std::to_string(port_);
}

}  // namespace

Status ServerConfig::validate() const {
  SACCADE_CHECK(check_token(token));
  for (const std::string& name : host_names) {
    if (host_name(name).empty()) return Error{Errc::invalid_argument, "is not a valid host name", name};
  }
  const bool limits = max_connections > 0 && max_message_bytes > 0 && max_waiting_messages > 0 &&
                      max_waiting_bytes > 0 && request_timeout.count() > 0 && idle_timeout.count() > 0;
  if (!limits) return Error{Errc::invalid_argument, "limits are positive", ""};
  return {};
}

std::string make_token() {
  constexpr std::string_view kDigits{"0123456789abcdef"};
  std::random_device random;  // the system's source
  std::string token;
  for (int word = 0; word < 4; ++word) {
    const unsigned bits = random();
    for (unsigned shift = 0; shift < 32; shift += 4) token += kDigits[(bits >> shift) & 0xfU];
  }
  return token;
}

Result<std::unique_ptr<HttpServer>> HttpServer::listen(const ServerConfig& config) {
  SACCADE_CHECK(config.validate());
  auto server = std::make_unique<BeastServer>(config);
  SACCADE_CHECK(server->open());
  return std::unique_ptr<HttpServer>{std::move(server)};
}

HttpServer::~HttpServer() = default;

}  // namespace saccade::server
