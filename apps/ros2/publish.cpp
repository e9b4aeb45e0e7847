// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "commands.hpp"
#include "devices/message_input.hpp"
#include "node.hpp"

namespace saccade::ros2 {
namespace {

constexpr double kFlush_s{1.0};  // for readers that have not acknowledged all

/// Returns sensor_msgs::msg::dds_::Image_ for sensor_msgs/Image and for sensor_msgs/msg/Image.
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
  void publish(const devices::PipedMessage& message) {
    if (message.bytes.size() < 4) throw std::runtime_error{"a message of " + message.topic + " has no header of CDR"};
    const std::string type = dds_name_of(message.type);
    Topic& found = topics_[message.topic];
    if (!found.writer) {
      found.type = type;
      found.writer = std::make_unique<RawWriter>(node_, message.topic, type,
                                                 message.latched ? Delivery::latched : Delivery::reliable);
    }
    if (found.type != type) throw std::runtime_error{message.topic + " has had another type before: " + found.type};
    try {
      found.writer->write(message.bytes);
    } catch (const std::exception& e) {
      if (!std::exchange(found.said, true)) std::cerr << message.topic << ": " << e.what() << '\n';
    }
  }

  /// Waits until readers have everything, at most for the given time.
  void flush(double longest_s) {
    const double until_s = devices::now_s() + longest_s;
    for (const auto& [name, topic] : topics_) topic.writer->flush(until_s - devices::now_s());
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
  devices::PublisherEnd end;
  while (const auto message = devices::next_message()) {
    publishers.publish(*message);
    end.published();
  }
  end.wait();
  publishers.flush(kFlush_s);
  return 0;
}

}  // namespace saccade::ros2
