// SPDX-License-Identifier: Apache-2.0
// Layouts of recordings as people have them: each with small pictures that the test writes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "support/depth_files.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

constexpr int kImageWidth{8};
constexpr int kImageHeight{6};
constexpr const char* kMatrix4{"10 0 3.5 0\n0 10 2.5 0\n0 0 1 0\n0 0 0 1\n"};

/// Pose of a camera moved along x.
std::string pose_at(const std::string& x) { return "1 0 0 " + x + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"; }

class Layouts : public testing::Test {
 protected:
  void depth(const std::string& name, std::uint16_t value) const {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(write_png16(folder_ / name, Image16{kImageWidth, kImageHeight, value}));
  }
  void color(const std::string& name, int width = kImageWidth, int height = kImageHeight) const {
    fs::create_directories((folder_ / name).parent_path());
    ColorImage image{width, height};
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) image(u, v) = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 7};
    }
    ASSERT_TRUE(write_png(folder_ / name, image));
  }
  std::unique_ptr<RgbdFolderSource> opened(const RgbdFolderConfig& config = {}) const {
    auto source = open_rgbd_folder(folder_.path(), config);
    EXPECT_TRUE(source) << source.error().to_string();
    return source ? std::move(*source) : nullptr;
  }
  std::string refusal(const RgbdFolderConfig& config = {}) const {
    const auto source = open_rgbd_folder(folder_.path(), config);
    EXPECT_FALSE(source);
    return source ? "opened" : source.error().to_string();
  }
  /// Writes names, depths of pixel (0, 0) and places along x of all frames: "2 1.5 at 0.1"; errors as "skipped".
  static std::vector<std::string> frames(CameraSource& source) {
    std::vector<std::string> all;
    while (true) {
      const auto frame = source.next();
      if (frame && !*frame) return all;
      if (!frame) {
        all.push_back("skipped: " + frame.error().to_string());
        continue;
      }
      char text[80];
      const double x = (*frame)->T_world_camera ? (*frame)->T_world_camera->translation().x() : NAN;
      std::snprintf(text, sizeof text, "%s %.2f at %.1f", (*frame)->name.c_str(), (*frame)->depth(4, 3), x);
      all.emplace_back(text);
    }
  }
  static bool has_note(const RgbdFolderSource& source, const std::string& part) {
    for (const std::string& note : source.info().notes) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  }
  TempFolder folder_;
};

using Lines = std::vector<std::string>;

TEST_F(Layouts, ScanNetHasNumbersWithoutZerosAndLostPoses) {
  for (const int n : {2, 10, 1}) {
    const std::string name = std::to_string(n);
    depth("depth/" + name + ".png", static_cast<std::uint16_t>(100 * n + 400));
    color("color/" + name + ".png", 2 * kImageWidth, 2 * kImageHeight);
    folder_.write("pose/" + name + ".txt", n == 2 ? "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n"
                                                    "-inf -inf -inf -inf\n"
                                                  : pose_at("0." + name));
  }
  folder_.write("pose/11.txt", pose_at("1"));
  folder_.write("intrinsic/intrinsic_depth.txt", kMatrix4);
  folder_.write("intrinsic/intrinsic_color.txt", "20 0 7.5 0\n0 20 5.5 0\n0 0 1 0\n0 0 0 1\n");
  const auto source = opened();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::scannet);
  EXPECT_EQ(source->camera().fx, 10.0);
  EXPECT_TRUE(has_note(*source, "1 of 4 pose files belong to no depth image"));
  const auto first = source->at(0);
  ASSERT_TRUE(first && first->color) << first.error().to_string();
  EXPECT_EQ(first->color->width(), kImageWidth);
  EXPECT_NEAR((*first->color)(3, 2)[0], 6.5, 0.5);  // pixel 3 is seen between colour pixels 6 and 7
  const Lines all = frames(*source);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0], "1 0.50 at 0.1");
  EXPECT_NE(all[1].find("skipped: frame 2"), std::string::npos) << all[1];
  EXPECT_EQ(all[2], "10 1.40 at 0.1");
}

