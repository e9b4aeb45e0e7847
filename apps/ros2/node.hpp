// SPDX-License-Identifier: Apache-2.0
#pragma once
// Topics of ROS 2 over DDS: Node (a participant), Reader and Writer of one topic, Delivery (what a topic promises).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/io/messages/messages.hpp"

struct ddsi_sertype;

namespace saccade::ros2 {

/// What a reader asks for, and a writer offers.
enum class Delivery {
  best_effort,  ///< as sensor data: a reader that asks for it hears reliable writers, too
  reliable,     ///< ROS 2's default
  latched       ///< reliable, and the last message is kept for readers that come later (transient local)
};

/// An entity of DDS, which ends with it.
class Entity {
 public:
  explicit Entity(std::int32_t handle = 0) : handle_{handle} {}
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity();
  [[nodiscard]] std::int32_t handle() const { return handle_; }

 private:
  std::int32_t handle_;
};

/// Takes part in the domain that ROS_DOMAIN_ID says, on this machine alone where ROS_LOCALHOST_ONLY=1 or
/// ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST say so. Throws what is wrong. Readers and writers must end before it.
class Node {
 public:
  Node();
  [[nodiscard]] std::int32_t participant() const { return participant_->handle(); }
  [[nodiscard]] std::uint32_t domain() const { return domain_; }

 private:
  std::uint32_t domain_;
  std::unique_ptr<Entity> created_domain_;
  std::unique_ptr<Entity> participant_;
};

/// Messages of one topic, as bytes of CDR.
class RawReader {
 public:
  using Take = std::function<void(std::span<const std::byte>)>;

  /// @param name of ROS, with or without the first slash
  RawReader(const Node& node, const std::string& name, const std::string& dds_type, Delivery delivery, int depth);
  /// Hands over what has come, the oldest first.
  void take(const Take& take);
  /// Waits until something has come, no longer than given.
  void wait(double longest_s) const;
  /// How many writers there are.
  [[nodiscard]] int writers() const;
  /// Says, for an error, what is known about who publishes.
  [[nodiscard]] std::string publishers() const;

 private:
  std::uint32_t domain_;
  Entity topic_;
  Entity reader_;
  Entity wait_set_;
};

class RawWriter {
 public:
  RawWriter(const Node& node, const std::string& name, const std::string& dds_type, Delivery delivery);
  /// Throws when it cannot be sent, as when a reliable reader takes nothing for 100 ms.
  void write(std::span<const std::byte> cdr);
  /// How many readers there are.
  [[nodiscard]] int readers() const;
  /// Waits until reliable readers have it all, no longer than given.
  void flush(double longest_s) const;

 private:
  ddsi_sertype* type_{nullptr};
  Entity topic_;
  Entity writer_;
};

/// Messages of one topic. What cannot be read is passed over, and said once.
template <class Message>
class Reader {
 public:
  Reader(const Node& node, std::string name, Delivery delivery, int depth = 10)
      : name_{std::move(name)}, reader_{node, name_, messages::type_of<Message>().dds_name(), delivery, depth} {}

  /// Returns what has come, the oldest first.
  [[nodiscard]] std::vector<Message> take() {
    std::vector<Message> came;
    reader_.take([&](std::span<const std::byte> cdr) {
      auto message = messages::read_message<Message>(messages::Wire::cdr, cdr);
      if (message) {
        came.push_back(*std::move(message));
      } else if (!std::exchange(said_, true)) {
        std::cerr << "a message on " << name_ << " was passed over: " << message.error().to_string() << '\n';
      }
    });
    return came;
  }
  /// As take(), after waiting for something to come.
  [[nodiscard]] std::vector<Message> wait(double longest_s) {
    reader_.wait(longest_s);
    return take();
  }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string publishers() const { return reader_.publishers(); }

 private:
  std::string name_;
  RawReader reader_;
  bool said_{false};
};

}  // namespace saccade::ros2
