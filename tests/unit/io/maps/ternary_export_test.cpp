// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/ternary_export.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <tuple>

#include "analytic_map.hpp"

namespace saccade {
namespace {

using test::map_of;

class TernaryExport : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("saccade_ternary_" + std::to_string(std::random_device{}()) + std::to_string(std::random_device{}()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream{path, std::ios::binary}.rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

/// A ball of radius 5 cm known out to a cube that ends in the middle of bricks and touches the border of its sector.
TsdfSnapshot ball(bool colored) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  return map_of(
      config, {{-13, -12, -11}, {64, 12, 11}},
      [](const Eigen::Vector3d& p) {
        return test::sphere_sdf(p, {0.0, 0.0, 0.0}, 0.05);
      },
      colored);
}

struct Point {
  int state;
  Rgb8 color;
};
using Key = std::tuple<int, int, int>;

std::map<Key, Point> read_points(const std::string& file, std::size_t expected) {
  const std::size_t start = file.find("end_header\n") + 11;
  EXPECT_NE(file.find("element vertex " + std::to_string(expected) + "\n"), std::string::npos);
  EXPECT_EQ(file.size(), start + expected * 16);
  std::map<Key, Point> points;
  for (std::size_t i = start; i + 16 <= file.size(); i += 16) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), &file[i], 12);
    const Index3 v = voxel_at({p[0], p[1], p[2]}, 0.01);
    Point point{};
    std::memcpy(point.color.data(), &file[i + 12], 3);
    point.state = file[i + 15];
    EXPECT_TRUE(points.emplace(Key{v.x, v.y, v.z}, point).second) << "a voxel came twice";
  }
  return points;
}

/// By definition, voxel by voxel.
std::map<Key, int> expected_points(const TsdfSnapshot& map, const IndexBox& within, const IndexBox& frontier_within) {
  std::map<Key, int> expected;
  for (int z = -20; z < 20; ++z) {
    for (int y = -20; y < 20; ++y) {
      for (int x = -20; x < 72; ++x) {
        const Index3 voxel{x, y, z};
        const VoxelState state = map.grid.state(voxel);
        if (state == VoxelState::occupied && within.contains(voxel)) expected[{x, y, z}] = 2;
        if (state != VoxelState::unknown || !frontier_within.contains(voxel)) continue;
        bool frontier{false};
        for (const Index3& d : {Index3{1, 0, 0}, Index3{0, 1, 0}, Index3{0, 0, 1}}) {
          frontier = frontier || map.grid.state(voxel + d) == VoxelState::empty ||
                     map.grid.state(voxel - d) == VoxelState::empty;
        }
        if (frontier) expected[{x, y, z}] = 0;
      }
    }
  }
  return expected;
}

void expect_same(const std::map<Key, Point>& points, const std::map<Key, int>& expected) {
  ASSERT_EQ(points.size(), expected.size());
  for (const auto& [key, state] : expected) {
    const auto it = points.find(key);
    ASSERT_NE(it, points.end());
    EXPECT_EQ(it->second.state, state);
  }
}

constexpr IndexBox kAll{{-1000, -1000, -1000}, {1000, 1000, 1000}};

TEST_F(TernaryExport, PointsAreTheOccupiedAndTheFrontierVoxels) {
  const TsdfSnapshot map = ball(true);
  const auto counts = write_ternary_points(map, folder_ / "points.ply");
  ASSERT_TRUE(counts.ok()) << counts.error().to_string();
  EXPECT_GT(counts->occupied, 400U);
  EXPECT_GT(counts->frontier, 4000U);
  const auto points = read_points(bytes_of(folder_ / "points.ply"), counts->occupied + counts->frontier);
  expect_same(points, expected_points(map, kAll, kAll));
  for (const auto& [key, point] : points) {
    EXPECT_EQ(point.color, point.state == 2 ? (Rgb8{200, 100, 50}) : Rgb8{}) << "state " << point.state;
  }
}

