// SPDX-License-Identifier: Apache-2.0
// A device that is lost, and one that is full, are told apart: the first is left at once, the second goes on.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "failing_compute.hpp"
#include "saccade/cuda/hybrid_map.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/views/internal/state_volume.hpp"

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
  for (int call = 0; call < 4; ++call) {
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
    } else if (call == 2) {
      EXPECT_EQ(map.expected_surface({}, {}).value().seen_cm2,
                expected_surface(maps.cpu.content(), {}, {}).value().seen_cm2);
    } else {
      ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
      ASSERT_TRUE(map.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
    }
    EXPECT_FALSE(map.on_gpu());
    EXPECT_NE(map.gpu_problem().find("lost"), std::string::npos) << map.gpu_problem();
    EXPECT_TRUE(map.snapshot({}).value().grid == maps.cpu.content().grid);
  }
}

TEST(DeviceFaults, AFullGpuIsSaidThoughTheCpuCompletesTheSurface) {
  Maps maps;
  HybridMap map = HybridMap::create(small_voxels(), std::move(maps.gpu)).value();
  ASSERT_TRUE(map.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  ASSERT_TRUE(map.expected_surface({}, {}).ok());
  EXPECT_EQ(map.gpu_problem(), "");
  maps.faults->kernel_without_room = "saccade_read_states";
  maps.faults->times = 1000;
  const ExpectedSurface surface = map.expected_surface({}, {}).value();
  EXPECT_EQ(surface.volume->ticket(), 0U) << "the CPU did the work";
  EXPECT_GT(surface.volume->size(), 0U);
  EXPECT_EQ(map.gpu_problem(), "no room for a kernel");
  EXPECT_TRUE(map.on_gpu());
}

TEST(DeviceFaults, AViewDeviceSaysOnceWhyTheCpuWentOn) {
  Maps maps;
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  ViewDevice& device = maps.gpu;
  const ExpectedSurface done = expected_surface(maps.cpu.content(), {}, {}, &device).value();
  EXPECT_NE(done.volume->ticket(), 0U);
  EXPECT_FALSE(device.take_problem().has_value());
  EXPECT_FALSE(device.in_sight(done.volume->ticket() + 1, {}, {}, 0.1).ok());
  EXPECT_FALSE(device.take_problem().has_value()) << "the caller's mistake";
  maps.faults->lost = true;
  for (const bool first : {true, false}) {
    const ExpectedSurface surface = expected_surface(maps.cpu.content(), {}, {}, &device).value();
    EXPECT_EQ(surface.volume->ticket(), 0U);
    EXPECT_EQ(surface.seen_cm2, done.seen_cm2);
    const std::optional<Error> problem = device.take_problem();
    EXPECT_EQ(problem ? problem->message : "", first ? "the device is lost" : "") << "the cause, not that it was lost";
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
    ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
    // Once: the room of other work's buffers suffices. Twice: that of the bricks elsewhere, too.
    for (const int times : {1, 2}) {
      maps.faults->kernel_without_room = kernel;
      maps.faults->times = times;
      ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
      ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
      EXPECT_TRUE(same_depth(maps.gpu.raycast(kCamera, maps.T_world_camera).value(),
                             raycast(maps.cpu.content(), kCamera, maps.T_world_camera, {}).value()));
      EXPECT_EQ(maps.gpu.evaluate_views(maps.region, maps.views, maps.gain, {}).value().gains,
                evaluate_views(maps.cpu.content(), maps.region, maps.views, maps.gain, {}).value().gains);
      EXPECT_EQ(maps.faults->times, 0);
      EXPECT_EQ(maps.gpu.is_paged(), times == 2);
      EXPECT_FALSE(maps.gpu.is_lost());
      EXPECT_TRUE(maps.gpu.snapshot().value().grid == maps.cpu.content().grid);
    }
  }
}

/// A device with room for the map and one work's buffers keeps the map, whatever work it does in turn.
TEST(DeviceFaults, BuffersOfOtherWorkGoBeforeTheMapDoes) {
  Maps maps;
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  const TsdfSnapshot content = maps.cpu.snapshot();
  const PinholeCamera fine{320, 240, 300.0, 300.0, 159.5, 119.5, 0.2, 1.0};  // 1.2 MB of results
  const IndexBox box = IndexBox::cube({-50, -50, 60}, 100);                  // 1 MB of states
  std::vector<VoxelState> states(static_cast<std::size_t>(box.count()));
  std::size_t memory{1'000'000};
  for (;; memory += memory / 20) {
    ASSERT_LT(memory, 50'000'000U);
    GpuMap alone = GpuMap::create_emulated(small_voxels(), {}, memory).value();
    ASSERT_TRUE(alone.follow(content, {}).ok());
    if (alone.is_paged()) continue;
    if (alone.raycast(fine, maps.T_world_camera).ok() && !alone.is_paged()) break;
  }
  GpuMap gpu = GpuMap::create_emulated(small_voxels(), {}, memory).value();
  ASSERT_TRUE(gpu.follow(content, {}).ok());
  const SurfaceView wanted = raycast(content, fine, maps.T_world_camera, {}).value();
  for (int turn = 0; turn < 2; ++turn) {
    const auto ticket = gpu.read_states(box, states);
    ASSERT_TRUE(ticket.ok());
    EXPECT_EQ(ticket.value(), static_cast<std::uint64_t>(turn) + 1) << "no ticket is given twice";
    EXPECT_TRUE(same_depth(gpu.raycast(fine, maps.T_world_camera).value(), wanted));
    EXPECT_FALSE(gpu.is_paged());
    EXPECT_EQ(gpu.in_sight(ticket.value(), {}, {}, 0.1).error().code, Errc::invalid_argument) << "its states are gone";
  }
}

TEST(DeviceFaults, ASmallerMapIsTriedWholeAgain) {
  Maps maps;
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  int paged{0};
  for (std::size_t memory = 100'000; memory < 100'000'000; memory *= 2) {
    SCOPED_TRACE(memory);
    GpuMap gpu = GpuMap::create_emulated(small_voxels(), {}, memory).value();
    ASSERT_TRUE(gpu.follow(maps.cpu.content(), {}).ok());
    if (!gpu.is_paged()) break;
    ++paged;
    ASSERT_TRUE(gpu.follow(maps.cpu.content(), {}).ok());
    EXPECT_TRUE(gpu.is_paged()) << "it is not smaller";
    ASSERT_TRUE(gpu.follow({small_voxels(), {}}, {}).ok());
    EXPECT_FALSE(gpu.is_paged());
    EXPECT_TRUE(gpu.snapshot().value().grid.empty());
    ASSERT_TRUE(gpu.follow(maps.cpu.content(), {}).ok());
    EXPECT_TRUE(gpu.is_paged()) << "there is no more room than before";
    EXPECT_TRUE(gpu.snapshot().value().grid == maps.cpu.content().grid);
  }
  EXPECT_GT(paged, 1);
}

/// Two places side by side are looked at in turn, on a device with room for both, but not for others far away.
TEST(DeviceFaults, PagesThatTakeTurnsStayTogether) {
  Maps maps;
  std::vector<Pose> poses;
  for (const double x : {0.0, 0.8, 12.0, 24.0}) {
    poses.push_back(Pose::Identity());
    poses.back().translation().x() = x;
    ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), poses.back(), {}).ok());
  }
  constexpr std::uint64_t kPictures{4000};  // bytes that the calls themselves send, without bricks
  int settled{0};
  for (std::size_t memory = 500'000; memory < 100'000'000; memory += memory / 4) {
    SCOPED_TRACE(memory);
    GpuMap gpu = GpuMap::create_emulated(small_voxels(), {}, memory).value();
    ASSERT_TRUE(gpu.follow(maps.cpu.content(), {}).ok());
    if (!gpu.is_paged()) break;
    std::uint64_t sent{0};
    int done{0};
    for (int turn = 0; turn < 4; ++turn) {
      sent = gpu.traffic().bytes_sent;
      for (int place = 0; place < 2; ++place) {
        const Pose& pose = poses[static_cast<std::size_t>(place)];
        const auto seen = gpu.raycast(kCamera, pose);
        if (!seen.ok()) continue;
        EXPECT_TRUE(same_depth(seen.value(), raycast(maps.cpu.content(), kCamera, pose, {}).value()));
        ++done;
      }
    }
    settled += done == 8 && gpu.traffic().bytes_sent - sent < kPictures ? 1 : 0;
  }
  EXPECT_GT(settled, 0);
}

