// SPDX-License-Identifier: Apache-2.0
// Messages of Saccade's for ROS 1 (docs/guides/processes.md, Publishers).
//
//   saccade-ros1 publish [--timeout S]
//
// Publishes what comes on standard input: messages of any type, as ROS 1 serialises them, with the MD5 sum and the text
// of their definition. Waits --timeout seconds (3) for a master. Lasts half a second longer than its
// input, and two seconds from its first message on.
#include <topic_tools/shape_shifter.h>

#include <map>

#include "../../devices/message_input.hpp"
#include "../../devices/protocol.hpp"
#include "connection.hpp"
#include "subcommands.hpp"

namespace saccade::ros1 {
namespace {

constexpr std::uint32_t kQueued{2};  // messages of a topic that wait for a slow subscriber

class Publishers {
 public:
  explicit Publishers(double wait_s) : connection_{wait_s} {}

  void publish(devices::PipedMessage message) {
    idle();
    const auto [found, is_new] = topics_.try_emplace(message.topic);
    Topic& topic = found->second;
    const auto md5 = message.head.at("md5").get<std::string>();
    if (!is_new && topic.message.getMD5Sum() != md5) {
      throw std::runtime_error{message.topic + " has had another type before: " + topic.message.getDataType()};
    }
    topic.latched = message.latched;
    topic.message.morph(md5, message.type, message.head.value("definition", ""), "");
    ros::serialization::IStream stream{reinterpret_cast<std::uint8_t*>(message.bytes.data()),
                                       static_cast<std::uint32_t>(message.bytes.size())};
    topic.message.read(stream);
    if (is_new) advertise(message.topic, topic);
    topic.publisher.publish(topic.message);
  }

  /// Registers at a restarted master, and repeats all latched messages.
  void idle() {
    if (!connection_.forgotten()) return;
    for (auto& [name, topic] : topics_) topic.publisher.shutdown();
    for (auto& [name, topic] : topics_) {
      advertise(name, topic);
      if (topic.latched) topic.publisher.publish(topic.message);
    }
  }

 private:
  struct Topic {
    topic_tools::ShapeShifter message;  ///< the last one
    ros::Publisher publisher;
    bool latched{false};
  };

  void advertise(const std::string& name, Topic& topic) {
    topic.publisher = topic.message.advertise(connection_.node(), name, kQueued, topic.latched);
  }

  Connection connection_;
  std::map<std::string, Topic> topics_;
};

}  // namespace
}  // namespace saccade::ros1

int run_publish(int argc, char** argv) {
  using namespace saccade;
  ros1::begin_node(argc, argv, "saccade");
  devices::keep_output_for_answers();  // what roscpp says goes to standard error
  const devices::Options options{argc, argv};
  options.only({"--timeout"});
  ros1::Publishers publishers{options.number("--timeout", 3.0)};
  devices::PublisherEnd end;
  while (auto message = devices::next_message([&] { publishers.idle(); })) {
    publishers.publish(std::move(*message));
    end.published();
  }
  end.wait();
  return 0;
}
