// SPDX-License-Identifier: Apache-2.0
#pragma once
// PipedMessage, next_message: messages that Saccade writes to a publishing program (docs/guides/processes.md,
// Publishers). PublisherEnd: how long such a program runs. C++17, as libraries of some programs need.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace saccade::devices {

struct PipedMessage {
  std::string topic;
  std::string type;  ///< sensor_msgs/Image
  bool latched{false};
  nlohmann::json head;
  std::vector<std::byte> bytes;
};

constexpr std::uint32_t kMostHeadBytes{65536};
constexpr std::size_t kMostMessageBytes{std::size_t{1} << 30};

/// Reads exactly `size` bytes from standard input, or returns false at the end of the input. Calls idle() every second
/// while nothing comes.
inline bool read_input(void* to, std::size_t size, const std::function<void()>& idle) {
  for (std::size_t done = 0; done < size;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, 1000) == 0) {
      if (idle) idle();
      continue;
    }
    const ssize_t got = ::read(STDIN_FILENO, static_cast<char*>(to) + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

/// Waits for the next message; nullopt at the end of the input. Throws an error text.
inline std::optional<PipedMessage> next_message(const std::function<void()>& idle = {}) {
  std::array<unsigned char, 4> length{};
  if (!read_input(length.data(), length.size(), idle)) return std::nullopt;
  const std::uint32_t head_bytes = length[0] | (static_cast<std::uint32_t>(length[1]) << 8U) |
                                   (static_cast<std::uint32_t>(length[2]) << 16U) |
                                   (static_cast<std::uint32_t>(length[3]) << 24U);
  if (head_bytes > kMostHeadBytes) throw std::runtime_error{"the head of a message is too long: out of step"};
  std::string text(head_bytes, '\0');
  if (!read_input(text.data(), text.size(), idle)) return std::nullopt;
  PipedMessage message;
  message.head = nlohmann::json::parse(text);
  message.topic = message.head.at("topic").get<std::string>();
  message.type = message.head.at("type").get<std::string>();
  message.latched = message.head.value("latched", false);
  const auto size = message.head.at("bytes").get<std::size_t>();
  if (size > kMostMessageBytes) {
    throw std::runtime_error{"a message must have 1 GiB at most, not " + std::to_string(size) + " bytes"};
  }
  message.bytes.resize(size);
  if (!read_input(message.bytes.data(), size, idle)) return std::nullopt;
  return message;
}

/// End of a publishing program: waits for subscribers that are still finding the topics, or reading.
class PublisherEnd {
 public:
  /// To be told of each message.
  void published() {
    if (!first_) first_ = std::chrono::steady_clock::now();
  }
  /// Waits half a second, and until two seconds after the first message.
  void wait() const {
    if (!first_) return;
    const auto now = std::chrono::steady_clock::now();
    std::this_thread::sleep_until(std::max(now + std::chrono::milliseconds{500}, *first_ + std::chrono::seconds{2}));
  }

 private:
  std::optional<std::chrono::steady_clock::time_point> first_;
};

}  // namespace saccade::devices
