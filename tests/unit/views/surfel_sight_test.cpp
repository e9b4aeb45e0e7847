// SPDX-License-Identifier: Apache-2.0
// Unknown surfels, panoramas of discs, and gains through them, on maps written by hand.
#include "saccade/views/surfel_sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "saccade/core/seeded_random.hpp"
#include "saccade/views/internal/disc_blocks.hpp"
#include "saccade/views/surface_gain.hpp"
#include "support/half_seen_box.hpp"
#include "support/naive_panorama.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::half_seen_box;

const PinholeCamera kSightSensor{160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0};

/// Discs of 4 mm on a square in the plane x = constant.
void add_square(SurfelMap& surfels, double x, double half_m, double z_middle) {
  constexpr float kStep_m{0.005F};
  const int steps = static_cast<int>(half_m / kStep_m);
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      surfels.resize(surfels.size() + 1);
      SurfelDisc& disc = surfels.discs.back();
      disc.position_m = {static_cast<float>(x), kStep_m * static_cast<float>(i),
                         static_cast<float>(z_middle) + kStep_m * static_cast<float>(j)};
      disc.radius_m = 0.004F;
      disc.normal = -Vector3f::UnitX();
      disc.weight = 5.0F;
      surfels.colors.back() = {Vector3f::Zero(), 0.0F};
    }
  }
}

std::vector<SurfelDisc> above_table(std::vector<SurfelDisc> discs) {
  std::erase_if(discs, [](const SurfelDisc& disc) { return disc.position_m.z() < 0.005F; });
  return discs;
}

TEST(UnknownSurfels, LieOnTheFrontierAndFaceEmptySpace) {
  const Executor executor;
  const std::vector<SurfelDisc> discs =
      above_table(unknown_surfels(half_seen_box(), SurfelMap{}, {}, executor).value());
  // The box's inside is unknown up to its seen top and its seen side towards +x: three sides of it are the frontier.
  ASSERT_GT(discs.size(), 200U);
  for (const SurfelDisc& disc : discs) {
    EXPECT_EQ(disc.weight, kUnknownConfidence);
    EXPECT_NEAR(disc.normal.norm(), 1.0F, 1e-5F);
    EXPECT_LT(disc.normal.x(), 0.5F) << "the side towards +x was seen";
    EXPECT_EQ(disc.normal.z(), 0.0F) << "the top was seen";
    const Vector3f beyond = disc.position_m + 0.008F * disc.normal;
    EXPECT_EQ(test::half_seen_box_at(beyond.cast<double>()), VoxelState::empty);
  }
  EXPECT_TRUE(std::any_of(discs.begin(), discs.end(), [](const auto& disc) { return disc.normal.x() == -1.0F; }));
  EXPECT_TRUE(std::any_of(discs.begin(), discs.end(), [](const auto& disc) { return disc.normal.y() == 1.0F; }));
  EXPECT_TRUE(std::any_of(discs.begin(), discs.end(), [](const auto& disc) { return disc.normal.y() == -1.0F; }));
}

TEST(UnknownSurfels, VanishWhereSurfelsWereSeen) {
  const Executor executor;
  const auto at_back = [&](const SurfelMap& surfels) {
    const auto discs = above_table(unknown_surfels(half_seen_box(), surfels, {}, executor).value());
    return std::count_if(discs.begin(), discs.end(), [](const SurfelDisc& disc) {
      return disc.normal.x() < -0.9F && disc.position_m.x() < -0.045F;
    });
  };
  EXPECT_GT(at_back({}), 50);
  SurfelMap seen;
  add_square(seen, -0.045, 0.06, 0.05);
  EXPECT_EQ(at_back(seen), 0);
  for (SurfelDisc& disc : seen.discs) disc.weight = 0.1F;  // a single glance, which may be no surface
  EXPECT_GT(at_back(seen), 50);
}

TEST(UnknownSurfels, VanishWhereSpaceBecameKnown) {
  const Executor executor;
  const TsdfSnapshot known = test::written_map([](const Vector3d& p) {
    const VoxelState state = test::half_seen_box_at(p);
    return state == VoxelState::unknown && p.z() > 0.0 ? VoxelState::occupied : state;
  });
  EXPECT_TRUE(above_table(unknown_surfels(known, SurfelMap{}, {}, executor).value()).empty());
}

TEST(UnknownSurfels, TheThreadCountChangesNothing) {
  const auto with = [](std::size_t threads) {
    return unknown_surfels(half_seen_box(), SurfelMap{}, {}, Executor::with_threads(threads)).value();
  };
  const std::vector<SurfelDisc> one = with(1);
  const std::vector<SurfelDisc> many = with(5);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].position_m, many[i].position_m);
}