TEST_F(Layouts, BundleFusionHasTheScaleInItsInfo) {
  depth("frame-000000.depth.png", 1000);
  color("frame-000000.color.png");
  folder_.write("frame-000000.pose.txt", pose_at("0.2"));
  folder_.write("info.txt",
                "m_versionNumber = 4\nm_sensorName = Structure Sensor 1\nm_depthWidth = 8\nm_depthHeight = 6\n"
                "m_depthShift = 2000\nm_calibrationDepthIntrinsic = 10 0 3.5 0 0 10 2.5 0 0 0 1 0 0 0 0 1 \n");
  const auto source = opened();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::bundlefusion);
  EXPECT_EQ(source->info().units_from, UnitsSource::files);
  EXPECT_EQ(frames(*source), (Lines{"frame-000000 0.50 at 0.2"}));
  folder_.write("info.txt", "m_calibrationDepthIntrinsic = 10 0 x\n");
  EXPECT_NE(refusal().find("line 1"), std::string::npos);
  folder_.write("info.txt", "m_depthShift = 1000\n");
  EXPECT_NE(refusal().find("m_calibrationDepthIntrinsic is missing"), std::string::npos);
}

std::string rtabmap_calibration(int width, const std::string& k, const std::string& more = "") {
  return "%YAML:1.0\n---\ncamera_name: \"0\"\nimage_width: " + std::to_string(width) +
         "\nimage_height: " + std::to_string(width * kImageHeight / kImageWidth) +
         "\ncamera_matrix:\n   rows: 3\n   cols: 3\n   data: [ " + k + " ]\n" + more;
}

TEST_F(Layouts, RtabMapHasPosesByIdAndCalibrationsByImage) {
  for (const char* id : {"3", "12"}) {
    depth(std::string{"depth/"} + id + ".png", 1000);
    color(std::string{"rgb/"} + id + ".png", 2 * kImageWidth, 2 * kImageHeight);
    folder_.write(std::string{"calib/"} + id + ".yaml",
                  rtabmap_calibration(2 * kImageWidth, "20., 0., 7.5, 0., 20., 5.5, 0., 0., 1."));
  }
  folder_.write("poses.txt",
                "#timestamp x y z qx qy qz qw id\n9.0 0.9 0 0 0 0 0 1 9\n9.1 0.3 0 0 0 0 0 1 3\n"
                "9.2 0 0 0 0 0 0 0 12\n");
  const auto source = opened();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::rtabmap);
  EXPECT_EQ(source->camera().fx, 10.0);  // the calibration is that of the colours, twice the size
  EXPECT_TRUE(has_note(*source, "1 of 3 poses in poses.txt belong to no depth image"));
  const Lines all = frames(*source);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0], "3 1.00 at 0.3");
  EXPECT_NE(all[1].find("quaternion"), std::string::npos) << all[1];
  fs::remove(folder_ / "calib/12.yaml");
  folder_.write("poses.txt",
                "VERTEX_SE3:QUAT 3 0.5 0 0 0 0 0 1\nVERTEX_SE3:QUAT 12 0.6 0 0 0 0 0 1\n"
                "EDGE_SE3:QUAT 3 12 0 0 0 0 0 0 1\n");
  const Lines graph = frames(*opened());
  EXPECT_EQ(graph[0], "3 1.00 at 0.5");
  EXPECT_NE(graph[1].find("calib/12.yaml, is missing"), std::string::npos) << graph[1];
}

TEST_F(Layouts, RtabMapTurnsPosesOfTheRobotIntoTheCameras) {
  const std::string on_robot{
      "local_transform:\n   rows: 3\n   cols: 4\n   data: [ 0., 0., 1., 0.2, -1., 0., 0., 0., 0., -1., 0., 0. ]\n"};
  depth("depth/3.png", 1000);
  folder_.write("calib/3.yaml", rtabmap_calibration(kImageWidth, "10., 0., 3.5, 0., 10., 2.5, 0., 0., 1.", on_robot));
  folder_.write("map_poses.txt", "9.1 0.3 0 0 0 0 0 1 3\n");
  const auto source = opened();
  ASSERT_TRUE(source);
  const auto pose = source->pose_at(0);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().x(), 0.5, 1e-9);
  EXPECT_NEAR((pose->linear() * Eigen::Vector3d::UnitZ()).x(), 1.0, 1e-9);  // the camera looks along the robot's x
  folder_.write("map_poses.txt", "9.1 0.3 0 0 0 0 0 1\n");
  EXPECT_NE(refusal().find("--poses_camera"), std::string::npos);
  folder_.write("map_camera_poses.txt", "9.1 0.7 0 0 0 0 0 1 3\n");
  EXPECT_EQ(frames(*opened()), (Lines{"3 1.00 at 0.7"}));
}

