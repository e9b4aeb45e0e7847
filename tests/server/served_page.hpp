// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServedPage: a server with a service that does what a test likes, and a good client to see that it still answers.

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http_server.hpp"
#include "server/raw_client.hpp"
#include "support/effort.hpp"

namespace saccade::test {

using server::ConnectionId;

inline constexpr std::size_t kMiB{1U << 20U};

inline server::SharedMessage message_of(std::string_view text) {
  return std::make_shared<const server::Message>(text.begin(), text.end());
}

/// Sends every message back unless the test has something else in mind.
class EchoService : public server::Service {
 public:
  explicit EchoService(server::Clients& clients) : clients_{clients} {}

  std::function<void(ConnectionId, const std::string&)> on_message;
  std::function<server::HttpAnswer(const server::HttpRequest&)> on_get;
  std::atomic<int> opened_count{0};
  std::atomic<int> closed_count{0};
  std::atomic<std::size_t> received_count{0};
  std::atomic<bool> several_at_once{false};  ///< two calls at the same time

  void opened(ConnectionId /*connection*/) override {
    const Alone alone{*this};
    ++opened_count;
  }
  void received(ConnectionId connection, std::span<const std::uint8_t> message) override {
    const Alone alone{*this};
    ++received_count;
    const std::string text{message.begin(), message.end()};
    if (on_message) return on_message(connection, text);
    clients_.send(connection, message_of(text));
  }
  void closed(ConnectionId /*connection*/) override {
    const Alone alone{*this};
    ++closed_count;
  }
  server::HttpAnswer get(const server::HttpRequest& request) override {
    const Alone alone{*this};
    if (on_get) return on_get(request);
    return {404, "text/plain", "", {}};
  }

 private:
  struct Alone {
    explicit Alone(EchoService& service) : calls{service.calls_} {
      if (++calls != 1) service.several_at_once = true;
    }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;
    ~Alone() { --calls; }
    std::atomic<int>& calls;
  };
  server::Clients& clients_;
  std::atomic<int> calls_{0};
};

/// Returns the memory of this process, MiB; 0 under sanitizers, which need memory of their own.
inline double resident_mib() {
  if (kSanitized) return 0.0;
  std::ifstream pages{"/proc/self/statm"};
  double all{0};
  double resident{0};
  pages >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

/// Tells whether it comes true, on a machine however busy.
inline bool eventually(const std::function<bool()>& condition,
                       std::chrono::seconds patience = std::chrono::seconds{30}) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  return true;
}

class ServedPage : public ::testing::Test {
 protected:
  static server::ServerConfig config() {
    server::ServerConfig made;
    made.token = kToken;
    return made;
  }
  void begin(const server::ServerConfig& config) {
    auto begun = server::HttpServer::listen(config);
    ASSERT_TRUE(begun) << begun.error().to_string();
    server_ = std::move(*begun);
    service_ = std::make_unique<EchoService>(*server_);
  }
  void SetUp() override {
    begin(config());
    server_->serve(*service_);
  }
  void TearDown() override {
    server_.reset();
    EXPECT_EQ(service_->opened_count, service_->closed_count);
    EXPECT_FALSE(service_->several_at_once);
  }
  [[nodiscard]] RawClient client(int receive_bytes = 0) const { return RawClient{server_->port(), receive_bytes}; }
  /// One that has a WebSocket.
  [[nodiscard]] RawClient socket(int receive_bytes = 0) const {
    RawClient made = client(receive_bytes);
    EXPECT_EQ(made.upgrade(), 101);
    return made;
  }
  void expect_that_a_good_client_is_answered() const {
    service_->on_message = nullptr;
    RawClient good = client();
    EXPECT_EQ(good.get("/").status, 200);
    ASSERT_EQ(good.upgrade(), 101);
    good.send_message("good day");
    const auto echoed = good.read_message();
    ASSERT_TRUE(echoed);
    EXPECT_EQ(echoed->payload, "good day");
  }

  std::unique_ptr<server::HttpServer> server_;
  std::unique_ptr<EchoService> service_;
};

}  // namespace saccade::test
