// SPDX-License-Identifier: Apache-2.0
// Gains of other authors on maps written by hand, where what each ray tells can be counted.
#include "saccade/views/baseline_gains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "saccade/map/ray_walk.hpp"
#include "saccade/views/internal/ray_information.hpp"
#include "saccade/views/internal/surface_edge_gain.hpp"
#include "saccade/views/internal/volumetric_gain.hpp"
#include "saccade/views/sensor_rays.hpp"
#include "support/written_map.hpp"

namespace saccade::of_baselines {
namespace {

using Eigen::Vector3d;
using enum VolumetricInformation;

constexpr double kEdge_m{0.01};
constexpr VoxelState kUnknown{VoxelState::unknown};
constexpr VoxelState kEmpty{VoxelState::empty};
constexpr VoxelState kOccupied{VoxelState::occupied};

/// A workspace of 0.6 m × 0.6 m, from 0.1 m below the table to 0.4 m above.
TsdfSnapshot map_of(const test::StateAt& state_at) { return test::written_map(state_at); }

/// Layers along x, each as thick as a voxel, from x = 0 on; empty elsewhere.
TsdfSnapshot layers(const std::vector<VoxelState>& states) {
  return map_of([&](const Vector3d& p) {
    const auto i = static_cast<std::ptrdiff_t>(std::floor(p.x() / kEdge_m));
    return i < 0 || i >= std::ssize(states) ? kEmpty : states[static_cast<std::size_t>(i)];
  });
}

/// One ray along x.
constexpr PinholeCamera kOneRay{1, 1, 10.0, 10.0, 0.0, 0.0, 0.05, 2.0};
Pose along_x() { return look_at({-0.253, 0.003, 0.203}, {0.0, 0.003, 0.203}); }

std::vector<double> gains(Gain& gain, const TsdfSnapshot& map, const std::vector<Pose>& poses,
                          const Executor& executor = {}) {
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  return gain.evaluate({map, executor}, all, poses).value();
}
double told(VolumetricInformation information, const TsdfSnapshot& map, const PinholeCamera& sensor = kOneRay) {
  return gains(*volumetric_gain(information, {.sensor = sensor}), map, {along_x()}).front();
}

const double kBit = std::numbers::ln2;  // entropy of an unknown voxel
const double kOfOccupied = occupancy_entropy(kOccupiedOccupancy);

TEST(BaselineGains, UnobservedVoxelsCountUpToTheFirstOccupiedByTheirVisibility) {
  const TsdfSnapshot map = layers({kUnknown, kUnknown, kEmpty, kUnknown, kOccupied, kUnknown});
  EXPECT_NEAR(told(unobserved_voxel, map), kBit * (1.0 + 0.5 + 0.25), 1e-12);
}

TEST(BaselineGains, OcclusionAwareAddsWhatIsSeenOfTheOccupiedOne) {
  const TsdfSnapshot map = layers({kUnknown, kEmpty, kUnknown, kOccupied, kUnknown});
  EXPECT_NEAR(told(occlusion_aware, map), kBit * (1.0 + 0.5) + 0.25 * kOfOccupied, 1e-12);
  EXPECT_NEAR(told(occlusion_aware, layers({kOccupied, kUnknown})), kOfOccupied, 1e-12);
}

/// A rear side is met from behind: unknown, then occupied. What lies behind an occupied voxel is not visible.
TEST(BaselineGains, RearSideVoxelsLieDirectlyBeforeAnOccupiedOne) {
  EXPECT_EQ(told(rear_side_voxel, layers({kUnknown, kUnknown, kOccupied})), 1.0);
  EXPECT_EQ(told(rear_side_voxel, layers({kUnknown, kEmpty, kOccupied})), 0.0);
  EXPECT_EQ(told(rear_side_voxel, layers({kOccupied, kUnknown, kOccupied})), 0.0);
  EXPECT_EQ(told(rear_side_voxel, layers({kUnknown, kUnknown})), 0.0);
}

TEST(BaselineGains, RearSideEntropyIsThatOfTheUnknownRightBeforeTheSurface) {
  EXPECT_NEAR(told(rear_side_entropy, layers({kUnknown, kUnknown, kOccupied})), 1.5 * kBit, 1e-12);
  EXPECT_NEAR(told(rear_side_entropy, layers({kUnknown, kEmpty, kUnknown, kOccupied})), 0.5 * kBit, 1e-12);
  EXPECT_EQ(told(rear_side_entropy, layers({kUnknown, kUnknown, kEmpty, kOccupied})), 0.0);
}

TEST(BaselineGains, ProximityCountsUnknownVoxelsByTheirDistanceToSurface) {
  // Two and one voxels from the surface; the last is hidden. d_max is ten voxels.
  const TsdfSnapshot map = layers({kUnknown, kUnknown, kOccupied, kUnknown});
  EXPECT_NEAR(told(proximity_count, map), 0.8 + 0.9, 1e-6);
  EXPECT_EQ(told(proximity_count, layers({kUnknown, kUnknown})), 0.0);  // far from any
}

TEST(BaselineGains, AverageEntropyTakesRaysThatEndOnSurfaceAlone) {
  EXPECT_EQ(told(average_entropy, layers({kUnknown, kUnknown})), 0.0);
  // The surface counts as an object: voxels count up to 5 cm before it, three of them empty.
  const double voxels = 3.0 + 2.0 + 1.0;
  EXPECT_NEAR(told(average_entropy, layers({kUnknown, kUnknown, kOccupied})), (2.0 * kBit + kOfOccupied) / voxels,
              1e-12);
}

TEST(BaselineGains, TheAreaFactorIsBestForTheSharesWishedFor) {
  EXPECT_EQ(share_rating(0.0, 0.2), 0.0);
  EXPECT_NEAR(share_rating(0.2, 0.2), 1.0, 1e-12);
  EXPECT_NEAR(share_rating(0.1, 0.2), 0.5, 1e-12);
  EXPECT_NEAR(share_rating(0.6, 0.2), 0.5, 1e-12);
  EXPECT_NEAR(share_rating(1.0, 0.2), 0.0, 1e-12);
  // Five rays from left to right, the lower `occupied` of them on surface, the others on unknown space.
  const PinholeCamera five{5, 1, 25.0, 25.0, 2.0, 0.0, 0.05, 2.0};
  const auto rated = [&](double surface_until_y) {
    return told(area_factor, map_of([&](const Vector3d& p) {
                  if (p.x() < 0.0) return kEmpty;
                  return p.y() < surface_until_y ? kOccupied : kUnknown;
                }),
                five);
  };
  EXPECT_NEAR(rated(-0.013), 2.0, 1e-9);  // one of five rays
  EXPECT_NEAR(rated(0.3), 0.0, 1e-9);
  EXPECT_NEAR(rated(-0.3), 0.0, 1e-9);
  EXPECT_NEAR(rated(-0.003), share_rating(0.4, 0.2) + share_rating(0.6, 0.8), 1e-9);
}

TEST(BaselineGains, TheAreaFactorNeedsATenthOfTheRaysOrOfThoseThroughTheBox) {
  // The box of a post alone is narrow; a sill below the rays makes it wide.
  const auto post = [](bool with_sill) {
    return map_of([with_sill](const Vector3d& p) {
      if (with_sill && p.z() < 0.1 && p.x() > 0.0) return std::abs(p.y()) < 0.25 ? kOccupied : kEmpty;
      if (p.x() < 0.0 || p.y() < 0.0 || p.y() > 0.02) return kEmpty;
      return p.y() < 0.01 ? kOccupied : kUnknown;
    });
  };
  const auto rated = [](double focal_px, const TsdfSnapshot& map, const std::vector<Pose>& poses) {
    const PinholeCamera sensor{60, 1, focal_px, focal_px, 29.5, 0.0, 0.05, 2.0};
    return gains(*volumetric_gain(area_factor, {.sensor = sensor}), map, poses);
  };
  EXPECT_NEAR(rated(300.0, post(true), {along_x()}).front(), share_rating(0.5, 0.2) + share_rating(0.5, 0.8), 0.1);
  EXPECT_EQ(rated(60.0, post(true), {along_x()}).front(), 0.0);  // a handful has any shares by chance
  EXPECT_GT(rated(60.0, post(false), {along_x()}).front(), 0.5);
  // Beside a view that touches enough with all its rays, those through the box do not count.
  const Pose near = look_at({-0.06, 0.008, 0.203}, {0.0, 0.008, 0.203});
  const std::vector<double> both = rated(60.0, post(false), {along_x(), near});
  EXPECT_EQ(both.front(), 0.0);
  EXPECT_GT(both.back(), 0.5);
}

TEST(BaselineGains, TellNothingNearerThanTheRangeNorFromWithinWhatIsNotEmpty) {
  const TsdfSnapshot map = layers({kUnknown, kOccupied});
  PinholeCamera far = kOneRay;
  far.min_range_m = 0.3;
  EXPECT_GT(told(unobserved_voxel, map), 0.0);
  EXPECT_EQ(told(unobserved_voxel, map, far), 0.0);
  EXPECT_EQ(told(rear_side_voxel, map, far), 0.0);
  const auto gain = volumetric_gain(unobserved_voxel, {.sensor = kOneRay});
  EXPECT_EQ(gains(*gain, map, {look_at({0.005, 0.003, 0.203}, {0.2, 0.003, 0.203})}).front(), 0.0);
}

/// A box of 10 cm on a table; its top and its side towards +x were seen, and the table, but not behind the box.
VoxelState half_a_box(const Vector3d& p) {
  if (p.z() < 0.0) return p.z() > -0.02 ? kOccupied : kUnknown;
  const bool inside = std::abs(p.x()) < 0.05 && std::abs(p.y()) < 0.05 && p.z() < 0.1;
  if (inside) return p.z() > 0.09 || p.x() > 0.04 ? kOccupied : kUnknown;
  return p.x() < -0.05 && p.x() > -0.05 - (0.1 - p.z()) && std::abs(p.y()) < 0.05 && p.z() < 0.1 ? kUnknown : kEmpty;
}
const PinholeCamera kSensor{160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0};
Pose from_behind() { return look_at({-0.28, 0.0, 0.25}, {0.0, 0.0, 0.05}); }
Pose from_before() { return look_at({0.28, 0.0, 0.25}, {0.0, 0.0, 0.05}); }

/// Walks every voxel of every ray; no bricks, no early end.
double slow_occlusion_aware(const TsdfSnapshot& map, const BaselineScene& scene, const Pose& pose,
                            const PinholeCamera& camera) {
  const SensorRays rays = sensor_rays(pose, kEdge_m);
  double sum{0.0};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      double visible{1.0};
      const LatticeRay ray = pixel_ray(rays, camera, u, v);
      const RaySpan span{kRayStart, after_depth(static_cast<float>(camera.max_range_m))};
      walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan& in_voxel) {
        if (!scene.volume.box().contains(voxel)) return false;
        const VoxelState state =
            first_voxel(ray, in_voxel, SectorTable{map.grid}).value_or(VoxelHit{voxel, kEmpty, 0.0F}).state;
        if (state == kEmpty) return false;
        const double p = state == kUnknown ? 0.5 : kOccupiedOccupancy;
        const bool counts = scene.counts(voxel) && in_voxel.enter.t >= static_cast<float>(camera.min_range_m);
        if (counts) sum += visible * occupancy_entropy(p);
        visible *= 1.0 - p;
        return state == kOccupied;
      });
    }
  }
  return sum;
}

