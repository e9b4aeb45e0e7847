// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages from and to clients of the Foxglove WebSocket protocol.

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace saccade::test {

inline std::string subscribe_text(const nlohmann::json& subscriptions) {
  return nlohmann::json{{"op", "subscribe"}, {"subscriptions", subscriptions}}.dump();
}

/// Returns the content of a message of binary data; nullopt for any other frame.
struct FoxgloveData {
  std::uint32_t subscription{0};
  std::uint64_t time_ns{0};
  std::string content;
  bool operator==(const FoxgloveData&) const = default;
};
inline std::optional<FoxgloveData> data_in(std::string_view bytes) {
  if (bytes.size() < 13 || bytes.front() != 1) return std::nullopt;
  FoxgloveData data;
  std::memcpy(&data.subscription, bytes.data() + 1, 4);
  std::memcpy(&data.time_ns, bytes.data() + 5, 8);
  data.content = bytes.substr(13);
  return data;
}

}  // namespace saccade::test