TEST_F(Layouts, ReplicaHasItsScaleInCamParams) {
  for (int i = 0; i < 3; ++i) {
    depth("scene/results/depth00000" + std::to_string(i) + ".png", 13107);
    color("scene/results/frame00000" + std::to_string(i) + ".png");
  }
  std::string lines;
  for (const char* x : {"0.0", "0.1", "0.2"}) lines += std::string{"1 0 0 "} + x + " 0 1 0 0 0 0 1 0 0 0 0 1\n";
  folder_.write("scene/traj.txt", lines);
  const fs::path scene = folder_ / "scene";
  const auto given = parse_intrinsics("10,10,3.5,2.5");
  auto source = open_rgbd_folder(scene, {.intrinsics = *given});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().to_string().find("--depth-scale N"), std::string::npos);
  folder_.write("cam_params.json", R"({"camera": {"w": 8, "h": 6, "fx": 10, "fy": 10, "cx": 3.5, "cy": 2.5,
                                       "scale": 6553.5}})");
  for (const RgbdFolderConfig& config : {RgbdFolderConfig{}, RgbdFolderConfig{.intrinsics = *given}}) {
    source = open_rgbd_folder(scene, config);
    ASSERT_TRUE(source) << source.error().to_string();
    EXPECT_EQ((*source)->info().layout, RgbdLayout::replica);
    EXPECT_EQ(frames(**source), (Lines{"000000 2.00 at 0.0", "000001 2.00 at 0.1", "000002 2.00 at 0.2"}));
  }
  fs::remove(scene / "results/depth000001.png");  // poses then go by the images' numbers
  source = open_rgbd_folder(scene);
  ASSERT_TRUE(source);
  EXPECT_EQ(frames(**source), (Lines{"000000 2.00 at 0.0", "000002 2.00 at 0.2"}));
  EXPECT_TRUE(has_note(**source, "1 of 3 poses in traj.txt"));
  fs::rename(scene / "results/depth000002.png", scene / "results/depth000007.png");
  source = open_rgbd_folder(scene);
  ASSERT_TRUE(source);  // 000000 has its pose, 000007 none
  EXPECT_NE(frames(**source)[1].find("no pose"), std::string::npos);
  fs::remove(scene / "results/depth000000.png");
  source = open_rgbd_folder(scene);
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().to_string().find("3 poses for 1 depth image"), std::string::npos);
}

TEST_F(Layouts, BopInvertsItsPosesAndMayChangeCamerasBetweenImages) {
  depth("depth/000000.png", 5000);
  depth("depth/000001.png", 5000);
  depth("depth/000002.png", 5000);
  color("rgb/000001.png");
  const std::string pose{R"("cam_R_w2c": [1,0,0,0,1,0,0,0,1], "cam_t_w2c": [-100.0, 0, 0])"};
  folder_.write("scene_camera.json", R"({"0": {"cam_K": [10,0,3.5,0,10,2.5,0,0,1], "depth_scale": 0.1, )" + pose +
                                         R"(}, "1": {"cam_K": [10,0,4.5,0,10,2.5,0,0,1], "depth_scale": 0.2, )" + pose +
                                         R"(}, "5": {"cam_K": [10,0,3.5,0,10,2.5,0,0,1], "depth_scale": 0.1}})");
  const auto source = opened();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::bop);
  EXPECT_TRUE(has_note(*source, "1 of 3 entries in scene_camera.json"));
  EXPECT_TRUE(has_note(*source, "2 of 3 depth images have no colour image"));
  const auto moved = source->at(1);  // a column to the right in its own image is one to the left of that in the first
  ASSERT_TRUE(moved && moved->color) << moved.error().to_string();
  EXPECT_EQ((*moved->color)(2, 2)[0], 3);
  EXPECT_EQ(moved->depth(7, 2), 0.0F);  // beyond its border
  const Lines all = frames(*source);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0], "000000 0.50 at 0.1");
  EXPECT_EQ(all[1], "000001 1.00 at 0.1");
  EXPECT_NE(all[2].find("no entry"), std::string::npos) << all[2];
}

