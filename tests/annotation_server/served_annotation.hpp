// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServedAnnotation: the program, started with a page. PageSocket: a page of it, over a real socket.

#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "cli/run_program.hpp"
#include "server/raw_client.hpp"

namespace saccade::test {

class PageSocket {
 public:
  PageSocket(std::uint16_t port, const std::string& token, std::uint64_t client) : client_{port} {
    const auto answer =
        client_.ask(client_.upgrade_request("Host: " + client_.host() + "\r\n" + RawClient::token_line(token)));
    EXPECT_EQ(answer.status, 101);
    EXPECT_TRUE(ask({{"type", "hello"}, {"protocol", 1}, {"client", client}}).value("ok", false));
  }
  /// Its number; false once the program takes no more.
  bool send(nlohmann::json question) {
    question["request"] = ++request_;
    return client_.send_message(framed(question.dump()));
  }
  /// The head of the next message; nothing at the end.
  std::optional<nlohmann::json> receive(std::chrono::milliseconds patience = std::chrono::minutes{2}) {
    const auto message = client_.read_message(patience);
    if (!message || message->opcode != Opcode::binary || message->payload.size() < 4) return std::nullopt;
    std::uint32_t length{0};
    std::memcpy(&length, message->payload.data(), 4);
    return nlohmann::json::parse(message->payload.substr(4, length), nullptr, false);
  }
  nlohmann::json ask(nlohmann::json question) {
    send(question);
    while (auto head = receive()) {
      if (head->value("request", 0) == request_) return std::move(*head);
    }
    ADD_FAILURE() << "no answer to " << question.dump();
    return nlohmann::json::object();
  }
  nlohmann::json open(int cloud = 0, std::size_t budget = 100'000) {
    return ask({{"type", "open"}, {"cloud", cloud}, {"budget", budget}});
  }
  nlohmann::json act(nlohmann::json action) { return ask({{"type", "action"}, {"action", std::move(action)}}); }

 private:
  static std::string framed(const std::string& head) {
    const auto length = static_cast<std::uint32_t>(head.size());
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &length, 4);
    bytes += head;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
  }

  RawClient client_;
  int request_{0};
};

/// With a page in it, once connected.
class ServedAnnotation {
 public:
  explicit ServedAnnotation(const Arguments& arguments) : program_{arguments} {
    for (int i = 0; i < 24000 && program_.out().find("Ctrl-C ends it.") == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    const std::string url = program_.out();
    const std::size_t port_at = url.find("http://localhost:");
    const std::size_t token_at = url.find("/?token=");
    if (port_at == std::string::npos || token_at == std::string::npos) return;
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(port_at + 17)));
    token_ = url.substr(token_at + 8, url.find('\n', token_at) - token_at - 8);
  }
  [[nodiscard]] bool is_served() const { return port_ != 0; }
  [[nodiscard]] RunningProgram& program() { return program_; }
  [[nodiscard]] PageSocket page(std::uint64_t client) const { return {port_, token_, client}; }

  /// Over a new socket.
  void connect() { page_.emplace(page(77)); }
  nlohmann::json ask(nlohmann::json question) { return page_->ask(std::move(question)); }
  nlohmann::json open(int cloud = 0) { return page_->open(cloud); }
  nlohmann::json act(nlohmann::json action) { return page_->act(std::move(action)); }
  Answer get(const std::string& target) const {
    RawClient client{port_};
    return client.ask("GET " + target + " HTTP/1.1\r\nHost: " + client.host() + "\r\n" + RawClient::token_line(token_) +
                      "\r\n");
  }

 private:
  RunningProgram program_;
  std::uint16_t port_{0};
  std::string token_;
  std::optional<PageSocket> page_;
};

}  // namespace saccade::test