TEST(BaselineGains, RaysTellWhatAWalkThroughEveryVoxelTells) {
  const TsdfSnapshot map = map_of(half_a_box);
  const BaselineGainConfig config{.sensor = kSensor, .tilt_rad = 0.1, .columns_px = 16};
  const Executor executor;
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  const BaselineScene scene = read_baseline_scene({map, executor}, all, config.object_margin_m).value();
  EXPECT_LT(scene.counted.size().x, 30);  // around the box alone
  EXPECT_LT(scene.counted.count(), 0.2 * scene.volume.box().count());
  const auto gain = volumetric_gain(occlusion_aware, config);
  for (const Pose& pose : {from_behind(), from_before(), look_at({0.1, -0.2, 0.3}, {0.0, 0.0, 0.05})}) {
    const double expected = slow_occlusion_aware(map, scene, pose, sampled_camera(config));
    ASSERT_GT(expected, 1.0);
    EXPECT_NEAR(gains(*gain, map, {pose}).front(), expected, 1e-6);
  }
}

std::vector<std::shared_ptr<Gain>> all_gains(const BaselineGainConfig& config) {
  std::vector<std::shared_ptr<Gain>> all;
  for (const VolumetricInformation information : kVolumetricInformationNames.values) {
    all.push_back(volumetric_gain(information, config));
  }
  all.push_back(surface_edge_gain(config));
  all.push_back(projection_gain(config));
  return all;
}

