// SPDX-License-Identifier: Apache-2.0
// Recordings of several cameras and of real lenses: RTAB-Map with images side by side, and Azure Kinect as it is
// calibrated in the factory.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/azure_kinect.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "support/depth_files.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

std::string refusal(const TempFolder& folder) {
  const auto source = open_rgbd_folder(folder.path());
  EXPECT_FALSE(source);
  return source ? "opened" : source.error().to_string();
}

constexpr int kStripWidth{8};
constexpr int kStripHeight{6};

/// Calibration of a camera that looks along the robot's x, or against it.
std::string strip_calibration(bool ahead) {
  const std::string x = ahead ? "1" : "-1";
  const std::string minus_x = ahead ? "-1" : "1";
  return "%YAML:1.0\n---\nimage_width: 8\nimage_height: 6\ncamera_matrix:\n   rows: 3\n   cols: 3\n   data: [ " +
         std::string{ahead ? "10" : "20"} +
         ", 0., 3.5, 0., 10., 2.5, 0., 0., 1. ]\nlocal_transform:\n   rows: 3\n   cols: 4\n   data: [ 0., 0., " + x +
         ", 0.2, " + minus_x + ", 0., 0., 0., 0., -1., 0., 0. ]\n";
}

/// Two cameras back to back: depths of 1 m and 2 m, side by side.
void write_two_cameras(const TempFolder& folder, const std::string& name) {
  for (const char* kind : {"map_depth", "map_rgb", "map_calib"}) fs::create_directories(folder / kind);
  Image16 depth{2 * kStripWidth, kStripHeight, 1000};
  ColorImage color{2 * kStripWidth, kStripHeight, {200, 0, 0}};
  for (int v = 0; v < kStripHeight; ++v) {
    for (int u = kStripWidth; u < 2 * kStripWidth; ++u) {
      depth(u, v) = 2000;
      color(u, v) = {0, 0, 200};
    }
  }
  ASSERT_TRUE(write_png16(folder / ("map_depth/" + name + ".png"), depth));
  ASSERT_TRUE(write_png(folder / ("map_rgb/" + name + ".png"), color));
  folder.write("map_calib/" + name + "_0.yaml", strip_calibration(true));
  folder.write("map_calib/" + name + "_1.yaml", strip_calibration(false));
}

void expect_two_cameras(const TempFolder& folder) {
  const auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->info().layout, RgbdLayout::rtabmap);
  ASSERT_EQ((*source)->size(), 4U);
  EXPECT_EQ((*source)->camera().width, kStripWidth);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool ahead = i % 2 == 0;
    const auto frame = (*source)->at(i);
    ASSERT_TRUE(frame && frame->color && frame->T_world_camera);
    EXPECT_EQ(frame->name, (i < 2 ? "3_" : "12_") + std::to_string(i % 2));
    EXPECT_EQ(frame->depth(4, 3), ahead ? 1.0F : 2.0F);
    EXPECT_EQ((*frame->color)(4, 3)[0], ahead ? 200 : 0);
    const Eigen::Vector3d seen = *frame->T_world_camera * Eigen::Vector3d{0.0, 0.0, 1.0};
    EXPECT_NEAR(seen.x(), (i < 2 ? 0.3 : 0.6) + 0.2 + (ahead ? 1.0 : -1.0), 1e-9);
  }
  // The second camera's focal length is twice the first's, on whose pixels its image is moved: half of it is left.
  const auto second = (*source)->at(1);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->depth(2, 3), 2.0F);
  EXPECT_EQ(second->depth(0, 3), 0.0F);
  EXPECT_EQ((*source)->at(0)->depth(0, 3), 1.0F);
}

TEST(RtabMapCameras, SideBySideAreFramesOfTheirOwn) {
  const TempFolder folder;
  for (const char* name : {"3", "12"}) write_two_cameras(folder, name);
  folder.write("map_poses.txt", "9.1 0.3 0 0 0 0 0 1 3\n9.2 0.6 0 0 0 0 0 1 12\n");
  expect_two_cameras(folder);
  // Poses of each camera give equal frames: their axes are those of local_transform.
  folder.write("map_camera_poses_0.txt", "9.1 0.5 0 0 -0.5 0.5 -0.5 0.5 3\n9.2 0.8 0 0 -0.5 0.5 -0.5 0.5 12\n");
  EXPECT_NE(refusal(folder).find("calib/ has 2 cameras"), std::string::npos);
  folder.write("map_camera_poses_1.txt", "9.1 0.5 0 0 -0.5 -0.5 0.5 0.5 3\n9.2 0.8 0 0 -0.5 -0.5 0.5 0.5 12\n");
  expect_two_cameras(folder);
}