std::vector<SurfelDisc> random_discs(std::uint64_t seed, int count) {
  SeededRandom random{seed};
  std::vector<SurfelDisc> discs(static_cast<std::size_t>(count));
  for (SurfelDisc& disc : discs) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
    disc.position_m = {coordinate(), coordinate(), coordinate()};
    disc.radius_m = static_cast<float>(random.uniform(0.001, 0.2));
    disc.normal = (Vector3f{coordinate(), coordinate(), coordinate()} + Vector3f{0.0F, 0.0F, 0.01F}).normalized();
  }
  return discs;
}

TEST(DepthPanorama, IsThatOfDiscByDisc) {
  constexpr int kEdge{24};
  std::size_t covered{0};
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const std::vector<SurfelDisc> discs = random_discs(seed, 60);
    const Vector3f place{0.1F, -0.05F, 0.2F};
    DepthPanorama panorama{place, kEdge};
    panorama.add(discs);
    for (int face = 0; face < 6; ++face) {
      for (int y = 0; y < kEdge; ++y) {
        for (int x = 0; x < kEdge; ++x) {
          const float depth_m = panorama.depths_m()[panorama.index(face, x, y)];
          covered += depth_m < DepthPanorama::kNothing ? 1 : 0;
          ASSERT_EQ(depth_m, test::naive_depth_m(discs, place, panorama, face, x, y))
              << "seed " << seed << ", face " << face << ", pixel " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_GT(covered, 3000U);
}

TEST(ThinnedDiscs, KeepTheHeaviestOfEachCell) {
  SurfelMap surfels;
  surfels.resize(4);
  surfels.discs[0] = {{0.001F, 0.0F, 0.001F}, 0.002F, Vector3f::UnitZ(), 2.0F};
  surfels.discs[1] = {{0.002F, 0.001F, 0.001F}, 0.002F, Vector3f::UnitX(), 3.0F};
  surfels.discs[2] = {{0.051F, 0.0F, 0.001F}, 0.03F, Vector3f::UnitY(), 5.0F};
  surfels.discs[3] = {{0.101F, 0.0F, 0.001F}, 0.002F, Vector3f::UnitY(), 0.5F};  // too light
  const std::vector<SurfelDisc> kept = thinned_discs(surfels, 1.0, 0.01);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].normal, Vector3f::UnitX());
  EXPECT_NEAR(kept[0].radius_m, 0.00866F, 1e-5F);
  EXPECT_EQ(kept[1].radius_m, 0.03F);
}

TEST(DiscBlocks, ThoseInAConeDrawAllThatItsPointsCanMeet) {
  std::size_t compared{0};
  std::size_t left_out{0};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<SurfelDisc> discs = random_discs(seed, 3000);
    for (SurfelDisc& disc : discs) disc.radius_m *= 0.2F;
    const DiscBlocks blocks{discs, 0.2};
    ASSERT_EQ(blocks.discs().size(), discs.size());
    const Vector3f place{-1.4F, 0.3F, 0.2F};
    std::vector<Vector3f> points;
    for (const SurfelDisc& disc : random_discs(100 + seed, 60)) points.push_back(0.4F * disc.position_m);
    DepthPanorama whole{place, 80};
    whole.add(discs);
    DepthPanorama part{place, 80, points};
    std::size_t drawn{0};
    blocks.for_each_in(ViewCone::around(place, points, 4.0F / 80.0F), [&](std::span<const SurfelDisc> some) {
      part.add(some);
      drawn += some.size();
    });
    left_out += discs.size() - drawn;
    for (const Vector3f& point : points) {
      // Discs beyond the reach of the cone hide no point of it.
      const float limit_m = whole.depth_m(point);
      if (whole.nearest_m(point) > limit_m) continue;
      EXPECT_EQ(part.nearest_m(point), whole.nearest_m(point));
      ++compared;
    }
  }
  EXPECT_GT(compared, 20U);
  EXPECT_GT(left_out, 500U);
}

/// Gains of cameras around the box, with lines of sight among surfels.
std::vector<double> gains_around(const SurfelMap& surfels, std::span<const Pose> poses, std::size_t threads) {
  SurfaceGain gain{{.sensor = kSightSensor}, surfel_sight(surfels)};
  const TsdfSnapshot map = half_seen_box();
  const Executor executor = Executor::with_threads(threads);
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  return gain.evaluate({map, executor}, all, poses).value();
}

std::vector<Pose> poses_about_box() {
  std::vector<Pose> poses;
  for (int i = 0; i < 40; ++i)
    poses.push_back(look_at({0.6 * std::cos(i), 0.6 * std::sin(i), 0.02 * i - 0.1}, {0.0, 0.0, 0.05}));
  return poses;
}

