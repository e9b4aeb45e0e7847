// SPDX-License-Identifier: Apache-2.0
#include "node.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

#include "raw_type.hpp"

namespace saccade::ros2 {
namespace {

constexpr int kPublisherDepth{10};
constexpr std::uint32_t kLargestDomain{232};  // its ports would be beyond 65535 otherwise

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::uint32_t domain_of_environment() {
  const std::string text = environment("ROS_DOMAIN_ID");
  if (text.empty()) return 0;
  const bool digits = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  const unsigned long domain = digits && text.size() < 5 ? std::stoul(text) : kLargestDomain + 1;
  if (domain > kLargestDomain) {
    throw std::runtime_error{"ROS_DOMAIN_ID must be 0 to 232, not '" + text + "'"};
  }
  return static_cast<std::uint32_t>(domain);
}

bool this_machine_alone() {
  return environment("ROS_LOCALHOST_ONLY") == "1" || environment("ROS_AUTOMATIC_DISCOVERY_RANGE") == "LOCALHOST";
}

/// Returns an entity's handle, or throws an error text.
dds_entity_t made(dds_entity_t handle, const std::string& what) {
  if (handle < 0) throw std::runtime_error{what + ": " + dds_strretcode(handle)};
  return handle;
}

/// Contacts others on this machine at their ports, because multicast may fail on the loopback interface.
Entity* local_domain(std::uint32_t domain) {
  const std::string config =
      "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>"
      "</Domain></CycloneDDS>";
  const std::string users = environment("CYCLONEDDS_URI");
  return new Entity{made(dds_create_domain(domain, (users.empty() ? config : config + "," + users).c_str()),
                         "the domain of DDS cannot be set up on this machine alone")};
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

Qos qos_of(Delivery delivery, int depth) {
  Qos qos{dds_create_qos()};
  const bool reliable = delivery != Delivery::best_effort;
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
  dds_qset_durability(qos.get(),
                      delivery == Delivery::latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, -1, -1, -1);
  return qos;
}

dds_entity_t topic_of(const Node& node, const std::string& name, const std::string& dds_type,
                      ddsi_sertype** actual_type = nullptr) {
  if (name.empty() || name == "/") throw std::runtime_error{"a topic needs a name"};
  ddsi_sertype* type = new_raw_type(dds_type);
  const std::string dds_name = (name.front() == '/' ? "rt" : "rt/") + name;
  const dds_entity_t topic =
      dds_create_topic_sertype(node.participant(), dds_name.c_str(), &type, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(type);
  if (actual_type != nullptr) *actual_type = type;
  return made(topic, "the topic " + name + " of type " + dds_type + " cannot be used");
}

dds_duration_t dds_duration(double seconds) { return static_cast<dds_duration_t>(1e9 * std::max(seconds, 0.0)); }

}  // namespace

Entity::~Entity() {
  if (handle_ > 0) dds_delete(handle_);
}

Node::Node() : domain_{domain_of_environment()} {
  if (this_machine_alone()) created_domain_.reset(local_domain(domain_));
  participant_ = std::make_unique<Entity>(made(dds_create_participant(domain_, nullptr, nullptr),
                                               "DDS cannot be started; is there a network interface that is up?"));
}

RawReader::RawReader(const Node& node, const std::string& name, const std::string& dds_type, Delivery delivery,
                     int depth)
    : domain_{node.domain()},
      topic_{topic_of(node, name, dds_type)},
      reader_{made(dds_create_reader(node.participant(), topic_.handle(), qos_of(delivery, depth).get(), nullptr),
                   name + " cannot be read")},
      wait_set_{made(dds_create_waitset(node.participant()), name + " cannot be waited for")} {
  dds_set_status_mask(reader_.handle(), DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(wait_set_.handle(), reader_.handle(), 0);
}

void RawReader::take(const Take& take) {
  for (;;) {
    std::array<ddsi_serdata*, 8> taken{};
    std::array<dds_sample_info_t, 8> info{};
    const dds_return_t count = dds_takecdr(reader_.handle(), taken.data(), static_cast<std::uint32_t>(taken.size()),
                                           info.data(), DDS_ANY_STATE);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (info[i].valid_data) take(bytes_of(taken[i]));
      ddsi_serdata_unref(taken[i]);
    }
  }
}

void RawReader::wait(double longest_s) const {
  dds_attach_t cause{};
  dds_waitset_wait(wait_set_.handle(), &cause, 1, dds_duration(longest_s));
}

int RawReader::writers() const {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(reader_.handle(), &status) < 0 ? 0
                                                                            : static_cast<int>(status.current_count);
}

std::string RawReader::publishers() const {
  dds_requested_incompatible_qos_status_t refused{};
  dds_get_requested_incompatible_qos_status(reader_.handle(), &refused);
  const int count = writers();
  if (count > 0) return "publishers: " + std::to_string(count);
  if (refused.total_count > 0) return "its publisher's QoS does not fit";
  return "nothing publishes it with this type in domain " + std::to_string(domain_) + " (ROS_DOMAIN_ID)";
}

RawWriter::RawWriter(const Node& node, const std::string& name, const std::string& dds_type, Delivery delivery)
    : topic_{topic_of(node, name, dds_type, &type_)},
      writer_{
          made(dds_create_writer(node.participant(), topic_.handle(),
                                 qos_of(delivery, delivery == Delivery::latched ? 1 : kPublisherDepth).get(), nullptr),
               name + " cannot be published")} {}

void RawWriter::write(std::span<const std::byte> cdr) {
  const dds_return_t status = dds_writecdr(writer_.handle(), raw_message(type_, cdr));
  if (status < 0) throw std::runtime_error{std::string{"a message cannot be published: "} + dds_strretcode(status)};
}

int RawWriter::readers() const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer_.handle(), &status) < 0 ? 0 : static_cast<int>(status.current_count);
}

void RawWriter::flush(double longest_s) const { dds_wait_for_acks(writer_.handle(), dds_duration(longest_s)); }

}  // namespace saccade::ros2
