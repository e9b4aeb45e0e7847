// SPDX-License-Identifier: Apache-2.0
#pragma once
// FastNode: a node of an independent implementation, Fast DDS, on this machine alone; FastWriter, FastReader: its
// topics.

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <unistd.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

namespace saccade::test {

namespace fdds = eprosima::fastdds::dds;

/// Guarantees of a topic; the two are independent in ROS 2, too.
struct FastQos {
  bool reliable{true};
  bool latched{false};
};

template <class Qos>
void set_qos(Qos& qos, FastQos wanted) {
  qos.reliability().kind = wanted.reliable ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = wanted.latched ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 10;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
}

class FastNode {
 public:
  /// Programs that are started later join its domain, which no other process of the tests has.
  FastNode() {
    const int domain = 1 + static_cast<int>(::getpid()) % 200;
    ::setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
    ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
    fdds::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().user_transports.push_back(udp);
    participant_ =
        fdds::DomainParticipantFactory::get_instance()->create_participant(static_cast<fdds::DomainId_t>(domain), qos);
    if (participant_ == nullptr) throw std::runtime_error{"Fast DDS does not start"};
    publisher_ = participant_->create_publisher(fdds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT);
  }
  FastNode(const FastNode&) = delete;
  FastNode& operator=(const FastNode&) = delete;
  ~FastNode() {
    participant_->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  template <class PubSubType>
  [[nodiscard]] fdds::Topic* topic(const std::string& ros_name) {
    fdds::TypeSupport type{new PubSubType};
    type.register_type(participant_);
    const std::string name = "rt" + ros_name;
    if (auto* known = dynamic_cast<fdds::Topic*>(participant_->lookup_topicdescription(name))) return known;
    return participant_->create_topic(name, type.get_type_name(), fdds::TOPIC_QOS_DEFAULT);
  }
  [[nodiscard]] fdds::Publisher* publisher() { return publisher_; }
  [[nodiscard]] fdds::Subscriber* subscriber() { return subscriber_; }

 private:
  fdds::DomainParticipant* participant_{nullptr};
  fdds::Publisher* publisher_{nullptr};
  fdds::Subscriber* subscriber_{nullptr};
};

template <class PubSubType>
class FastWriter {
 public:
  FastWriter(FastNode& node, const std::string& topic, FastQos qos) : node_{node} {
    fdds::DataWriterQos writer_qos;
    set_qos(writer_qos, qos);
    writer_qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
    writer_ = node.publisher()->create_datawriter(node.topic<PubSubType>(topic), writer_qos);
    if (writer_ == nullptr) throw std::runtime_error{"no writer of " + topic};
  }
  FastWriter(const FastWriter&) = delete;
  FastWriter& operator=(const FastWriter&) = delete;
  ~FastWriter() { node_.publisher()->delete_datawriter(writer_); }
  void write(typename PubSubType::type message) { writer_->write(&message); }

 private:
  FastNode& node_;
  fdds::DataWriter* writer_;
};

/// Hands messages over in a thread of Fast DDS.
template <class PubSubType>
class FastReader : private fdds::DataReaderListener {
 public:
  using Message = typename PubSubType::type;
  FastReader(FastNode& node, const std::string& topic, FastQos qos, std::function<void(const Message&)> take)
      : node_{node}, take_{std::move(take)} {
    fdds::DataReaderQos reader_qos;
    set_qos(reader_qos, qos);
    reader_ = node.subscriber()->create_datareader(node.topic<PubSubType>(topic), reader_qos, this);
    if (reader_ == nullptr) throw std::runtime_error{"no reader of " + topic};
  }
  FastReader(const FastReader&) = delete;
  FastReader& operator=(const FastReader&) = delete;
  ~FastReader() override { node_.subscriber()->delete_datareader(reader_); }

 private:
  void on_data_available(fdds::DataReader* reader) override {
    Message message;
    fdds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) take_(message);
    }
  }
  FastNode& node_;
  std::function<void(const Message&)> take_;
  fdds::DataReader* reader_;
};

}  // namespace saccade::test
