// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands.hpp"
#include "node.hpp"

namespace saccade::ros2 {
namespace {

constexpr std::uint32_t kMostHeadBytes{65536};
constexpr std::size_t kMostMessageBytes{std::size_t{1} << 30};
constexpr std::chrono::milliseconds kLastsAfterEnd{500};

/// Reads all of it, or returns false at the end of the input.
bool read_input(void* bytes, std::size_t size) {
  return std::cin.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size)).good();
}

/// sensor_msgs::msg::dds_::Image_ for sensor_msgs/Image and for sensor_msgs/msg/Image.
std::string dds_name_of(const std::string& type) {
  const std::size_t first = type.find('/');
  const std::size_t last = type.rfind('/');
  if (first == std::string::npos || first == 0 || last + 1 == type.size()) {
    throw std::runtime_error{"'" + type + "' is no type of ROS, as sensor_msgs/Image is"};
  }
  return type.substr(0, first) + "::msg::dds_::" + type.substr(last + 1) + "_";
}

class Publishers {
 public:
  void publish(const nlohmann::json& head, std::span<const std::byte> cdr) {
    const std::string topic = head.at("topic");
    const std::string type = dds_name_of(head.at("type"));
    Topic& found = topics_[topic];
    if (!found.writer) {
      found.type = type;
      found.writer = std::make_unique<RawWriter>(node_, topic, type,
                                                 head.value("latched", false) ? Delivery::latched : Delivery::reliable);
    }
    if (found.type != type) throw std::runtime_error{topic + " has had another type before: " + found.type};
    try {
      found.writer->write(cdr);
    } catch (const std::exception& e) {
      if (!std::exchange(found.said, true)) std::cerr << topic << ": " << e.what() << '\n';
    }
  }

 private:
  struct Topic {
    std::string type;
    std::unique_ptr<RawWriter> writer;
    bool said{false};
  };
  Node node_;
  std::map<std::string, Topic> topics_;
};

}  // namespace

int run_publish(const devices::Options& options) {
  options.only({""});
  Publishers publishers;
  for (;;) {
    std::array<unsigned char, 4> length{};
    if (!read_input(length.data(), length.size())) break;
    const std::uint32_t head_bytes = length[0] | (static_cast<std::uint32_t>(length[1]) << 8U) |
                                     (static_cast<std::uint32_t>(length[2]) << 16U) |
                                     (static_cast<std::uint32_t>(length[3]) << 24U);
    if (head_bytes > kMostHeadBytes) throw std::runtime_error{"the head of a message is too long: out of step"};
    std::string text(head_bytes, '\0');
    if (!read_input(text.data(), text.size())) break;
    const nlohmann::json head = nlohmann::json::parse(text);
    const auto size = head.at("bytes").get<std::size_t>();
    if (size < 4 || size > kMostMessageBytes) {
      throw std::runtime_error{"a message must have 4 bytes to 1 GiB, not " + std::to_string(size)};
    }
    std::vector<std::byte> cdr(size);
    if (!read_input(cdr.data(), cdr.size())) break;
    publishers.publish(head, cdr);
  }
  std::this_thread::sleep_for(kLastsAfterEnd);
  return 0;
}

}  // namespace saccade::ros2
