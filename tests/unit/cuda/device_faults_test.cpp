// SPDX-License-Identifier: Apache-2.0
// A device that is lost, and one that is full, are told apart: the first is left at once, the second goes on.
#include <gtest/gtest.h>

#include <cstring>

#include "failing_compute.hpp"
#include "saccade/cuda/hybrid_map.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"

namespace saccade {
namespace {

using internal::cuda::BrickStore;
using internal::cuda::GpuFusion;
using internal::cuda::GpuMapMaker;
using internal::cuda::HostCompute;
using test::FailingCompute;
using test::Faults;

const PinholeCamera kCamera{64, 48, 60.0, 60.0, 31.5, 23.5, 0.2, 1.0};

DepthImage waves() {
  DepthImage depth{kCamera.width, kCamera.height};
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) depth(u, v) = 0.7F + 0.1F * std::sin(0.3F * static_cast<float>(u + v));
  }
  return depth;
}

TsdfConfig small_voxels() {
  TsdfConfig config;
  config.voxel_size_m = 0.006;
  return config;
}

/// A map on a device that can be broken, and the CPU's.
struct Maps {
  std::shared_ptr<Faults> faults{std::make_shared<Faults>()};
  GpuMap gpu{GpuMapMaker::make(small_voxels(), std::make_unique<FailingCompute>(faults))};
  TsdfMap cpu{TsdfMap::create(small_voxels()).value()};
  Pose T_world_camera{Pose::Identity()};
  Region region{Sphere{{0.0, 0.0, 0.7}, 0.15}};
  std::vector<Pose> views{Pose::Identity()};
  GainConfig gain{};

  Maps() {
    gain.sensor = kCamera;
    faults->times = 0;
  }
};

bool same_depth(const SurfaceView& a, const SurfaceView& b) {
  return std::memcmp(a.depth.data(), b.depth.data(), a.depth.size() * sizeof(float)) == 0;
}