/// The gain by its definition: every point is tested against every disc.
double gain_disc_by_disc(const SurfelMap& surfels, const Pose& T_world_camera) {
  const Executor executor;
  const TsdfSnapshot map = half_seen_box();
  const ExpectedSurface surface = expected_surface(map, {}, executor).value();
  const std::vector<SurfelDisc> unknown = unknown_surfels(map, surfels, {}, executor).value();
  const SurfelSightConfig config;
  const std::vector<SurfelDisc> seen =
      thinned_discs(surfels, config.unknown.min_weight, config.cell_share * map.config.voxel_size_m);
  const Vector3d camera_m = T_world_camera.translation();
  const Vector3f place = camera_m.cast<float>();
  const DepthPanorama pixels{place, config.edge_px};
  const auto voxel_m = static_cast<float>(map.config.voxel_size_m);
  const auto through_m = static_cast<float>(surface.config.through_m);
  double area_cm2{0.0};
  for (const ExpectedPoint& point : surface.points) {
    const Vector3d p = T_world_camera.inverse() * point.position_m.cast<double>();
    if (p.z() < kSightSensor.min_range_m || p.z() > kSightSensor.max_range_m) continue;
    const Eigen::Vector2d pixel = kSightSensor.project(p);
    if (pixel.x() < -0.5 || pixel.x() >= kSightSensor.width - 0.5 || pixel.y() < -0.5 ||
        pixel.y() >= kSightSensor.height - 0.5)
      continue;
    if (!surface.faces(point, camera_m)) continue;
    const Vector3f towards = point.position_m - place;
    const int face = DepthPanorama::face_of(towards);
    const auto at = DepthPanorama::on_face(towards, face);
    const int x = pixels.pixel(at.x / at.z);
    const int y = pixels.pixel(at.y / at.z);
    if (at.z > test::naive_depth_m(seen, place, pixels, face, x, y) + voxel_m) continue;
    if (at.z > test::naive_depth_m(unknown, place, pixels, face, x, y) + through_m + voxel_m) continue;
    area_cm2 += static_cast<double>(point.area_cm2);
  }
  return area_cm2;
}

TEST(SurfelGain, IsTheAreaByItsDefinition) {
  SurfelMap wall;
  add_square(wall, -0.2, 0.08, 0.12);
  const std::vector<Pose> poses = poses_about_box();
  const std::vector<double> gains = gains_around(wall, poses, 2);
  std::size_t positive{0};
  for (std::size_t i = 0; i < poses.size(); i += 2) {
    EXPECT_NEAR(gains[i], gain_disc_by_disc(wall, poses[i]), 1e-6) << "pose " << i;
    positive += gains[i] > 0.0 ? 1 : 0;
  }
  EXPECT_GT(positive, 8U);
}

TEST(SurfelGain, SurfelsHideWhatVoxelsLeaveInSight) {
  const Pose pose = look_at({-0.6, 0.0, 0.05}, {0.0, 0.0, 0.05});
  SurfelMap nothing;
  SurfelMap wall;
  add_square(wall, -0.3, 0.1, 0.05);
  EXPECT_NEAR(gains_around(nothing, std::span{&pose, 1}, 1).front(), 65.0, 20.0);
  EXPECT_LT(gains_around(wall, std::span{&pose, 1}, 1).front(), 1.0);
}

TEST(SurfelGain, WhatWasSeenPromisesNothing) {
  const Pose pose = look_at({-0.6, 0.0, 0.05}, {0.0, 0.0, 0.05});
  SurfelMap back;
  add_square(back, -0.045, 0.06, 0.05);
  EXPECT_LT(gains_around(back, std::span{&pose, 1}, 1).front(), 12.0);
}

TEST(SurfelGain, TheThreadCountChangesNoBit) {
  SurfelMap wall;
  add_square(wall, -0.2, 0.08, 0.12);
  const std::vector<double> one = gains_around(wall, poses_about_box(), 1);
  EXPECT_GT(*std::max_element(one.begin(), one.end()), 50.0);
  EXPECT_EQ(gains_around(wall, poses_about_box(), 3), one);
}

TEST(SurfelGain, TheBestAreThoseOfAll) {
  SurfelMap wall;
  add_square(wall, -0.2, 0.08, 0.12);
  const TsdfSnapshot map = half_seen_box();
  const Executor executor;
  const std::vector<Pose> poses = poses_about_box();
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  SurfaceGain gain{{.sensor = kSightSensor}, surfel_sight(wall)};
  const RankedViews best = gain.best({map, executor}, all, poses, 3).value();
  std::vector<double> gains = gains_around(wall, poses, 1);
  std::sort(gains.rbegin(), gains.rend());
  ASSERT_GE(best.views.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(best.views[i].gain, gains[i], 1e-6);
}

TEST(SurfelSight, BadConfigurationsAreRefused) {
  const SurfelMap surfels;
  const Executor executor;
  for (const SurfelSightConfig& bad : {SurfelSightConfig{{-1.0, 0.5}, 160}, SurfelSightConfig{{1.0, 0.0}, 160},
                                       SurfelSightConfig{{}, 0}, SurfelSightConfig{{}, 160, 0.0}}) {
    SurfaceGain gain{{.sensor = kSightSensor}, surfel_sight(surfels, bad)};
    const Pose pose = Pose::Identity();
    const TsdfSnapshot map = half_seen_box();
    EXPECT_FALSE(gain.evaluate({map, executor}, {}, std::span{&pose, 1}));
  }
}

}  // namespace
}  // namespace saccade
