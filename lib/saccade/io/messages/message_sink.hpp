// SPDX-License-Identifier: Apache-2.0
#pragma once
// MessageSink: a destination of messages: a file, a server, a program that publishes them.

#include <span>
#include <string_view>

#include "saccade/io/messages/messages.hpp"

namespace saccade::messages {

/// Destination of messages. One caller at a time. An error is final: nothing more is added after it.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  /// Returns the layout in which it takes messages.
  [[nodiscard]] virtual Wire wire() const = 0;
  [[nodiscard]] virtual Status add(std::string_view topic, const MessageType& type, Time time,
                                   std::span<const std::byte> bytes) = 0;
  /// Called after each group of related messages.
  [[nodiscard]] virtual Status flush() { return {}; }
  /// Called at the end; nothing is added after it.
  [[nodiscard]] virtual Status finish() { return {}; }
};

}  // namespace saccade::messages