TEST(DeviceFaults, AMapOnTheGpuIsTakenOver) {
  Maps maps;
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  ASSERT_TRUE(maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).ok());
  HybridMap map = HybridMap::create(small_voxels(), std::move(maps.gpu)).value();
  EXPECT_TRUE(map.snapshot({}).value().grid == maps.cpu.content().grid);
  ASSERT_TRUE(maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  ASSERT_TRUE(map.integrate(kCamera, waves(), maps.T_world_camera, {}).ok());
  maps.faults->lost = true;  // what was there at first is not among the frames that are fused again
  EXPECT_TRUE(map.snapshot({}).value().grid == maps.cpu.content().grid);
  EXPECT_FALSE(map.on_gpu());
}

/// The statistics of both back ends agree in the pixels alone, as gpu_map.hpp says.
TEST(DeviceFaults, StatisticsCountBricksByBackEnd) {
  Maps maps;
  const FusionStats on_cpu = maps.cpu.integrate(kCamera, waves(), maps.T_world_camera, {}).value();
  const FusionStats on_gpu = maps.gpu.integrate(kCamera, waves(), maps.T_world_camera).value();
  EXPECT_EQ(on_gpu.valid_pixels, on_cpu.valid_pixels);
  EXPECT_GT(on_gpu.bricks_updated, 0U);
  EXPECT_EQ(on_gpu.bricks_free + on_gpu.bricks_saturated, 0U);
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
