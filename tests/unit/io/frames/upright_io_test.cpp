// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/upright_io.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "saccade/io/frames/trajectory_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

TEST(UprightIo, ReadsGravityAndTheCamerasBesideAFile) {
  const test::TempFolder folder;
  const auto nothing = read_upright_files(folder / "mesh.ply");
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(nothing->gravity);
  EXPECT_TRUE(nothing->T_world_cameras.empty());
  std::ofstream{folder / "gravity-direction.txt"} << "-8.8e-03\n9.04e-01\n4.26e-01\n";
  ASSERT_TRUE(write_tum_trajectory(folder / "trajectory.txt", std::vector<StampedPose>{{0.0, Pose::Identity()}}));
  for (const auto& path : {folder.path(), folder / "mesh.ply"}) {
    const auto files = read_upright_files(path);
    ASSERT_TRUE(files);
    ASSERT_TRUE(files->gravity);
    EXPECT_EQ(*files->gravity, Eigen::Vector3d(-8.8e-03, 9.04e-01, 4.26e-01));
    EXPECT_EQ(files->T_world_cameras.size(), 1U);
  }
}

TEST(UprightIo, WhatIsNoDirectionIsSaid) {
  for (const char* text : {"", "1 2", "0 0 0", "1 2 3 4", "a b c"}) {
    const test::TempFolder folder;
    std::ofstream{folder / "gravity-direction.txt"} << text;
    const auto files = read_upright_files(folder.path());
    ASSERT_FALSE(files) << text;
    EXPECT_EQ(files.error().code, Errc::corrupt_data);
  }
}

}  // namespace
}  // namespace saccade
