// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include "saccade/io/bags/bags.hpp"
#include "saccade/io/bags/internal/tf_buffer.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace internal::io_bags {
namespace {

constexpr std::array<std::string_view, 3> kHandTypes{"geometry_msgs/PoseStamped", "geometry_msgs/PointStamped",
                                                     "geometry_msgs/TransformStamped"};

struct HandReading {
  messages::Header header;
  messages::Pose pose;
  bool has_rotation{true};
};

Result<HandReading> read_hand_message(const BagMessage& message) {
  if (!message.wire) return Error{Errc::unsupported, "the topic is not encoded as messages of ROS are", {}};
  if (message.type == kHandTypes[0]) {
    SACCADE_TRY(const auto pose, messages::read_message<messages::PoseStamped>(*message.wire, message.bytes));
    return HandReading{pose.header, pose.pose, true};
  }
  if (message.type == kHandTypes[1]) {
    SACCADE_TRY(const auto point, messages::read_message<messages::PointStamped>(*message.wire, message.bytes));
    return HandReading{point.header, {point.point, {}}, false};
  }
  SACCADE_TRY(const auto transform, messages::read_message<messages::TransformStamped>(*message.wire, message.bytes));
  return HandReading{transform.header, transform.transform, true};
}

HandSample hand_sample(std::int64_t at_ns, const Pose& T_world_hand, bool has_rotation) {
  HandSample sample{static_cast<double>(at_ns) * 1e-9, T_world_hand.translation(), std::nullopt};
  if (has_rotation) sample.R_world_hand = Eigen::Quaterniond{T_world_hand.rotation()};
  return sample;
}

/// Returns the hand's trajectory. Readings where TF does not reach the world have position NaN, which is counted as
/// bad.
HandTrajectory hand_of_topic(const std::vector<std::pair<std::int64_t, HandReading>>& readings, const TfBuffer* tf,
                             const std::string& world) {
  HandTrajectory samples;
  for (const auto& [recorded_ns, reading] : readings) {
    std::int64_t at_ns = time_ns(reading.header.stamp);
    if (at_ns == 0) at_ns = recorded_ns;
    const auto in_frame = finite_pose(reading.pose);
    std::optional<Pose> T_world_hand = in_frame;
    if (tf != nullptr && in_frame && frame_name(reading.header.frame_id) != world) {
      const auto T_world_frame = tf->look_up(world, reading.header.frame_id, at_ns);
      T_world_hand = T_world_frame ? std::optional<Pose>{*T_world_frame * *in_frame} : std::nullopt;
    }
    if (!T_world_hand) {
      T_world_hand = Pose::Identity();
      T_world_hand->translation().setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    samples.push_back(
        hand_sample(at_ns, *T_world_hand, reading.has_rotation && T_world_hand->translation().allFinite()));
  }
  return samples;
}

Result<HandTrajectory> hand_of_frame(Bag& bag, const std::string& hand, const std::string& given_world) {
  SACCADE_TRY(const TfBuffer tf, TfBuffer::read(bag));
  const std::string frame{frame_name(hand)};
  if (!tf.knows(frame)) {
    return Error{
        Errc::not_found,
        hand + " is neither a topic with poses of a hand nor a frame of TF; the bag has these topics: " + bag.list(),
        {}};
  }
  const std::string world = given_world.empty() ? tf.root(frame) : std::string{frame_name(given_world)};
  if (!tf.connects(world, frame)) {
    return Error{Errc::not_found, "TF does not connect " + world + " with the hand's frame " + frame, {}};
  }
  HandTrajectory samples;
  for (const std::int64_t at_ns : tf.times_ns(frame)) {
    const auto pose = tf.look_up(world, frame, at_ns);
    if (pose) samples.push_back(hand_sample(at_ns, *pose, true));
  }
  return samples;
}

Result<HandTrajectory> hand_of_topic(Bag& bag, std::uint32_t topic, const std::string& given_world) {
  SACCADE_TRY(const auto entries, bag.entries({&topic, 1}));
  std::vector<std::pair<std::int64_t, HandReading>> readings;
  for (const BagEntry& entry : entries) {
    SACCADE_TRY(const BagMessage message, bag.read(entry));
    SACCADE_TRY(HandReading reading, read_hand_message(message));
    readings.emplace_back(message.time_ns, std::move(reading));
  }
  if (readings.empty()) return HandTrajectory{};
  const std::string first{frame_name(readings.front().second.header.frame_id)};
  const std::string world = given_world.empty() ? first : std::string{frame_name(given_world)};
  bool needs_tf = false;
  for (const auto& [time, reading] : readings) needs_tf |= frame_name(reading.header.frame_id) != world;
  if (!needs_tf) return hand_of_topic(readings, nullptr, world);
  SACCADE_TRY(const TfBuffer tf, TfBuffer::read(bag));
  if (!tf.connects(world, first)) {
    return Error{Errc::not_found, "TF does not connect " + world + " with the frame of the hand's poses, " + first, {}};
  }
  return hand_of_topic(readings, &tf, world);
}

Result<HandTrajectory> hand_in(Bag& bag, const std::string& hand, const std::string& world) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    const bool is_hand = std::ranges::find(kHandTypes, topic.type) != kHandTypes.end();
    if (topic.name == hand && is_hand) return hand_of_topic(bag, i, world);
    if (is_hand) found.push_back(i);
  }
  if (!hand.empty()) return hand_of_frame(bag, hand, world);
  if (found.size() == 1) return hand_of_topic(bag, found.front(), world);
  return Error{Errc::invalid_argument,
               "which hand? Choose a topic or a frame of TF with --hand; topics with poses: " + bag.list(kHandTypes) +
                   "; all topics: " + bag.list(),
               {}};
}

}  // namespace
}  // namespace internal::io_bags

Result<HandRecording> read_bag_hand(const std::filesystem::path& path, const std::string& hand,
                                    const std::string& world_frame) {
  SACCADE_TRY(const std::unique_ptr<Bag> bag, Bag::open(path));
  const auto samples = internal::io_bags::hand_in(*bag, hand, world_frame);
  if (!samples) return in_file(samples.error(), path);
  return HandRecording{usable_samples(*samples), check_samples(*samples)};
}

}  // namespace saccade