TEST_F(Layouts, AssociationsComeInEitherOrderAndMirroredAxesAreTurned) {
  Image16 samples{kImageWidth, kImageHeight, 5000};
  for (int u = 0; u < kImageWidth; ++u) samples(u, 0) = 10000;  // the uppermost row is farther away
  fs::create_directories(folder_ / "depth");
  ASSERT_TRUE(write_png16(folder_ / "depth/1.png", samples));
  color("rgb/1.png");
  folder_.write("associations.txt", "1 rgb/1.png 1 depth/1.png\n");
  folder_.write("livingRoom0.gt.freiburg", "1 0.4 0 0 0 0 0 1\n");
  EXPECT_NE(refusal().find("--intrinsics"), std::string::npos);
  const auto source = opened({.intrinsics = *parse_intrinsics("10,-10,3.5,1.5")});
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::icl_nuim);
  EXPECT_TRUE(has_note(*source, "mirrored"));
  EXPECT_EQ(source->camera().fy, 10.0);
  EXPECT_EQ(source->camera().cy, 3.5);
  const auto frame = source->at(0);
  ASSERT_TRUE(frame && frame->color);
  EXPECT_EQ(frame->depth(0, 0), 1.0F);
  EXPECT_EQ(frame->depth(0, kImageHeight - 1), 2.0F);
  EXPECT_EQ((*frame->color)(2, 0)[1], kImageHeight - 1);
  EXPECT_EQ(frames(*source), (Lines{"1 1.00 at 0.4"}));
  folder_.write("associations.txt", "1 a/1.png 1 b/1.png\n");
  EXPECT_NE(refusal().find("'depth'"), std::string::npos);
}

TEST_F(Layouts, Open3dFoldersHaveManyNamesAndFormats) {
  fs::create_directories(folder_ / "depth");
  const std::string metres = test::bytes_of_values(std::vector<float>(kImageWidth * kImageHeight, 1.25F));
  folder_.write("depth/0.npy", test::make_npy("<f4", "(6, 8)", metres));
  folder_.write("depth/1.tiff", test::make_tiff(kImageWidth, kImageHeight, 32, 3, metres));
  depth("depth/2.png", 1250);
  color("images/0.png", 3, 3);
  folder_.write("intrinsic.json", R"({"width": 8, "height": 6, "depth_scale": 1000.0,
                                      "intrinsic_matrix": [10, 0, 0, 0, 10, 0, 3.5, 2.5, 1]})");
  folder_.write("poses.txt", "1 0 0 0.1 0 1 0 0 0 0 1 0\n1 0 0 0.2 0 1 0 0 0 0 1 0\n1 0 0 0.3 0 1 0 0 0 0 1 0\n");
  const auto source = opened();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().layout, RgbdLayout::open3d);
  EXPECT_FALSE(source->info().has_color);
  EXPECT_TRUE(has_note(*source, "colour images of 3x3 are left out"));
  EXPECT_EQ(frames(*source), (Lines{"0 1.25 at 0.1", "1 1.25 at 0.2", "2 1.25 at 0.3"}));
  folder_.write("depth/3.exr", "\x76\x2f\x31\x01");
  folder_.write("poses.txt", "1 0 0 0.1 0 1 0 0 0 0 1 0\n");
  const Lines all = frames(*opened());
  EXPECT_NE(all[1].find("no pose"), std::string::npos) << all[1];
  EXPECT_NE(frames(*opened({.require_poses = false}))[3].find("OpenEXR"), std::string::npos);
  folder_.write("intrinsic.json", R"({"fx": 10, "fy": 10, "cx": 3.5, "cy": 2.5, "depth_scale": 1.0})");
  EXPECT_NE(refusal().find("depth_scale of 1.0"), std::string::npos);
}

