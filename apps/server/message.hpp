// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages of the WebSocket: a head of JSON and a body of arrays. docs/reference/protocol.md.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "server/service.hpp"

namespace saccade::server {

/// Parses a JSON object. Answers corrupt_data for anything else, for text that is not UTF-8 or nested deeper than 32.
/// Never throws; takes time and memory in proportion to the text.
[[nodiscard]] Result<nlohmann::json> parse_object(std::string_view text);

struct ParsedMessage {
  nlohmann::json head;  ///< an object
  std::span<const std::uint8_t> body;
};

/// Parses a message. Answers corrupt_data for a truncated one, a head that is not a JSON object, not UTF-8, or nested
/// deeper than 32. Never throws; takes time and memory in proportion to the message. Final padding may be missing.
[[nodiscard]] Result<ParsedMessage> parse_message(std::span<const std::uint8_t> message);

/// Builder of a message: a head, then consecutive arrays.
class MessageWriter {
 public:
  explicit MessageWriter(const nlohmann::json& head);
  /// Appends an array of trivially copyable elements; the machine is little-endian.
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

/// Question before it is answered.
struct Question {
  std::string type;
  std::uint64_t request{0};
  nlohmann::json head;
};

/// Parses a question. Answers invalid_argument without a type and a positive integer request.
[[nodiscard]] Result<Question> parse_question(std::span<const std::uint8_t> message);
[[nodiscard]] nlohmann::json answer_head(const Question& question);
[[nodiscard]] SharedMessage refusal(std::uint64_t request, const Error& error);

}  // namespace saccade::server
