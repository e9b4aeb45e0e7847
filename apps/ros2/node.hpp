// SPDX-License-Identifier: Apache-2.0
#pragma once
// Topics of ROS 2 over DDS: Node (a participant), Reader and Writer of one topic, Delivery (the guarantees of a topic).

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

/// Guarantee that a reader requests, and a writer offers.
enum class Delivery {
  best_effort,  ///< as for sensor data: such a reader also receives from reliable writers
  reliable,     ///< ROS 2's default
  latched       ///< reliable, and the last message is kept for later readers (transient local)
};

/// Entity of DDS, which it deletes at its end.
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

/// Participant in the domain of ROS_DOMAIN_ID, restricted to this machine where ROS_LOCALHOST_ONLY=1 or
/// ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST is set. Throws an error text. Readers and writers must end before it.
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

/// Reader of one topic, as bytes of CDR.
class RawReader {
 public:
  using Take = std::function<void(std::span<const std::byte>)>;

  /// @param name as in ROS, with or without the first slash
  RawReader(const Node& node, const std::string& name, const std::string& dds_type, Delivery delivery, int depth);
  /// Passes on received messages, oldest first.
  void take(const Take& take);
  /// Waits until a message arrives, at most for the given time.
  void wait(double longest_s) const;
  /// Returns the number of writers.
  [[nodiscard]] int writers() const;
  /// Describes, for an error, which publishers are known.
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
  /// Throws when sending fails, as when a reliable reader takes nothing for 100 ms.
  void write(std::span<const std::byte> cdr);
  /// Returns the number of readers.
  [[nodiscard]] int readers() const;
  /// Waits until reliable readers have everything, at most for the given time.
  void flush(double longest_s) const;

 private:
  ddsi_sertype* type_{nullptr};
  Entity topic_;
  Entity writer_;
};

/// Reader of typed messages. Unreadable messages are skipped and reported once.
template <class Message>
class Reader {
 public:
  Reader(const Node& node, std::string name, Delivery delivery, int depth = 10)
      : name_{std::move(name)}, reader_{node, name_, messages::type_of<Message>().dds_name(), delivery, depth} {}

  /// Returns received messages, oldest first.
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
  /// Waits for a message, then works as take().
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