// A device's numbers, as its calibration.json has them and as the maker's library converts them for images.
constexpr const char* kDepthParameters{
    "0.5122697949409485, 0.49451231956481934, 0.4921168386936188, 0.4921667277812958, 3.1305770874023438, "
    "2.324939012527466, 0.1304156482219696, 3.458651542663574, 3.350114583969116, 0.6629416346549988, 0, 0, "
    "-5.11557373101823e-05, 8.132171933539212e-05"};
constexpr const char* kColorParameters{
    "0.4967627227306366, 0.5108628273010254, 0.470907062292099, 0.6274453997612, 0.7227460145950317, "
    "-2.8855903148651123, 1.6327226161956787, 0.6021990180015564, -2.7196261882781982, 1.565053105354309, 0, 0, "
    "-1.431911950930953e-04, 7.828465895727277e-04"};

std::string azure_camera(const std::string& location, const char* parameters, const char* rt,
                         const std::string& model = "BrownConrady") {
  return R"({"Intrinsics": {"ModelParameterCount": 14, "ModelParameters": [)" + std::string{parameters} +
         R"(], "ModelType": "CALIBRATION_LensDistortionModel)" + model +
         R"("}, "Location": "CALIBRATION_CameraLocation)" + location + R"(", "Rt": )" + rt + "}";
}

constexpr const char* kNoMotion{R"({"Rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "Translation": [0, 0, 0]})"};
constexpr const char* kToColor{
    R"({"Rotation": [1, 0, 0, 0, 0.995, 0.09987492177719089, 0, -0.09987492177719089, 0.995],
        "Translation": [-0.032, -0.002, 0.004]})"};

std::string azure_calibration(const std::string& depth) {
  return R"({"CalibrationInformation": {"Cameras": [)" + depth + ", " +
         azure_camera("PV0", kColorParameters, kToColor) + R"(], "InertialSensors": []}})";
}

TEST(AzureKinect, CalibrationIsConvertedAsByTheMaker) {
  const auto read = parse_azure_kinect_calibration(azure_calibration(azure_camera("D0", kDepthParameters, kNoMotion)));
  ASSERT_TRUE(read) << read.error().to_string();
  const auto depth = read->of_depth_images(640, 576);
  ASSERT_TRUE(depth);
  EXPECT_NEAR(depth->cx, 332.064270, 1e-5);
  EXPECT_NEAR(depth->cy, 325.880615, 1e-5);
  EXPECT_NEAR(depth->fx, 503.927643, 1e-5);
  EXPECT_NEAR(depth->fy, 503.978729, 1e-5);
  EXPECT_NEAR(depth->distortion->k6, 0.662942, 1e-6);
  EXPECT_NEAR(depth->distortion->p1, 0.000081, 1e-6);
  EXPECT_NEAR(depth->distortion->p2, -0.000051, 1e-6);
  const auto color = read->of_color_images(1920, 1080);
  ASSERT_TRUE(color);
  EXPECT_NEAR(color->cx, 953.284424, 1e-4);
  EXPECT_NEAR(color->cy, 555.142456, 1e-4);
  EXPECT_NEAR(color->fx, 904.141541, 1e-4);
  EXPECT_NEAR(color->fy, 903.521362, 1e-4);
  const auto binned = read->of_depth_images(320, 288);  // each pixel is two by two of the wider mode's
  ASSERT_TRUE(binned);
  EXPECT_NEAR(binned->cx, (depth->cx + 0.5) / 2 - 0.5, 1e-9);
  EXPECT_NEAR(binned->fy, depth->fy / 2, 1e-9);
  EXPECT_FALSE(read->of_depth_images(640, 480));
  EXPECT_FALSE(read->of_color_images(640, 400));
}

