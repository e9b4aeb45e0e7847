// SPDX-License-Identifier: Apache-2.0
#pragma once
// HttpServer: the page, its WebSocket and its files, for those who know the token; a run for Foxglove.

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
  std::string address{"127.0.0.1"};         ///< that is listened on
  std::uint16_t port{0};                    ///< 0: one that is free
  std::string token;                        ///< at least 16 letters, digits, - and _
  std::vector<std::string> host_names;      ///< that a Host header may name besides this machine
  std::shared_ptr<FoxgloveHub> foxglove{};  ///< what /foxglove sends; null: there is no such place
  /// No page: Foxglove's place is / as well, and on a loopback address Foxglove needs no token.
  bool foxglove_only{false};
  std::size_t max_connections{64};  ///< WebSockets, until they are served to their end; then 503
  std::size_t max_message_bytes{1U << 20U};
  std::size_t max_waiting_messages{32};  ///< of one connection, that the service has not seen; then it is not read from
  std::size_t max_waiting_bytes{64U << 20U};          ///< that a connection has not read; then it is ended
  std::chrono::milliseconds request_timeout{10'000};  ///< for a request's headers, and for each part of its answer
  std::chrono::milliseconds idle_timeout{60'000};     ///< of a WebSocket that does not answer pings, either

  [[nodiscard]] Status validate() const;
};

/// A token of 128 random bits.
[[nodiscard]] std::string make_token();

/// Listens from its creation to its end. One thread for the network, one for the service. Before serve() it gives out
/// the page; to what needs the service it answers 503, and the page asks again.
class HttpServer : public Clients {
 public:
  /// @return unavailable where the port is taken or the address is not this machine's; invalid_argument.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> listen(const ServerConfig& config);
  /// Ends every connection (1001), tells the service so, does what was posted, and joins its threads. What connections
  /// have asked and the service has not seen is not asked any more.
  ~HttpServer() override;

  /// From here on requests are answered. `service` outlives the server. Called once.
  virtual void serve(Service& service) = 0;
  /// Runs on the service's thread, after what was posted before, and before what connections ask. `work` does not
  /// throw.
  virtual void post(std::function<void()> work) = 0;

  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// "http://localhost:PORT/?token=TOKEN", of the address where that is not loopback.
  [[nodiscard]] virtual std::string url() const = 0;
  /// "ws://localhost:PORT/foxglove", with the token where it is needed.
  [[nodiscard]] virtual std::string foxglove_url() const = 0;
};

}  // namespace saccade::server
