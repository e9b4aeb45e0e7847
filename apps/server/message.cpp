// SPDX-License-Identifier: Apache-2.0
#include "server/message.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace saccade::server {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays of messages are little-endian");

constexpr std::size_t kLengthBytes{4};
constexpr int kDeepest{32};

using nlohmann::json;

std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

Result<json> parse_object(std::string_view text) {
  const Error broken{Errc::corrupt_data, "the head is not a JSON object", ""};
  if (text.find('\0') != std::string_view::npos) return broken;  // the parser would take it for the end
  bool too_deep{false};
  const auto watch_depth = [&too_deep](int depth, json::parse_event_t event, json& /*parsed*/) {
    const bool goes_down = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    too_deep = too_deep || (goes_down && depth >= kDeepest);
    return !too_deep;
  };
  json object = json::parse(text.begin(), text.end(), watch_depth, /*allow_exceptions=*/false);
  if (too_deep || !object.is_object()) return broken;
  return object;
}

Result<ParsedMessage> parse_message(std::span<const std::uint8_t> message) {
  if (message.size() < kLengthBytes) return Error{Errc::corrupt_data, "a message is at least four bytes long", ""};
  std::uint32_t length{0};
  std::memcpy(&length, message.data(), kLengthBytes);
  const std::span<const std::uint8_t> rest = message.subspan(kLengthBytes);
  if (length > rest.size()) return Error{Errc::corrupt_data, "the message ends within its head", ""};
  SACCADE_TRY(json head, parse_object({reinterpret_cast<const char*>(rest.data()), length}));
  const std::size_t body = std::min(padded(length), rest.size());
  for (const std::uint8_t zero : rest.subspan(length, body - length)) {
    if (zero != 0) return Error{Errc::corrupt_data, "between head and body there are only zeros", ""};
  }
  return ParsedMessage{std::move(head), rest.subspan(body)};
}

MessageWriter::MessageWriter(const json& head) {
  const std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace);
  const auto length = static_cast<std::uint32_t>(text.size());
  bytes_.resize(kLengthBytes + padded(text.size()));
  std::memcpy(bytes_.data(), &length, kLengthBytes);
  std::memcpy(bytes_.data() + kLengthBytes, text.data(), text.size());
}

Result<Question> parse_question(std::span<const std::uint8_t> message) {
  SACCADE_TRY(ParsedMessage parsed, parse_message(message));
  if (!parsed.body.empty()) return Error{Errc::invalid_argument, "questions have no body", ""};
  const auto type = parsed.head.find("type");
  const auto request = parsed.head.find("request");
  if (type == parsed.head.end() || !type->is_string()) return Error{Errc::invalid_argument, "has no type", ""};
  if (request == parsed.head.end() || !request->is_number_unsigned() || request->get<std::uint64_t>() == 0) {
    return Error{Errc::invalid_argument, "has no request, an integer from 1", ""};
  }
  return Question{type->get<std::string>(), request->get<std::uint64_t>(), std::move(parsed.head)};
}

json answer_head(const Question& question) { return {{"type", "answer"}, {"request", question.request}, {"ok", true}}; }

SharedMessage refusal(std::uint64_t request, const Error& error) {
  return MessageWriter{
      {{"type", "answer"},
       {"request", request},
       {"ok", false},
       {"error",
        {{"code", std::string{to_string(error.code)}}, {"message", error.message}, {"context", error.context}}}}}
      .finish();
}

}  // namespace saccade::server