TEST_F(Layouts, Sun3dPairsByTimeAndRotatesItsDepths) {
  const auto rotated = [](int millimetres) { return static_cast<std::uint16_t>(millimetres << 3 | millimetres >> 13); };
  depth("depth/0000001-000000020000.png", rotated(1500));
  depth("depth/0000002-000000053000.png", rotated(2500));
  depth("depth/0000003-000009000000.png", rotated(1700));
  for (const char* name : {"0000001-000000000000", "0000002-000000022000", "0000003-000000055000"}) {
    color(std::string{"image/"} + name + ".jpg.png");
    fs::rename(folder_ / (std::string{"image/"} + name + ".jpg.png"),
               folder_ / (std::string{"image/"} + name + ".png"));
  }
  folder_.write("intrinsics.txt", "10 0 3.5\n0 10 2.5\n0 0 1\n");
  const auto row = [](const std::string& x) { return "1 0 0 " + x + "\n0 1 0 0\n0 0 1 0\n"; };
  folder_.write("extrinsics/20120101.txt", row("8") + row("8") + row("8"));
  folder_.write("extrinsics/20130101.txt", row("0.1") + row("0.2") + row("0.3"));
  const auto source = opened();
  EXPECT_EQ(source->info().layout, RgbdLayout::sun3d);
  EXPECT_TRUE(has_note(*source, "poses are those of 20130101.txt"));
  EXPECT_EQ(frames(*source), (Lines{"0000001-000000020000 1.50 at 0.2", "0000002-000000053000 2.50 at 0.3",
                                    "skipped: frame 0000003-000009000000: has no pose, as others here have"}));
  folder_.write("extrinsics/20130101.txt", row("0.1") + row("nan") + "1 0 0 0\n0 1 0 0\n0 0 5 0\n");
  const Lines lost = frames(*opened());
  ASSERT_EQ(lost.size(), 3U);
  EXPECT_TRUE(lost[0].starts_with("skipped")) << lost[0];
  EXPECT_TRUE(lost[1].starts_with("skipped")) << lost[1];
  folder_.write("extrinsics/20130101.txt", row("0.1") + "1 0 0 0\n");
  EXPECT_NE(refusal().find("cut short"), std::string::npos) << refusal();
  folder_.write("extrinsics/20130101.txt", "1 0 0\n");
  EXPECT_NE(refusal().find("line 1: four numbers"), std::string::npos) << refusal();
}

TEST_F(Layouts, UnknownFoldersNameTheNearestLayout) {
  color("rgb/0.png");
  folder_.write("scene_camera.json", "{}");
  EXPECT_NE(refusal().find("nearest is that of BOP, which lacks depth/N.png"), std::string::npos) << refusal();
  fs::remove(folder_ / "scene_camera.json");
  fs::remove_all(folder_ / "rgb");
  folder_.write("traj.txt", "");
  color("results/frame000000.png");
  EXPECT_NE(refusal().find("nearest is that of Replica, which lacks results/depthN.png"), std::string::npos)
      << refusal();
  depth("inner/depth/0.png", 1);
  EXPECT_NE(refusal().find("inner/ in it is one of Open3D"), std::string::npos) << refusal();
  folder_.write("scene0000_00.sens", "");
  EXPECT_NE(refusal().find("scene0000_00.sens is packed"), std::string::npos) << refusal();
  EXPECT_NE(refusal({.layout = RgbdLayout::scannet}).find("it lacks intrinsic/intrinsic_depth.txt"), std::string::npos);
}

TEST_F(Layouts, NameTheirDepthFilesAndAPrincipalPointFarOutside) {
  folder_.write("camera-intrinsics.txt", "10 0 3.5\n0 10 2.5\n0 0 1\n");
  for (const std::string stem : {"frame-000000", "frame-000001", "frame-000002"}) {
    depth(stem + ".depth.png", 1000);
    depth(stem + ".label.png", 1);
    color(stem + ".color.png");
    folder_.write(stem + ".pose.txt", pose_at("0"));
  }
  const auto source = opened({.first = 1});
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().depth_files,
            (std::vector<fs::path>{folder_ / "frame-000001.depth.png", folder_ / "frame-000002.depth.png"}));
  EXPECT_TRUE(source->info().notes.empty());
  folder_.write("camera-intrinsics.txt", "10 0 3.5\n0 10 18\n0 0 1\n");
  const auto far = opened();
  ASSERT_TRUE(far);
  ASSERT_EQ(far->info().notes.size(), 1U);
  EXPECT_NE(far->info().notes.front().find("2.0 image heights outside of the image of 8x6"), std::string::npos)
      << far->info().notes.front();
}

}  // namespace
}  // namespace saccade
