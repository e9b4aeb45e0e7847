// SPDX-License-Identifier: Apache-2.0
// Surfels in PLY and PCD: every column, modes in place of averages, surfels without colour.
#include "saccade/io/clouds/surfel_cloud.hpp"

#include <gtest/gtest.h>

#include "saccade/io/clouds/cloud_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

SurfelMap two_surfels() {
  SurfelMap map;
  map.resize(2);
  map.discs[0] = {{1.0F, 2.0F, 3.0F}, 0.01F, {0.0F, 0.0F, 1.0F}, 5.0F};
  map.discs[1] = {{-1.0F, 0.5F, 0.25F}, 0.02F, {0.0F, -1.0F, 0.0F}, 0.5F};
  map.colors[0] = {{1.0F, 0.5F, 0.0F}, 4.0F};
  map.colors[1] = {{0.0F, 0.0F, 1.0F}, 0.25F};
  return map;
}

TEST(SurfelCloud, EveryColumnIsThere) {
  const test::TempFolder folder;
  for (const char* name : {"cloud.ply", "cloud.pcd"}) {
    ASSERT_TRUE(write_surfel_cloud(folder / name, two_surfels()));
    const CloudFile file = read_cloud(folder / name).value();
    ASSERT_EQ(file.fields().rows, 2U);
    EXPECT_EQ(file.fields().find("radius")->values<float>(), (std::vector<float>{0.01F, 0.02F}));
    EXPECT_EQ(file.fields().find("confidence")->values<float>(), (std::vector<float>{5.0F, 0.5F}));
    const PointCloud cloud = cloud_from_fields(file.fields()).value();
    EXPECT_EQ(cloud.positions_m[1], two_surfels().discs[1].position_m);
    EXPECT_EQ(cloud.normals[1], two_surfels().discs[1].normal);
    EXPECT_EQ(cloud.colors[0], (Eigen::Vector3f{1.0F, 128.0F / 255.0F, 0.0F}));
    EXPECT_EQ(cloud.colors[1], (Eigen::Vector3f{0.0F, 0.0F, 1.0F}));
  }
}

TEST(SurfelCloud, ModesStandForAveragesWhereThereAreAny) {
  const test::TempFolder folder;
  const std::vector<SurfelMode> modes{{{0.0F, 1.0F, 0.0F}, {1.1F, 2.0F, 3.0F}, 2.0F}, {}};
  ASSERT_TRUE(write_surfel_cloud(folder / "cloud.ply", two_surfels(), modes));
  const CloudFile file = read_cloud(folder / "cloud.ply").value();
  const PointCloud cloud = cloud_from_fields(file.fields()).value();
  EXPECT_EQ(cloud.positions_m[0], modes[0].position_m);
  EXPECT_EQ(cloud.colors[0], modes[0].color);
  EXPECT_EQ(cloud.positions_m[1], two_surfels().discs[1].position_m);
  EXPECT_EQ(file.fields().find("confidence")->values<float>(), (std::vector<float>{5.0F, 0.5F}));
  EXPECT_EQ(write_surfel_cloud(folder / "cloud.ply", two_surfels(), std::vector<SurfelMode>(1)).error().code,
            Errc::size_mismatch);
}

TEST(SurfelCloud, SurfelsOfLessWeightAreLeftOut) {
  const test::TempFolder folder;
  ASSERT_TRUE(write_surfel_cloud(folder / "cloud.ply", two_surfels(), {}, 0.6));
  const CloudFile file = read_cloud(folder / "cloud.ply").value();
  EXPECT_EQ(file.fields().find("confidence")->values<float>(), (std::vector<float>{5.0F}));
  ASSERT_TRUE(write_surfel_cloud(folder / "cloud.ply", two_surfels(), {}, 0.5));
  EXPECT_EQ(read_cloud(folder / "cloud.ply").value().fields().rows, 2U);
}

TEST(SurfelCloud, WhatHasNoColourIsNoBlackSurfel) {
  const test::TempFolder folder;
  SurfelMap map = two_surfels();
  map.colors[1].weight = 0.0F;
  for (const std::vector<SurfelMode>& modes : {std::vector<SurfelMode>{}, std::vector<SurfelMode>(2)}) {
    ASSERT_TRUE(write_surfel_cloud(folder / "cloud.ply", map, modes));
    EXPECT_EQ(read_cloud(folder / "cloud.ply").value().fields().find("confidence")->values<float>(),
              (std::vector<float>{5.0F}));
  }
}

TEST(SurfelCloud, WithoutAnyColourThereIsNone) {
  const test::TempFolder folder;
  SurfelMap map = two_surfels();
  for (SurfelColor& color : map.colors) color.weight = 0.0F;
  ASSERT_TRUE(write_surfel_cloud(folder / "cloud.ply", map));
  const CloudFile file = read_cloud(folder / "cloud.ply").value();
  EXPECT_EQ(file.fields().find("red"), nullptr);
  EXPECT_EQ(file.fields().rows, 2U);
  EXPECT_TRUE(cloud_from_fields(file.fields()).value().colors.empty());
}

}  // namespace
}  // namespace saccade
