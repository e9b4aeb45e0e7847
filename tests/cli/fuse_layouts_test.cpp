// SPDX-License-Identifier: Apache-2.0
// saccade fuse and saccade info of recorded layouts: a map with known voxels from a wall and a board that the test
// draws, and the answer to a folder in no layout.
#include <gtest/gtest.h>

#include <cmath>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade::test {
namespace {

constexpr int kImageWidth{16};
constexpr int kImageHeight{12};
constexpr double kWallM{0.8};
constexpr double kBoardM{0.5};
constexpr double kVoxelM{0.02};
/// Focal length 16 pixels, centre (7.5, 5.5).
constexpr const char* kMatrix4{"16 0 7.5 0\n0 16 5.5 0\n0 0 1 0\n0 0 0 1\n"};

/// A camera that looks along z at a wall; a board covers the left half of its image. Each layout puts it at x = 0.3.
class FuseLayouts : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  void write(const std::string& name, const std::string& text) const { folder_.write("frames/" + name, text); }
  void depth(const std::string& name, double units_per_m) const {
    Image16 samples{kImageWidth, kImageHeight};
    for (int v = 0; v < kImageHeight; ++v) {
      for (int u = 0; u < kImageWidth; ++u) {
        const double z_m = u < kImageWidth / 2 ? kBoardM : kWallM;
        samples(u, v) = static_cast<std::uint16_t>(std::lround(z_m * units_per_m));
      }
    }
    fs::create_directories((frames() / name).parent_path());
    ASSERT_TRUE(write_png16(frames() / name, samples));
  }
  void color(const std::string& name) const {
    fs::create_directories((frames() / name).parent_path());
    ASSERT_TRUE(write_png(frames() / name, ColorImage{kImageWidth, kImageHeight, {200, 100, 50}}));
  }
  [[nodiscard]] nlohmann::json fused(const Arguments& more = {}) const {
    const Outcome outcome =
        run_program(Arguments{"fuse", frames().string(), "--out", (folder_ / "run").string(), "--voxel-size",
                              std::to_string(kVoxelM), "--no-pictures", "--no-mesh", "--quiet", "--json", "-"} +
                    more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json document = outcome.json();
    expect_envelope(document, "fuse");
    return document.at("result");
  }
  [[nodiscard]] nlohmann::json described() const {
    const Outcome outcome = run_program({"info", frames().string(), "--quiet", "--json", "-"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result").at("frames");
  }
  /// Expects board and wall where the camera at x = 0.3 saw them: free before, a surface, unknown behind.
  void expect_board_and_wall() const {
    const auto map = load_map(folder_ / "run" / "map.sacmap");
    ASSERT_TRUE(map) << map.error().to_string();
    const auto state = [&map](double x, double z) {
      return map->grid.state(voxel_at({x, 0.01, z}, map->config.voxel_size_m));
    };
    const double half_m{kVoxelM / 2};
    for (const auto& [x, surface_m] : {std::pair{0.21, kBoardM}, std::pair{0.41, kWallM}}) {
      EXPECT_EQ(state(x, surface_m - 0.2), VoxelState::empty) << x;
      EXPECT_EQ(state(x, surface_m - half_m), VoxelState::empty) << x;
      EXPECT_EQ(state(x, surface_m + half_m), VoxelState::occupied) << x;
      EXPECT_EQ(state(x, surface_m + 0.2), VoxelState::unknown) << x;
    }
    EXPECT_EQ(state(-0.41, 0.4), VoxelState::unknown);  // beside the image
  }
  static std::string note_with(const nlohmann::json& notes, const std::string& part) {
    for (const nlohmann::json& note : notes) {
      if (note.get<std::string>().find(part) != std::string::npos) return note;
    }
    return "no note has '" + part + "': " + notes.dump();
  }
  TempFolder folder_;
};

TEST_F(FuseLayouts, ScanNetSkipsItsLostPoses) {
  for (const char* frame : {"0", "1", "10"}) {
    depth(std::string{"depth/"} + frame + ".png", 1000.0);
    color(std::string{"color/"} + frame + ".png");
    write(std::string{"pose/"} + frame + ".txt", "1 0 0 0.3\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
  write("pose/1.txt", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
  write("pose/11.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  write("intrinsic/intrinsic_depth.txt", kMatrix4);
  const nlohmann::json result = fused();
  EXPECT_EQ(result.at("layout"), "scannet");
  EXPECT_EQ(result.at("tracking"), "forced");
  EXPECT_EQ(result.at("depth_units_per_m"), 1000.0);
  EXPECT_EQ(result.at("frames"), 2);
  ASSERT_EQ(result.at("skipped").size(), 1U);
  EXPECT_EQ(result.at("skipped").at(0).at("frame"), "1");
  EXPECT_EQ(note_with(result.at("notes"), "pose"), "1 of 4 pose files belong to no depth image and are left out");
  expect_board_and_wall();
  const nlohmann::json frames = described();
  EXPECT_EQ(frames.at("count"), 3);
  EXPECT_EQ(frames.at("frames_with_pose"), 2);
  EXPECT_EQ(frames.at("notes"), result.at("notes"));
}

TEST_F(FuseLayouts, RtabMapPutsTheCameraOnItsRobot) {
  depth("depth/3.png", 1000.0);
  color("rgb/3.png");
  // The camera looks along the robot's x, 0.1 m before it; the robot looks along the world's z.
  write("calib/3.yaml",
        "%YAML:1.0\n---\nimage_width: 16\nimage_height: 12\ncamera_matrix:\n   rows: 3\n   cols: 3\n"
        "   data: [ 16., 0., 7.5, 0., 16., 5.5, 0., 0., 1. ]\nlocal_transform:\n   rows: 3\n   cols: 4\n"
        "   data: [ 0., 0., 1., 0.1, -1., 0., 0., 0., 0., -1., 0., 0. ]\n");
  write("poses.txt", "#timestamp x y z qx qy qz qw id\n9.1 0.3 0 -0.1 0.5 -0.5 0.5 0.5 3\n");
  const nlohmann::json result = fused();
  EXPECT_EQ(result.at("layout"), "rtabmap");
  EXPECT_EQ(result.at("frames"), 1);
  EXPECT_EQ(result.at("camera").at("fx"), 16.0);
  expect_board_and_wall();
}

TEST_F(FuseLayouts, BopTakesScaleAndPoseOfEachImage) {
  depth("depth/000000.png", 10000.0);
  depth("depth/000001.png", 5000.0);
  color("rgb/000000.png");
  const std::string camera{R"("cam_K": [16,0,7.5,0,16,5.5,0,0,1], "cam_R_w2c": [1,0,0,0,1,0,0,0,1], )"
                           R"("cam_t_w2c": [-300.0, 0, 0], "depth_scale": )"};
  write("scene_camera.json", "{\"0\": {" + camera + "0.1}, \"1\": {" + camera + "0.2}}");
  const nlohmann::json result = fused();
  EXPECT_EQ(result.at("layout"), "bop");
  EXPECT_EQ(result.at("depth_units_per_m"), 10000.0);
  EXPECT_EQ(result.at("depth_units_from"), "files");
  EXPECT_EQ(result.at("frames"), 2);
  EXPECT_EQ(note_with(result.at("notes"), "colour"), "1 of 2 depth images have no colour image");
  expect_board_and_wall();
  EXPECT_EQ(described().at("depth_units_from"), "files");
}

TEST_F(FuseLayouts, AFolderInNoLayoutHearsWhichIsNearest) {
  color("rgb/0.png");
  write("scene_camera.json", "{}");
  const Arguments command{"fuse", frames().string(), "--out", (folder_ / "run").string(), "--quiet"};
  expect_failure(run_program(command), 3, "fuse",
                 {frames().string(), "nearest is that of BOP", "lacks depth/N.png", "docs/reference/formats.md"});
  fs::rename(frames() / "scene_camera.json", frames() / "intrinsic_depth.txt");
  expect_failure(run_program(command), 3, "fuse", {"nearest is that of ScanNet", "lacks depth/N.png"});
  depth("scan/depth/0.png", 1000.0);
  expect_failure(run_program(command), 3, "fuse",
                 {"scan/ in it is one of Open3D", "; try " + (frames() / "scan").string()});
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

}  // namespace
}  // namespace saccade::test