TEST_F(TernaryExport, BoxAndWorkspaceLimitPoints) {
  TsdfSnapshot map = ball(false);
  map.config.workspace = Box{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.105}};  // the upper face of the known cube is outside
  const TernaryPointsConfig config{.box = Box{{-1.0, -1.0, 0.0}, {0.5, 1.0, 1.0}}};
  const auto counts = write_ternary_points(map, folder_ / "points.ply", config);
  ASSERT_TRUE(counts.ok()) << counts.error().to_string();
  const auto points = read_points(bytes_of(folder_ / "points.ply"), counts->occupied + counts->frontier);
  const IndexBox box{{-100, -100, 0}, {50, 100, 100}};
  const IndexBox workspace = voxels_with_center_in(*map.config.workspace, 0.01);
  const IndexBox both{{workspace.lo.x, workspace.lo.y, 0}, workspace.hi};
  const auto expected = expected_points(map, box, both);
  ASSERT_GT(expected.size(), 500U);
  expect_same(points, expected);
}

TEST_F(TernaryExport, VolumeHoldsEveryVoxelOfTheBox) {
  const TsdfSnapshot map = ball(false);
  const Box box{{-0.17, -0.1, -0.13}, {0.66, 0.08, 0.12}};
  const auto voxels = write_ternary_volume(map, folder_ / "volume.npy", {.box = box});
  ASSERT_TRUE(voxels.ok()) << voxels.error().to_string();
  EXPECT_EQ(*voxels, (IndexBox{{-17, -10, -13}, {66, 8, 12}}));
  const std::string file = bytes_of(folder_ / "volume.npy");
  ASSERT_EQ(file.substr(0, 6), "\x93NUMPY");
  const std::size_t header = 10 + static_cast<unsigned char>(file[8]) + 256 * static_cast<unsigned char>(file[9]);
  EXPECT_EQ(header % 64, 0U);
  EXPECT_NE(file.find("'shape': (25, 18, 83)"), std::string::npos);
  ASSERT_EQ(file.size(), header + 25 * 18 * 83);
  std::size_t i = header;
  std::array<int, 3> seen{};
  for (int z = -13; z < 12; ++z) {
    for (int y = -10; y < 8; ++y) {
      for (int x = -17; x < 66; ++x, ++i) {
        ASSERT_EQ(file[i], static_cast<char>(map.grid.state({x, y, z}))) << x << ' ' << y << ' ' << z;
        ++seen[static_cast<std::size_t>(file[i])];
      }
    }
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 100);
  const auto json = nlohmann::json::parse(bytes_of(folder_ / "volume.json"));
  EXPECT_EQ(json["shape"], (nlohmann::json{25, 18, 83}));
  EXPECT_DOUBLE_EQ(json["origin_m"][0].get<double>(), -0.165);
  EXPECT_DOUBLE_EQ(json["voxel_size_m"].get<double>(), 0.01);
}

TEST_F(TernaryExport, VolumeWithoutABoxCoversAllThatIsKnown) {
  const TsdfSnapshot map = ball(false);
  const auto voxels = write_ternary_volume(map, folder_ / "volume.npy");
  ASSERT_TRUE(voxels.ok());
  EXPECT_EQ(*voxels, (IndexBox{{-16, -16, -16}, {64, 16, 16}}));
}

TEST_F(TernaryExport, ImpossibleBoxesAreRefusedAndLeaveNothing) {
  const TsdfSnapshot map = ball(false);
  const auto large =
      write_ternary_volume(map, folder_ / "volume.npy", {.box = Box{{-100, -100, -100}, {100, 100, 100}}});
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, Errc::invalid_argument);
  EXPECT_NE(large.error().message.find("20000 x 20000 x 20000 voxels (7450.6 GiB)"), std::string::npos)
      << large.error().message;
  EXPECT_FALSE(write_ternary_volume(map, folder_ / "v.npy", {.box = Box{{0, 0, 0}, {0, 1, 1}}}).ok());
  EXPECT_FALSE(write_ternary_volume(map, folder_ / "v.npy", {.box = Box{{0, 0, 0}, {0.001, 1, 1}}}).ok());
  EXPECT_FALSE(write_ternary_volume(map, folder_ / "v.json").ok());
  EXPECT_FALSE(write_ternary_volume(TsdfSnapshot{}, folder_ / "v.npy").ok());
  EXPECT_FALSE(write_ternary_points(map, folder_ / "p.ply", {.box = Box{{0, 0, 0}, {-1, 1, 1}}}).ok());
  EXPECT_FALSE(write_ternary_volume(map, folder_ / "v.npy", {.box = Box{{0, 0, 0}, {1e18, 1, 1}}}).ok());
  EXPECT_FALSE(write_ternary_points(map, folder_ / "p.ply", {.box = Box{{0, 0, 0}, {1e18, 1, 1}}}).ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace saccade