TEST(DeviceFaults, ALostGpuIsLeftThoughNothingWasFusedSince) {
  for (int call = 0; call < 3; ++call) {
    SCOPED_TRACE(call);
    Maps maps;
    HybridMap map = HybridMap::create(small_voxels(), std::move(maps.gpu)).value();
    ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    ASSERT_TRUE(map.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    ASSERT_TRUE(map.snapshot({}).ok());
    ASSERT_TRUE(map.on_gpu());
    maps.faults->lost = true;
    if (call == 0) {
      EXPECT_TRUE(same_depth(map.raycast(kCamera, maps.T_world_camera, {}).value(),
                             raycast(maps.cpu.content(), kCamera, maps.T_world_camera, {}).value()));
    } else if (call == 1) {
      EXPECT_EQ(map.evaluate_views(maps.region, maps.views, maps.gain, {}).value().gains,
                evaluate_views(maps.cpu.content(), maps.region, maps.views, maps.gain, {}).value().gains);
    } else {
      ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
      ASSERT_TRUE(map.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    }
    EXPECT_FALSE(map.on_gpu());
    EXPECT_NE(map.gpu_problem().find("lost"), std::string::npos) << map.gpu_problem();
    EXPECT_TRUE(map.snapshot({}).value().grid == maps.cpu.content().grid);
  }
}

TEST(DeviceFaults, ALostGpuIsNotTakenForAFullOne) {
  Maps maps;
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  ASSERT_TRUE(maps.gpu.follow(maps.cpu.content(), {}).ok());
  EXPECT_FALSE(maps.gpu.is_lost());
  ASSERT_TRUE(maps.cpu.forget(maps.region).ok());
  maps.faults->lost = true;
  EXPECT_EQ(maps.gpu.follow(maps.cpu.content(), {}).error().code, Errc::unavailable);
  EXPECT_TRUE(maps.gpu.is_lost());
  EXPECT_FALSE(maps.gpu.is_paged());
  maps.faults->lost = false;  // what comes back has another memory
  EXPECT_FALSE(maps.gpu.snapshot().ok());
  EXPECT_FALSE(maps.gpu.raycast(kCamera, maps.T_world_camera).ok());
}

TEST(DeviceFaults, WhatAFullGpuHoldsComesHomeLater) {
  for (const char* kernel : {"saccade_list_touched", "saccade_gather_bricks"}) {
    SCOPED_TRACE(kernel);
    Maps maps;
    ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
    maps.faults->kernel_without_room = kernel;
    maps.faults->times = 1;
    EXPECT_TRUE(internal::cuda::is_no_room(maps.gpu.snapshot().error()));
    EXPECT_FALSE(maps.gpu.is_lost());
    EXPECT_TRUE(maps.gpu.snapshot().value().grid == maps.cpu.content().grid);
  }
}

TEST(DeviceFaults, AKernelWithoutRoomIsTriedAgainInPages) {
  for (const char* kernel : {"saccade_fuse_bricks", "saccade_find_bricks_in_view", "saccade_cast_surface_rays",
                             "saccade_count_scoring_rays"}) {
    SCOPED_TRACE(kernel);
    Maps maps;
    ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
    maps.faults->kernel_without_room = kernel;
    maps.faults->times = 1;
    ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
    EXPECT_TRUE(same_depth(maps.gpu.raycast(kCamera, maps.T_world_camera).value(),
                           raycast(maps.cpu.content(), kCamera, maps.T_world_camera, {}).value()));
    EXPECT_EQ(maps.gpu.evaluate_views(maps.region, maps.views, maps.gain, {}).value().gains,
              evaluate_views(maps.cpu.content(), maps.region, maps.views, maps.gain, {}).value().gains);
    EXPECT_EQ(maps.faults->times, 0);
    EXPECT_TRUE(maps.gpu.is_paged());
    EXPECT_FALSE(maps.gpu.is_lost());
    EXPECT_TRUE(maps.gpu.snapshot().value().grid == maps.cpu.content().grid);
  }
}

/// Bricks that have a slot are not counted again: the room of the first image suffices for all that see the same.
TEST(DeviceFaults, BricksThatHaveASlotTakeNoOther) {
  HostCompute device{Executor{}};
  BrickStore bricks{device};
  GpuFusion fusion{device};
  TsdfConfig config = small_voxels();
  config.voxel_size_m = 0.004;
  std::size_t slots{0};
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(fusion.integrate(config, kCamera, waves(), Pose::Identity(), bricks).ok());
    if (i == 0) slots = bricks.slots();
    EXPECT_EQ(bricks.slots(), slots);
  }
  EXPECT_GT(slots, 1024U);
  EXPECT_GT(bricks.used_slots(), 500U);
}

TEST(DeviceFaults, PoolsGrowByWhatIsNeededWhereThereIsNoMore) {
  constexpr std::size_t kHeld{4000};
  constexpr std::size_t kSlotBytes{2 * 2 * kBrickVoxels + 2 * kBrickVoxels / 8};
  HostCompute device{Executor{}, kHeld * kSlotBytes + (kHeld + 100) * 2 * kBrickVoxels};
  BrickStore bricks{device};
  ASSERT_TRUE(bricks.reserve_slots(kHeld).ok());
  bricks.set_used_slots(kHeld);
  ASSERT_TRUE(bricks.reserve_slots(1).ok());
  EXPECT_EQ(bricks.slots(), kHeld + 1);
  EXPECT_TRUE(internal::cuda::is_no_room(bricks.reserve_slots(kHeld).error()));
  EXPECT_EQ(bricks.slots(), kHeld + 1);
}

TEST(DeviceFaults, AMapOfAnotherConfigurationIsRefused) {
  TsdfConfig config = small_voxels();
  config.workspace = Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  const auto made = [](const TsdfConfig& of_gpu, const TsdfConfig& of_map) {
    return HybridMap::create(of_map, GpuMap::create_emulated(of_gpu, {}).value());
  };
  EXPECT_TRUE(made(config, config).ok());
  TsdfConfig other = config;
  other.color = !other.color;  // no map on a GPU has colours
  EXPECT_TRUE(made(config, other).ok());
  for (int i = 0; i < 3; ++i) {
    other = config;
    if (i == 0) other.workspace.reset();
    if (i == 1) other.max_weight = 100;
    if (i == 2) other.workspace->max.x() = 2.0;
    EXPECT_EQ(made(config, other).error().code, Errc::invalid_argument);
  }
}

}  // namespace
}  // namespace saccade