/// Where the unknown sides are is worth more than where all was seen, by every metric but the average, which the empty
/// voxels decide, and the area factor, which shares decide.
TEST(BaselineGains, PreferTheSideThatWasNotSeen) {
  const TsdfSnapshot map = map_of(half_a_box);
  const auto all = all_gains({.sensor = kSensor});
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == static_cast<std::size_t>(average_entropy) || i == static_cast<std::size_t>(area_factor)) continue;
    const std::vector<double> two = gains(*all[i], map, {from_behind(), from_before()});
    EXPECT_GT(two[0], 1.5 * two[1]) << i;
    EXPECT_GT(two[0], 1.0) << i;
  }
}

TEST(BaselineGains, TheNumberOfThreadsChangesNoBit) {
  const TsdfSnapshot map = map_of(half_a_box);
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    poses.push_back(look_at({0.27 * std::cos(0.5 * i), 0.27 * std::sin(0.5 * i), 0.25}, {0.0, 0.0, 0.05}));
  }
  for (const std::shared_ptr<Gain>& gain : all_gains({.sensor = kSensor, .columns_px = 24})) {
    const std::vector<double> expected = gains(*gain, map, poses);
    EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.0);
    EXPECT_EQ(gains(*gain, map, poses, Executor::with_threads(3)), expected);
  }
}

