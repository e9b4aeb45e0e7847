// SPDX-License-Identifier: Apache-2.0
// The protocol: https://github.com/foxglove/ws-protocol, docs/spec.md.
#include "server/foxglove/foxglove_client.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "server/message.hpp"

namespace saccade::server {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kSubprotocols{"foxglove.sdk.v1", "foxglove.websocket.v1"};
constexpr std::size_t kMostTexts{32};  ///< limit of texts that a client has not read; then it is not read from
constexpr std::size_t kMostEchoed{40};
constexpr char kMessageData{1};
constexpr int kWarning{1};
constexpr int kError{2};

std::string text_of(const json& document) { return document.dump(-1, ' ', false, json::error_handler_t::replace); }

json channel_json(const FoxgloveChannel& channel) {
  return {{"id", channel.id},
          {"topic", channel.topic},
          {"encoding", "cdr"},
          {"schemaName", channel.schema_name},
          {"schemaEncoding", "ros2msg"},
          {"schema", channel.schema}};
}

std::string status_text(int level, const std::string& message) {
  return text_of({{"op", "status"}, {"level", level}, {"message", message}});
}

template <class Number>
void append_little_endian(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i) bytes += static_cast<char>((number >> (8U * i)) & 0xffU);
}

/// Returns a 32-bit integer.
std::optional<std::uint32_t> id_in(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> id_in(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return std::nullopt;
  return id_in(object.at(key));
}

}  // namespace

std::string_view foxglove_subprotocol(std::string_view offered) {
  while (!offered.empty()) {
    std::string_view name = offered.substr(0, offered.find(','));
    offered.remove_prefix(std::min(name.size() + 1, offered.size()));
    while (name.starts_with(' ') || name.starts_with('\t')) name.remove_prefix(1);
    while (name.ends_with(' ') || name.ends_with('\t')) name.remove_suffix(1);
    const auto* const known = std::find(kSubprotocols.begin(), kSubprotocols.end(), name);
    if (known != kSubprotocols.end()) return *known;
  }
  return {};
}

FoxgloveClient::FoxgloveClient(const std::string& session, std::span<const FoxgloveChannel> channels) {
  texts_.push_back(
      text_of({{"op", "serverInfo"}, {"name", "saccade"}, {"capabilities", json::array()}, {"sessionId", session}}));
  json advertised = json::array();
  for (const FoxgloveChannel& channel : channels) advertised.push_back(channel_json(channel));
  texts_.push_back(text_of({{"op", "advertise"}, {"channels", std::move(advertised)}}));
}

void FoxgloveClient::advertise(const FoxgloveChannel& channel) {
  texts_.push_back(text_of({{"op", "advertise"}, {"channels", json::array({channel_json(channel)})}}));
}

void FoxgloveClient::received(bool is_text, std::string_view message, std::span<const FoxgloveChannel> channels) {
  const std::optional<Wrong> wrong =
      is_text ? answer(message, channels) : Wrong{kError, "this server takes no messages from clients"};
  if (wrong) texts_.push_back(status_text(wrong->level, wrong->text));
}

std::optional<FoxgloveClient::Wrong> FoxgloveClient::answer(std::string_view text,
                                                            std::span<const FoxgloveChannel> channels) {
  const Result<json> parsed = parse_object(text);
  if (!parsed || !parsed->contains("op") || !parsed->at("op").is_string()) {
    return Wrong{kError, "this is not a message of the protocol: a JSON object with op"};
  }
  const std::string op = parsed->at("op").get<std::string>();
  const bool subscribes = op == "subscribe";
  if (!subscribes && op != "unsubscribe") {
    return Wrong{kError, "this server does not know the operation " + op.substr(0, kMostEchoed)};
  }
  const char* const key = subscribes ? "subscriptions" : "subscriptionIds";
  if (!parsed->contains(key) || !parsed->at(key).is_array()) return Wrong{kError, op + " needs " + key + ", an array"};
  std::optional<Wrong> first;
  for (const json& entry : parsed->at(key)) {
    const auto id = subscribes ? id_in(entry, "id") : id_in(entry);
    const auto channel = id_in(entry, "channelId");
    std::optional<Wrong> wrong;
    if (!id || (subscribes && !channel)) {
      wrong = Wrong{kError, op + " needs " + (subscribes ? "id and channelId, whole numbers" : "whole numbers")};
    } else {
      wrong = subscribes ? subscribe(*id, *channel, channels) : unsubscribe(*id);
    }
    if (wrong && !first) first = std::move(wrong);
  }
  return first;
}

std::optional<FoxgloveClient::Wrong> FoxgloveClient::subscribe(std::uint32_t subscription, std::uint32_t channel,
                                                               std::span<const FoxgloveChannel> channels) {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [channel](const FoxgloveChannel& known) { return known.id == channel; });
  if (found == channels.end()) return Wrong{kError, "there is no channel " + std::to_string(channel)};
  if (subscriptions_.contains(channel)) {
    return Wrong{kError, "channel " + std::to_string(channel) + " has a subscription already"};
  }
  const bool is_used = std::any_of(subscriptions_.begin(), subscriptions_.end(),
                                   [subscription](const auto& entry) { return entry.second == subscription; });
  if (is_used) return Wrong{kError, "subscription " + std::to_string(subscription) + " is there already"};
  subscriptions_.emplace(channel, subscription);
  if (found->newest) waiting_.push_back({channel, found->newest});
  return std::nullopt;
}

std::optional<FoxgloveClient::Wrong> FoxgloveClient::unsubscribe(std::uint32_t subscription) {
  const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                  [subscription](const auto& entry) { return entry.second == subscription; });
  if (found == subscriptions_.end()) {
    return Wrong{kWarning, "there is no subscription " + std::to_string(subscription)};
  }
  std::erase_if(waiting_, [channel = found->first](const Waiting& waiting) { return waiting.channel == channel; });
  subscriptions_.erase(found);
  return std::nullopt;
}

void FoxgloveClient::send(std::uint32_t channel, const SharedFoxgloveMessage& message) {
  if (!subscriptions_.contains(channel)) return;
  const auto waiting = std::find_if(waiting_.begin(), waiting_.end(),
                                    [channel](const Waiting& other) { return other.channel == channel; });
  if (waiting == waiting_.end()) {
    waiting_.push_back({channel, message});
  } else {
    waiting->message = message;  // keeps its place, so that a slow client gets messages of every channel in turn
  }
}

std::optional<FoxgloveFrame> FoxgloveClient::next() {
  FoxgloveFrame frame;
  if (!texts_.empty()) {
    frame.head = std::move(texts_.front());
    texts_.pop_front();
    return frame;
  }
  if (waiting_.empty()) return std::nullopt;
  const Waiting waiting = std::move(waiting_.front());
  waiting_.pop_front();
  frame.is_text = false;
  frame.head = kMessageData;
  append_little_endian(frame.head, subscriptions_.at(waiting.channel));
  append_little_endian(frame.head, waiting.message->time_ns);
  frame.message = waiting.message;
  return frame;
}

bool FoxgloveClient::may_read() const { return texts_.size() < kMostTexts; }

}  // namespace saccade::server
