// SPDX-License-Identifier: Apache-2.0
#pragma once
// HttpServer: the page, its WebSocket and its files for clients with the token; a run for Foxglove.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "server/service.hpp"

namespace saccade::server {

class FoxgloveHub;

struct ServerConfig {
  std::string address{"127.0.0.1"};         ///< address to listen on
  std::uint16_t port{0};                    ///< 0: any free port
  std::string token;                        ///< at least 16 letters, digits, - and _
  std::vector<std::string> host_names;      ///< accepted in a Host header besides this machine
  std::shared_ptr<FoxgloveHub> foxglove{};  ///< content of /foxglove; null: not served
  /// Serves no page: Foxglove is served at / as well, and needs no token on a loopback address.
  bool foxglove_only{false};
  std::size_t max_connections{64};  ///< limit of WebSockets until fully served; further ones get 503
  std::size_t max_message_bytes{1U << 20U};
  std::size_t max_waiting_messages{32};  ///< per connection and not yet seen by the service; then it is not read from
  std::size_t max_waiting_bytes{64U << 20U};          ///< not yet read by a connection; then it is ended
  std::chrono::milliseconds request_timeout{10'000};  ///< for a request's headers, and for each part of its answer
  std::chrono::milliseconds idle_timeout{60'000};     ///< limit of silence of a WebSocket that does not answer pings
                                                      ///< either

  [[nodiscard]] Status validate() const;
};

/// Returns a token of 128 random bits.
[[nodiscard]] std::string make_token();

/// Server that listens from its creation to its end. One thread for the network, one for the service. Before serve() it
/// delivers the page, and answers 503 to requests that need the service; the page then tries again.
class HttpServer : public Clients {
 public:
  /// @return unavailable where the port is taken or the address does not belong to this machine; invalid_argument.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> listen(const ServerConfig& config);
  /// Ends every connection (1001), notifies the service, performs posted work, and joins its threads. Questions that
  /// the service has not seen are dropped.
  ~HttpServer() override;

  /// Starts answering requests. `service` must outlive the server. Call it once.
  virtual void serve(Service& service) = 0;
  /// Runs work on the service's thread, after earlier posts and before questions of connections. `work` must not throw.
  virtual void post(std::function<void()> work) = 0;

  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// Returns "http://localhost:PORT/?token=TOKEN", with the address where that is not loopback.
  [[nodiscard]] virtual std::string url() const = 0;
  /// Returns "ws://localhost:PORT/foxglove", with the token where needed.
  [[nodiscard]] virtual std::string foxglove_url() const = 0;
};

}  // namespace saccade::server
