// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages of the WebSocket: a head of JSON and a body of arrays. docs/protocol.md.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "server/service.hpp"

namespace saccade::server {

/// corrupt_data for what is no JSON object, not UTF-8 or nested deeper than 32. Never throws; takes time and memory in
/// proportion to the text.
[[nodiscard]] Result<nlohmann::json> parse_object(std::string_view text);

struct ParsedMessage {
  nlohmann::json head;  ///< an object
  std::span<const std::uint8_t> body;
};

/// corrupt_data for what is no message: cut short, no JSON object, not UTF-8, nested deeper than 32. Never throws;
/// takes time and memory in proportion to the message. Padding that nothing follows may be left out.
[[nodiscard]] Result<ParsedMessage> parse_message(std::span<const std::uint8_t> message);

/// Builds a message: a head, then arrays one after the other.
class MessageWriter {
 public:
  explicit MessageWriter(const nlohmann::json& head);
  /// Of trivially copyable elements; the machine is little-endian.
  template <class T>
  void append(std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    bytes_.insert(bytes_.end(), first, first + bytes.size());
  }
  [[nodiscard]] SharedMessage finish() && { return std::make_shared<const Message>(std::move(bytes_)); }

 private:
  Message bytes_;
};

/// What a question asks, before its answer is looked for.
struct Question {
  std::string type;
  std::uint64_t request{0};
  nlohmann::json head;
};

/// invalid_argument without a type and a whole, positive request.
[[nodiscard]] Result<Question> parse_question(std::span<const std::uint8_t> message);
[[nodiscard]] nlohmann::json answer_head(const Question& question);
[[nodiscard]] SharedMessage refusal(std::uint64_t request, const Error& error);

}  // namespace saccade::server