/// The poses that were attempted and the best others are evaluated closely, by decreasing gain.
TEST(BaselineGains, LookCloselyAtTheBestOfManyPoses) {
  const TsdfSnapshot map = map_of(half_a_box);
  std::vector<Pose> poses;
  for (int i = 0; i < 900; ++i) {
    const double angle = 0.05 * i;
    poses.push_back(look_at({0.27 * std::cos(angle), 0.27 * std::sin(angle), 0.2 + 1e-4 * i}, {0.0, 0.0, 0.05}));
  }
  const auto gain = volumetric_gain(unobserved_voxel, {.sensor = kSensor, .columns_px = 16});
  const Executor executor;
  PlanningContext context{map, executor};
  context.attempted = [&](const Pose& pose) { return pose.matrix() == poses[0].matrix(); };
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  const RankedViews ranked = gain->best(context, all, poses, 4).value();
  EXPECT_EQ(ranked.views.size(), kFineViews + 1);
  EXPECT_EQ(ranked.evaluated, 900U);
  EXPECT_FALSE(ranked.complete);
  const std::vector<double> exact = gains(*gain, map, poses);
  const double best = *std::max_element(exact.begin(), exact.end());
  EXPECT_GT(best, 2.0 * *std::min_element(exact.begin(), exact.end()));
  EXPECT_NEAR(ranked.views.front().gain, best, 0.01 * best);
  for (std::size_t i = 1; i < ranked.views.size(); ++i) EXPECT_LE(ranked.views[i].gain, ranked.views[i - 1].gain);
  EXPECT_TRUE(std::any_of(ranked.views.begin(), ranked.views.end(),
                          [&](const RankedView& view) { return context.was_attempted(view.T_world_camera); }));
}

/// The table ends before the box does, so that cameras beside it see the unknown from lower than the table, too.
TEST(BaselineGains, SeeNothingFromBelowTheObjects) {
  const TsdfSnapshot map =
      map_of([](const Vector3d& p) { return p.z() < 0.0 && p.x() < -0.06 ? kEmpty : half_a_box(p); });
  const std::vector<Pose> poses{look_at({-0.2, 0.0, 0.15}, {0.0, 0.0, 0.05}),
                                look_at({-0.2, 0.0, -0.05}, {0.0, 0.0, 0.05})};
  const auto all = all_gains({.sensor = kSensor});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<double> two = gains(*all[i], map, poses);
    EXPECT_GT(two[0], 0.0) << i;
    EXPECT_EQ(two[1], 0.0) << i;
  }
}

TEST(BaselineGains, RefusePosesThatAreNotFinite) {
  const TsdfSnapshot map = layers({kOccupied});
  Pose bad = along_x();
  bad.translation().x() = std::nan("");
  RegionOfInterest all;
  all.bounds = *map.config.workspace;
  const Executor executor;
  const std::vector<Pose> poses{along_x(), bad};
  for (const std::shared_ptr<Gain>& gain : all_gains({.sensor = kSensor})) {
    const auto result = gain->evaluate({map, executor}, all, poses);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("pose 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace saccade::of_baselines
