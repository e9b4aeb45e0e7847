// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/label_boxes_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

/// A box of 4 x 2 x 1.5 m whose length points 30° from x to y, standing along z or in a camera's frame.
LabelBox car(bool in_camera_frame) {
  LabelBox box{3, 100, {10.0, 2.0, 0.75}, {4.0, 2.0, 1.5}, {}};
  const double yaw_rad = std::numbers::pi / 6.0;
  box.axes << std::cos(yaw_rad), -std::sin(yaw_rad), 0, std::sin(yaw_rad), std::cos(yaw_rad), 0, 0, 0, 1;
  if (!in_camera_frame) return box;
  Eigen::Matrix3d to_camera;
  to_camera << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  box.center_m = to_camera * box.center_m;
  box.axes = to_camera * box.axes;
  return box;
}

const std::vector<NamedLabel> kNames{{3, "my car", "Car", 2, {1, 2, 3}, 100}};

TEST(LabelBoxFiles, HoldTheBoxInEveryFrame) {
  const test::TempFolder folder;
  ASSERT_TRUE(write_label_boxes(folder / "a.json", std::vector{car(false)}, kNames, {500000.0, 0.0, 0.0}));
  const nlohmann::json box = nlohmann::json::parse(*read_text_file(folder / "a.json"))["boxes"][0];
  EXPECT_EQ(box["label"], 3);
  EXPECT_EQ(box["class"], "Car");
  EXPECT_EQ(box["instance"], 2);
  EXPECT_EQ(box["center_m"], (std::vector<double>{500010.0, 2.0, 0.75}));
  EXPECT_EQ(box["size_m"], (std::vector<double>{4.0, 2.0, 1.5}));
  EXPECT_NEAR(box["yaw_rad"].get<double>(), std::numbers::pi / 6.0, 1e-12);
  for (const bool in_camera_frame : {false, true}) {
    ASSERT_TRUE(write_label_boxes(folder / "a.txt", std::vector{car(in_camera_frame)}, kNames, {0, 0, 0}));
    std::istringstream line{*read_text_file(folder / "a.txt")};
    std::string type;
    std::vector<double> values(14);
    line >> type;
    for (double& value : values) line >> value;
    EXPECT_TRUE(line) << "in_camera_frame: " << in_camera_frame;
    EXPECT_EQ(type, "Car");
    const std::vector<double> sizes_and_place(values.begin() + 7, values.begin() + 13);
    EXPECT_EQ(sizes_and_place, (std::vector<double>{1.5, 2.0, 4.0, -2.0, 0.0, 10.0}));
    // At 0 a box of KITTI points along the camera's x, at -90° along its z. Ours lies 30° from z to -x.
    EXPECT_NEAR(values[13], -std::numbers::pi * 2.0 / 3.0, 1e-4);
    EXPECT_NEAR(values[2], values[13] - std::atan2(-2.0, 10.0), 1e-4);
  }
}

TEST(LabelBoxFiles, SayWhatTheyCannotHold) {
  const test::TempFolder folder;
  LabelBox box = car(false);
  box.axes.col(2) = Eigen::Vector3d::UnitX();
  const Status lying = write_label_boxes(folder / "a.txt", std::vector{box}, {}, {0, 0, 0});
  EXPECT_EQ(lying.error().code, Errc::unsupported);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  EXPECT_TRUE(write_label_boxes(folder / "a.json", std::vector{box}, {}, {0, 0, 0}));
  EXPECT_TRUE(nlohmann::json::parse(*read_text_file(folder / "a.json"))["boxes"][0]["yaw_rad"].is_null());
  EXPECT_EQ(write_label_boxes(folder / "a.csv", {}, {}, {0, 0, 0}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
