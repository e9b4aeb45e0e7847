// SPDX-License-Identifier: Apache-2.0
// saccade explore --publish ros2: an independent implementation reads the clouds and markers of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>

#include "cli/run_program.hpp"
#include "fast_node.hpp"
#include "robot_messagesPubSubTypes.h"
#include "support/places.hpp"

namespace saccade::test {
namespace {

using CloudReader = FastReader<sensor_msgs::msg::dds_::PointCloud2_PubSubType>;
using MarkerReader = FastReader<visualization_msgs::msg::dds_::MarkerArray_PubSubType>;

/// Values of a NumPy volume of bytes.
std::string values_of(const fs::path& npy) {
  const std::string text = text_of(npy);
  const auto header = static_cast<unsigned char>(text.at(8)) + 256U * static_cast<unsigned char>(text.at(9));
  return text.substr(10 + header);
}

TEST(Ros2PublishRun, CloudsAndMarkersAreThoseOfTheRun) {
  const TempFolder folder;
  FastNode node;
  std::mutex mutex;
  std::vector<CloudReader::Message> clouds;
  std::vector<MarkerReader::Message> arrays;
  const CloudReader occupied{node, "/saccade/occupied", {.latched = true}, [&](const CloudReader::Message& message) {
                               const std::lock_guard lock{mutex};
                               clouds.push_back(message);
                             }};
  const MarkerReader candidates{
      node, "/saccade/candidates", {.latched = true}, [&](const MarkerReader::Message& message) {
        const std::lock_guard lock{mutex};
        arrays.push_back(message);
      }};
  const Outcome outcome = run_program({"explore", tiny_cell_file(), "--out", (folder / "run").string(), "--quiet",
                                       "--image-size", "96,72", "--voxel-size", "0.015", "--robot", "free",
                                       "--max-views", "1", "--no-pictures", "--publish", "ros2", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("goes on without"), std::string::npos) << outcome.err;
  const nlohmann::json views = outcome.json().at("result").at("views");
  ASSERT_EQ(views.size(), 1U);

  const std::lock_guard lock{mutex};
  ASSERT_FALSE(clouds.empty());
  const CloudReader::Message& cloud = clouds.back();
  const std::string ternary = values_of(folder / "run/ternary.npy");
  EXPECT_EQ(cloud.width_(), static_cast<std::uint32_t>(std::count(ternary.begin(), ternary.end(), '\2')));
  EXPECT_GT(cloud.width_(), 50U);
  EXPECT_EQ(cloud.header_().frame_id_(), "world");
  ASSERT_EQ(cloud.fields_().size(), 4U);
  EXPECT_EQ(cloud.fields_()[3].name_(), "rgb");
  ASSERT_EQ(cloud.data_().size(), std::size_t{16} * cloud.width_());
  for (std::size_t i = 0; i < cloud.width_(); ++i) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), cloud.data_().data() + 16 * i, 12);
    for (const float x : p) ASSERT_LT(std::abs(x), 2.0F);
  }

  ASSERT_EQ(arrays.size(), 1U);
  const auto& markers = arrays.back().markers_();
  ASSERT_EQ(markers.size(), 2U);
  EXPECT_EQ(markers[0].ns_(), "candidates");
  EXPECT_GE(markers[0].points_().size(), 2U);
  EXPECT_LE(markers[0].points_().size(), 400U);
  EXPECT_EQ(markers[0].colors_().size(), markers[0].points_().size());
  EXPECT_EQ(markers[1].ns_(), "chosen");
  ASSERT_EQ(markers[1].points_().size(), 16U);
  const nlohmann::json& taken = views[0].at("T_world_camera");
  EXPECT_NEAR(markers[1].points_()[0].x_(), taken[0][3].get<double>(), 1e-9);
  EXPECT_NEAR(markers[1].points_()[0].y_(), taken[1][3].get<double>(), 1e-9);
  EXPECT_NEAR(markers[1].points_()[0].z_(), taken[2][3].get<double>(), 1e-9);
  EXPECT_GT(markers[1].color_().g_(), markers[1].color_().r_());
  EXPECT_FALSE(markers[1].mesh_use_embedded_materials_());
}

}  // namespace
}  // namespace saccade::test
