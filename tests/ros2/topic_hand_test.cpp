// SPDX-License-Identifier: Apache-2.0
// saccade-ros2 hand: a frame of /tf and /tf_static. saccade-ros2 publish: messages that others read.
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "fast_robot.hpp"
#include "ros2_programs.hpp"
#include "saccade/io/messages/messages.hpp"

namespace saccade::test {
namespace {

using FastTf = tf2_msgs::msg::dds_::TFMessage_;
using TfWriter = FastWriter<tf2_msgs::msg::dds_::TFMessage_PubSubType>;
using FastCloud = sensor_msgs::msg::dds_::PointCloud2_;

FastTf transform(const std::string& parent, const std::string& child, double time_s, const Eigen::Vector3d& p,
                 double turn_rad = 0.0) {
  FastTransform t;
  t.header_(header_at(time_s, parent));
  t.child_frame_id_(child);
  t.transform_().translation_().x_(p.x());
  t.transform_().translation_().y_(p.y());
  t.transform_().translation_().z_(p.z());
  t.transform_().rotation_().z_(std::sin(0.5 * turn_rad));
  t.transform_().rotation_().w_(std::cos(0.5 * turn_rad));
  FastTf message;
  message.transforms_({t});
  return message;
}

TEST(Ros2Hand, IsFoundThroughBothTreesOfFramesAndNanIsPassedOver) {
  FastNode node;
  TfWriter fixed{node, "/tf_static", {.latched = true}};
  TfWriter moving{node, "/tf", {}};
  fixed.write(transform("world", "base", 0.0, {1.0, 0.0, 0.0}, 0.5 * M_PI));
  fixed.write(transform("base", "tracker", 0.0, {0.0, 0.0, 0.5}));
  auto started_hand = ProgramHand::start({ros2_command("hand hand --reference world")});
  ASSERT_TRUE(started_hand) << started_hand.error().to_string();
  ProgramHand& hand = **started_hand;
  const auto unseen = hand.next();
  ASSERT_TRUE(unseen) << unseen.error().to_string();
  EXPECT_FALSE((*unseen)->position_m.allFinite());
  std::atomic<bool> broken{false};
  const double began_s = wall_s();
  const Repeated tracker{std::chrono::milliseconds{20}, [&] {
                           const double x = broken ? std::numeric_limits<double>::quiet_NaN() : wall_s() - began_s;
                           moving.write(transform("tracker", "hand", wall_s(), {x, 0.0, 0.0}));
                         }};
  std::optional<HandSample> seen;
  ASSERT_TRUE(eventually([&] {
    seen = hand.next().value();
    return seen->position_m.allFinite();
  }));
  // The base is turned by a quarter: the tracker's x is the world's y.
  EXPECT_NEAR(seen->position_m.x(), 1.0, 1e-9);
  EXPECT_NEAR(seen->position_m.y(), seen->time_s - began_s, 0.01);
  EXPECT_NEAR(seen->position_m.z(), 0.5, 1e-9);
  EXPECT_NEAR(seen->time_s, wall_s(), 1.0);
  EXPECT_GT(hand.next().value()->time_s, seen->time_s);
  broken = true;
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  EXPECT_TRUE(eventually([&] { return !hand.next().value()->position_m.allFinite(); }));
  broken = false;
  EXPECT_TRUE(eventually([&] { return hand.next().value()->position_m.allFinite(); }));
}

/// A message as it stands on the standard input of saccade-ros2 publish.
void put(std::FILE* pipe, const nlohmann::json& head, const std::vector<std::byte>& cdr) {
  const std::string line = head.dump();
  const auto size = static_cast<std::uint32_t>(line.size());
  for (unsigned shift = 0; shift < 32; shift += 8) std::fputc(static_cast<int>((size >> shift) & 0xFFU), pipe);
  std::fwrite(line.data(), 1, line.size(), pipe);
  std::fwrite(cdr.data(), 1, cdr.size(), pipe);
  std::fflush(pipe);
}

TEST(Ros2Publish, CloudsReachReadersAlsoThoseThatComeLater) {
  messages::PointCloud2 cloud;
  cloud.header.frame_id = "world";
  cloud.width = 50000;
  cloud.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};
  cloud.point_step = 12;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < cloud.data.size(); ++i) cloud.data[i] = static_cast<std::byte>(i % 251);
  const auto cdr = messages::write_message(messages::Wire::cdr, cloud);
  FastNode node;
  std::FILE* pipe = ::popen(ros2_command("publish").c_str(), "w");
  ASSERT_NE(pipe, nullptr);
  nlohmann::json head{{"topic", "/saccade/map"}, {"type", "sensor_msgs/PointCloud2"}, {"latched", true}};
  head["bytes"] = cdr.size();
  put(pipe, head, cdr);
  put(pipe, {{"topic", "/saccade/state"}, {"type", "std_msgs/String"}, {"bytes", 4}}, std::vector<std::byte>(4));
  std::mutex mutex;
  std::vector<FastCloud> came;
  const FastReader<sensor_msgs::msg::dds_::PointCloud2_PubSubType> reader{
      node, "/saccade/map", {.latched = true}, [&](const FastCloud& message) {
        const std::lock_guard lock{mutex};
        came.push_back(message);
      }};
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock{mutex};
    return !came.empty();
  }));
  EXPECT_EQ(::pclose(pipe), 0);
  ASSERT_EQ(came.size(), 1U);
  EXPECT_EQ(came[0].header_().frame_id_(), "world");
  EXPECT_EQ(came[0].width_(), 50000U);
  ASSERT_EQ(came[0].fields_().size(), 3U);
  EXPECT_EQ(came[0].fields_()[2].name_(), "z");
  EXPECT_EQ(came[0].data_().size(), 600000U);
  EXPECT_EQ(came[0].data_()[599999], 599999 % 251);
}

TEST(Ros2Publish, ATypeThatIsNoneAndInputOutOfStepAreSaid) {
  for (const char* type : {"Image", "/Image"}) {
    std::FILE* pipe = ::popen((ros2_command("publish") + " 2>/dev/null").c_str(), "w");
    put(pipe, {{"topic", "/x"}, {"type", type}, {"bytes", 4}}, std::vector<std::byte>(4));
    EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), 1);
  }
}

}  // namespace
}  // namespace saccade::test
