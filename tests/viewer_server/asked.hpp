// SPDX-License-Identifier: Apache-2.0
#pragma once
// RecordedClients: keeps what a service says. question_of: a question as it comes over the socket.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/message.hpp"
#include "server/service.hpp"

namespace saccade::test {

struct SaidMessage {
  nlohmann::json head;
  std::vector<std::uint8_t> body;
};

class RecordedClients final : public server::Clients {
 public:
  void send(server::ConnectionId to, server::SharedMessage message) override {
    const auto parsed = server::parse_message(*message);
    ASSERT_TRUE(parsed) << parsed.error().to_string();
    said_[to].push_back({parsed->head, {parsed->body.begin(), parsed->body.end()}});
  }
  void close(server::ConnectionId connection, std::uint16_t code, const std::string& /*reason*/) override {
    closed_[connection] = code;
  }

  /// All that was said to one connection since the last call.
  std::vector<SaidMessage> take(server::ConnectionId connection) { return std::exchange(said_[connection], {}); }
  /// 0: it was not closed.
  [[nodiscard]] std::uint16_t closed_with(server::ConnectionId connection) const {
    const auto found = closed_.find(connection);
    return found == closed_.end() ? std::uint16_t{0} : found->second;
  }

 private:
  std::map<server::ConnectionId, std::vector<SaidMessage>> said_;
  std::map<server::ConnectionId, std::uint16_t> closed_;
};

inline server::Message question_of(const nlohmann::json& head) { return *server::MessageWriter{head}.finish(); }

}  // namespace saccade::test
