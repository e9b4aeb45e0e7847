// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/run_messages.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace saccade {
namespace {

using messages::Wire;

struct Sent {
  std::string topic;
  std::string type;
  std::vector<std::byte> bytes;
};

/// Keeps what it is given, and fails once it has been given `most` messages.
class KeepingSink final : public messages::MessageSink {
 public:
  KeepingSink(std::vector<Sent>& sent, Wire wire, std::size_t most) : sent_{sent}, wire_{wire}, most_{most} {}
  [[nodiscard]] Wire wire() const override { return wire_; }
  [[nodiscard]] Status add(std::string_view topic, const messages::MessageType& type, messages::Time /*time*/,
                           std::span<const std::byte> bytes) override {
    if (sent_.size() == most_) return Error{Errc::io_failure, "the disk is full", "sink"};
    sent_.push_back({std::string{topic}, std::string{type.name}, {bytes.begin(), bytes.end()}});
    return {};
  }

 private:
  std::vector<Sent>& sent_;
  Wire wire_;
  std::size_t most_;
};

const PinholeCamera kCamera{32, 24, 26.0, 26.0, 15.5, 11.5, 0.2, 3.0};

/// A wall at z = 0, seen from above through a small workspace.
TsdfMap wall_map(const Frame& frame) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.workspace = Box{{-0.2, -0.2, -0.1}, {0.2, 0.2, 0.2}};
  auto map = TsdfMap::create(config);
  EXPECT_TRUE(map->integrate(kCamera, frame.depth, *frame.T_world_camera, Executor{}).ok());
  return std::move(*map);
}

Frame wall_frame() {
  Frame frame;
  frame.depth = DepthImage{32, 24, 0.5F};
  frame.T_world_camera = look_at({0.0, 0.0, 0.5}, {0.0, 0.0, 0.0});
  return frame;
}

template <class Message>
Message message_on(const std::vector<Sent>& sent, std::string_view topic) {
  for (const Sent& one : sent) {
    if (one.topic != topic) continue;
    EXPECT_EQ(one.type, messages::type_of<Message>().name);
    auto read = messages::read_message<Message>(Wire::cdr, one.bytes);
    EXPECT_TRUE(read.ok());
    return std::move(*read);
  }
  ADD_FAILURE() << "no message on " << topic;
  return {};
}

TEST(RunMessages, AViewIsWhatTheMapAndTheRecordHold) {
  const Frame frame = wall_frame();
  TsdfMap map = wall_map(frame);
  std::vector<Sent> sent;
  RunMessagesConfig config;
  config.now = [] { return messages::Time{100, 5}; };
  RunMessages run{config, kCamera};
  run.add(std::make_unique<KeepingSink>(sent, Wire::cdr, 100));

  ViewRecord view;
  view.T_world_camera = *frame.T_world_camera;
  view.path = {{0.0, 0.0, 1.0}, {0.0, 0.0, 0.5}};
  ViewChoice choice;
  choice.candidates = {{Pose::Identity(), 1.0}, {view.T_world_camera, 4.0}, {Pose::Identity(), std::nan("")}};
  view.choice = std::make_shared<const ViewChoice>(choice);
  Frame tilted = frame;
  tilted.T_world_camera = look_at({0.0, 0.0, 0.55}, {0.0, 0.0, 0.0});
  ASSERT_TRUE(run.viewed(view, map.snapshot(), std::span{&tilted, 1}).ok());

  const auto occupied = message_on<messages::PointCloud2>(sent, "/saccade/occupied");
  const auto plan = message_on<messages::OccupancyGrid>(sent, "/saccade/map_2d");
  EXPECT_EQ(occupied.header.frame_id, "world");
  EXPECT_EQ(occupied.header.stamp, (messages::Time{100, 5}));
  EXPECT_EQ(occupied.data.size(), std::size_t{16} * occupied.width);
  ASSERT_GT(occupied.width, 0U);
  std::set<std::pair<int, int>> columns;
  for (std::size_t i = 0; i < occupied.width; ++i) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), occupied.data.data() + 16 * i, 12);
    EXPECT_LT(std::abs(p[2]), 0.1F);
    columns.emplace(static_cast<int>(std::floor((p[0] + 0.2F) / 0.02F)),
                    static_cast<int>(std::floor((p[1] + 0.2F) / 0.02F)));
  }
  ASSERT_EQ(plan.info.width, 20U);
  ASSERT_EQ(plan.info.height, 20U);
  std::size_t occupied_cells = 0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const bool is_occupied = plan.data[static_cast<std::size_t>(20 * y + x)] == std::byte{100};
      EXPECT_EQ(is_occupied, columns.contains({x, y})) << x << ' ' << y;
      occupied_cells += is_occupied ? 1 : 0;
    }
  }
  EXPECT_EQ(occupied_cells, columns.size());

  const auto markers = message_on<messages::MarkerArray>(sent, "/saccade/candidates");
  ASSERT_EQ(markers.markers.size(), 2U);
  EXPECT_EQ(markers.markers[0].points.size(), 4U);         // two candidates were evaluated
  EXPECT_NEAR(markers.markers[0].points[0].z, 0.5, 1e-9);  // the better one first
  EXPECT_EQ(markers.markers[1].points.size(), 16U);
  EXPECT_EQ(message_on<messages::Path>(sent, "/saccade/plan").poses.size(), 2U);
  const auto tf = message_on<messages::TFMessage>(sent, "/tf");
  EXPECT_NEAR(tf.transforms.at(0).transform.position.z, 0.55, 1e-12);  // where the frame was taken, not the view
  EXPECT_NEAR(std::abs(tf.transforms.at(0).transform.orientation.w), 0.0, 1e-9);  // turned over
  const auto depth = message_on<messages::Image>(sent, "/saccade/depth/image_raw");
  EXPECT_EQ(depth.encoding, "32FC1");
  EXPECT_EQ(depth.data.size(), std::size_t{4} * 32 * 24);
  EXPECT_EQ(message_on<messages::CameraInfo>(sent, "/saccade/depth/camera_info").k[0], 26.0);
}

TEST(RunMessages, ASinkThatFailsIsLeftAndTheOthersGoOn) {
  const Frame frame = wall_frame();
  TsdfMap map = wall_map(frame);
  std::vector<Sent> full;
  std::vector<Sent> ros1;
  std::vector<std::string> said;
  RunMessagesConfig config;
  config.failed = [&said](const Error& error) { said.push_back(error.to_string()); };
  config.most_points = 10;
  RunMessages run{config, kCamera};
  run.add(std::make_unique<KeepingSink>(full, Wire::cdr, 1));
  run.add(std::make_unique<KeepingSink>(ros1, Wire::ros1, 100));
  ScanRecord scan;
  ASSERT_TRUE(run.scanned(scan, map.snapshot()).ok());
  ASSERT_TRUE(run.scanned(scan, map.snapshot()).ok());
  EXPECT_EQ(said, std::vector<std::string>{"sink: the disk is full"});
  EXPECT_EQ(full.size(), 1U);
  ASSERT_EQ(ros1.size(), 6U);
  const auto cloud = messages::read_message<messages::PointCloud2>(Wire::ros1, ros1[0].bytes);
  ASSERT_TRUE(cloud.ok());
  EXPECT_EQ(cloud->width, 10U);  // thinned
  run.finish();
  EXPECT_TRUE(run.scanned(scan, map.snapshot()).ok());
  EXPECT_EQ(ros1.size(), 6U);
}

}  // namespace
}  // namespace saccade