TEST(AzureKinect, FolderIsReadWithItsLensesUndone) {
  const TempFolder folder;
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / "color");
  ASSERT_TRUE(write_png16(folder / "depth/000000.png", Image16{320, 288, 1000}));
  ColorImage color{1280, 720};
  for (int v = 0; v < 720; ++v) {
    for (int u = 0; u < 1280; ++u) {
      color(u, v) = {static_cast<std::uint8_t>(u / 8), static_cast<std::uint8_t>(v / 4), 99};
    }
  }
  ASSERT_TRUE(write_png(folder / "color/000000.png", color));
  folder.write("calibration.json", azure_calibration(azure_camera("D0", kDepthParameters, kNoMotion)));
  const auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source) << source.error().to_string();
  const auto frame = (*source)->at(0);
  ASSERT_TRUE(frame && frame->color) << frame.error().to_string();
  const PinholeCamera& camera = (*source)->camera();
  EXPECT_NEAR(camera.fx, 0.4921168386936188 * 512, 1e-9);
  // The colour of a point, by the parameters as they are in the file.
  std::size_t checked = 0;
  for (int v = 90; v < 200; v += 10) {
    for (int u = 60; u < 260; u += 10) {
      ASSERT_EQ(frame->depth(u, v), 1.0F);
      const Eigen::Vector3d p = camera.ray(u, v);
      const double z = -0.09987492177719089 * p.y() + 0.995 + 0.004;
      const double x = (p.x() - 0.032) / z;
      const double y = (0.995 * p.y() + 0.09987492177719089 - 0.002) / z;
      const double r2 = x * x + y * y;
      const double radial = (1 + r2 * (0.7227460145950317 + r2 * (-2.8855903148651123 + r2 * 1.6327226161956787))) /
                            (1 + r2 * (0.6021990180015564 + r2 * (-2.7196261882781982 + r2 * 1.565053105354309)));
      const double p1 = 7.828465895727277e-04;
      const double p2 = -1.431911950930953e-04;
      const double bent_x = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
      const double bent_y = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
      const double at_u = (bent_x * 0.470907062292099 + 0.4967627227306366) * 1280 - 0.5;
      const double at_v = (bent_y * 0.6274453997612 + 0.5108628273010254) * 960 - 120 - 0.5;
      EXPECT_NEAR((*frame->color)(u, v)[0], at_u / 8, 1.1) << u << ", " << v;
      EXPECT_NEAR((*frame->color)(u, v)[1], at_v / 4, 1.2) << u << ", " << v;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 220U);
  // intrinsic.json, which Open3D writes where it has moved depths onto colours, comes first.
  folder.write("intrinsic.json", R"({"fx": 300, "fy": 300, "cx": 160, "cy": 144})");
  const auto moved = open_rgbd_folder(folder.path());
  ASSERT_TRUE(moved) << moved.error().to_string();
  EXPECT_EQ((*moved)->camera().fx, 300.0);
}

TEST(AzureKinect, WhatIsWrongIsNamed) {
  const TempFolder folder;
  fs::create_directories(folder / "depth");
  ASSERT_TRUE(write_png16(folder / "depth/000000.png", Image16{640, 400, 1000}));
  folder.write("calibration.json", azure_calibration(azure_camera("D0", kDepthParameters, kNoMotion)));
  EXPECT_NE(refusal(folder).find("no depth images of 640x400"), std::string::npos);
  for (const auto& [depth, part] : std::vector<std::pair<std::string, std::string>>{
           {azure_camera("D1", kDepthParameters, kNoMotion), "no camera CALIBRATION_CameraLocationD0"},
           {azure_camera("D0", "0.5, 0.5, 0.5", kNoMotion), "at least 14 numbers"},
           {azure_camera("D0", kDepthParameters, "{}"), "Rt.Rotation"},
           {azure_camera("D0", kDepthParameters, kNoMotion, "Theta"), "lens model"},
           {"7", "no camera"}}) {
    folder.write("calibration.json", azure_calibration(depth));
    EXPECT_NE(refusal(folder).find(part), std::string::npos) << refusal(folder);
  }
  folder.write("calibration.json", "{\"CalibrationInformation\": ");
  EXPECT_NE(refusal(folder).find("calibration.json"), std::string::npos);
  folder.write("calibration.json", R"({"fx": 300})");  // another program's
  EXPECT_NE(refusal(folder).find("no camera intrinsics here"), std::string::npos);
}

}  // namespace
}  // namespace saccade
