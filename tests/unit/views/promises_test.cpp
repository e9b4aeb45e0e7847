// SPDX-License-Identifier: Apache-2.0
// Which promises of views are believed: not those of a table's underside, of space without a surface behind it, behind
// the robot's own body, or of what an earlier view of the same place failed to show.
#include "saccade/views/promise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "saccade/views/surface_gain.hpp"
#include "support/half_seen_box.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

const PinholeCamera kSensor{160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 2.0};

/// The best views of a map among some, by either gain.
struct Choice {
  TsdfSnapshot map;
  Executor executor{};
  std::vector<CheckedView> checked{};
  std::function<Result<OwnBody>(const PinholeCamera&)> own_body{};

  [[nodiscard]] PlanningContext context() const {
    PlanningContext context{map, executor};
    context.sensor = kSensor;
    context.checked = checked;
    context.own_body = own_body;
    return context;
  }
  [[nodiscard]] RegionOfInterest region() const {
    RegionOfInterest all;
    all.bounds = *map.config.workspace;
    return all;
  }
  [[nodiscard]] RankedViews best(Gain&& gain, std::span<const Pose> poses) const {
    return gain.best(context(), region(), poses, 16).value();
  }
  [[nodiscard]] double rays_from(const Vector3d& camera_m, Trust trust = Trust::credible,
                                 const Vector3d& target_m = {0.0, 0.0, 0.05}) const {
    const Pose pose = look_at(camera_m, target_m);
    return best(RayGain{{.sensor = kSensor}, trust}, std::span{&pose, 1}).views.front().gain;
  }
  [[nodiscard]] double surface_from(const Vector3d& camera_m) const {
    const Pose pose = look_at(camera_m, {0.0, 0.0, 0.05});
    return best(SurfaceGain{{.sensor = kSensor}}, std::span{&pose, 1}).views.front().gain;
  }
};

std::vector<Pose> poses_around() {
  std::vector<Pose> poses;
  for (int i = 0; i < 150; ++i) {
    const double turn = 0.37 * i;
    const Vector3d camera_m{0.6 * std::cos(turn), 0.6 * std::sin(turn), -0.1 + 0.005 * i};
    for (int roll = 0; roll < 2; ++roll) {
      poses.push_back(look_at(camera_m, {0.0, 0.0, 0.05}, Vector3d::UnitZ(), roll * std::numbers::pi / 2.0));
    }
  }
  return poses;
}

TEST(Promises, AreKeptByVoxelsThatAreKnown) {
  const TsdfSnapshot map = test::half_seen_box();
  Promise promise;
  promise.voxels.push_back({Index3{0, 0, 5}, 3.0});   // unknown
  promise.voxels.push_back({Index3{20, 0, 5}, 1.0});  // empty
  EXPECT_DOUBLE_EQ(promise.worth(), 4.0);
  EXPECT_DOUBLE_EQ(promise.kept_share(map.grid), 0.25);
}

TEST(Promises, OfATablesUndersideAreNotBelieved) {
  const Choice choice{test::half_seen_box()};
  EXPECT_GT(choice.rays_from({0.1, 0.0, -0.6}, Trust::blind), 1000.0) << "the table's inside is unknown";
  EXPECT_EQ(choice.rays_from({0.1, 0.0, -0.6}), 0.0);
  EXPECT_GT(choice.rays_from({-0.6, 0.0, 0.3}), 100.0) << "the side of the box that was not seen";
}

TEST(Promises, OfSpaceWithoutASurfaceBehindItAreNotBelieved) {
  const auto with_corner = [](bool wall) {
    return Choice{test::written_map([=](const Vector3d& p) {
      if (wall && p.y() > 0.28) return VoxelState::occupied;
      return p.y() > 0.15 && p.z() > 0.15 ? VoxelState::unknown : test::half_seen_box_at(p);
    })};
  };
  const Vector3d camera_m{0.0, -0.6, 0.3};
  const Vector3d corner_m{0.0, 0.3, 0.3};
  EXPECT_GT(with_corner(false).rays_from(camera_m, Trust::blind, corner_m), 1000.0);
  EXPECT_LT(with_corner(false).rays_from(camera_m, Trust::credible, corner_m), 300.0)
      << "rays that rise go on for ever";
  EXPECT_GT(with_corner(true).rays_from(camera_m, Trust::credible, corner_m), 1000.0);
}

TEST(Promises, BehindTheRobotsOwnBodyAreNotBelieved) {
  Choice choice{test::half_seen_box()};
  const double rays = choice.rays_from({-0.6, 0.0, 0.3});
  const double area_cm2 = choice.surface_from({-0.6, 0.0, 0.3});
  const auto body_at = [](float depth_m) {
    return [depth_m](const PinholeCamera& sensor) -> Result<OwnBody> {
      DepthImage depth{sensor.width, sensor.height};
      std::fill(depth.data(), depth.data() + static_cast<std::ptrdiff_t>(sensor.width) * sensor.height, depth_m);
      return OwnBody{[depth](const Pose&) { return std::optional{depth}; }};
    };
  };
  choice.own_body = body_at(0.2F);
  EXPECT_EQ(choice.rays_from({-0.6, 0.0, 0.3}), 0.0);
  EXPECT_EQ(choice.surface_from({-0.6, 0.0, 0.3}), 0.0);
  choice.own_body = body_at(1.5F);
  EXPECT_EQ(choice.rays_from({-0.6, 0.0, 0.3}), rays) << "the body is behind the box";
  EXPECT_EQ(choice.surface_from({-0.6, 0.0, 0.3}), area_cm2);
}

TEST(Promises, ThatWereBrokenLoseCreditFromThereAboveAll) {
  Choice choice{test::half_seen_box()};
  const Vector3d failed_m{-0.6, 0.0, 0.2};
  const Vector3d beside_m{-0.58, 0.1, 0.22};
  const Vector3d aside_m{0.0, 0.6, 0.2};
  const double rays = choice.rays_from(beside_m);
  const double area_cm2 = choice.surface_from(beside_m);
  const double aside_cm2 = choice.surface_from(aside_m);
  choice.checked = {{look_at(failed_m, {0.0, 0.0, 0.05}), 0.1}};
  EXPECT_LT(choice.rays_from(beside_m), 0.3 * rays);
  EXPECT_LT(choice.surface_from(beside_m), 0.3 * area_cm2);
  EXPECT_LE(choice.surface_from(aside_m), aside_cm2);
  EXPECT_GE(choice.surface_from(aside_m), 0.55 * aside_cm2) << "from elsewhere half of what it missed is taken off";
  choice.checked = {{look_at(failed_m, {0.0, 0.0, 0.05}), 0.95}};
  EXPECT_EQ(choice.surface_from(beside_m), area_cm2) << "it was kept";
}

TEST(Promises, OfAPoseThatIsNoneAreAnError) {
  const Choice choice{test::half_seen_box()};
  std::vector<Pose> poses = poses_around();
  poses[3].translation().x() = std::nan("");
  RayGain rays{{.sensor = kSensor}};
  EXPECT_FALSE(rays.best(choice.context(), choice.region(), poses, poses.size()));
  SurfaceGain surface{{.sensor = kSensor}};
  EXPECT_FALSE(surface.best(choice.context(), choice.region(), poses, 16));
  poses[3].translation().x() = 1e300;
  EXPECT_TRUE(surface.best(choice.context(), choice.region(), poses, 16)) << "far away, nothing is seen";
}

TEST(Promises, InAWorkspaceTooLargeToLookThroughAreBelieved) {
  Choice choice{test::half_seen_box()};
  RegionOfInterest near_box;
  near_box.bounds = Box{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.2}};
  choice.map.config.workspace = Box{{-10.0, -10.0, -0.1}, {10.0, 10.0, 10.0}};
  RayGain gain{{.sensor = kSensor}};
  const Pose pose = look_at({-0.28, 0.0, 0.3}, {0.0, 0.0, 0.05});
  const auto best = gain.best(choice.context(), near_box, std::span{&pose, 1}, 16);
  ASSERT_TRUE(best) << best.error().to_string();
  EXPECT_GT(best->views.front().gain, 0.0);
  EXPECT_FALSE(best->promise) << "nothing can be checked";
}

/// Those of the whole workspace are the reference: there no ray is passed over.
TEST(Promises, OfASmallRegionAreThoseOfAllThatLieInIt) {
  const Choice choice{test::half_seen_box()};
  const std::array<Region, 3> regions{Sphere{{-0.03, 0.01, 0.05}, 0.04}, Box{{-0.05, -0.05, 0.0}, {0.0, 0.05, 0.1}},
                                      Cylinder{{0.0, 0.0, 0.0}, {-0.05, 0.0, 0.08}, 0.03}};
  const auto promised = [&](const Region& bounds, const Pose& pose) {
    RegionOfInterest region;
    region.bounds = bounds;
    RayGain gain{{.sensor = kSensor}, Trust::blind};
    std::vector<Index3> voxels;
    const Promise promise = gain.best(choice.context(), region, std::span{&pose, 1}, 1).value().promise(pose);
    for (const PromisedVoxel& voxel : promise.voxels) voxels.push_back(voxel.voxel);
    return voxels;
  };
  std::size_t compared = 0;
  for (const Pose& pose : poses_around()) {
    const std::vector<Index3> all = promised(*choice.map.config.workspace, pose);
    for (const Region& region : regions) {
      std::vector<Index3> inside = all;
      std::erase_if(inside, [&](const Index3& voxel) { return !contains(region, voxel_center(voxel, 0.01)); });
      EXPECT_EQ(promised(region, pose), inside);
      compared += inside.size();
    }
  }
  EXPECT_GT(compared, 1000U);
}

TEST(Promises, AddUpToTheGain) {
  const Choice choice{test::half_seen_box()};
  const std::vector<Pose> poses = poses_around();
  const RankedViews ranked = choice.best(SurfaceGain{{.sensor = kSensor}}, poses);
  ASSERT_FALSE(ranked.views.empty());
  for (const RankedView& view : ranked.views) {
    EXPECT_NEAR(ranked.promise(view.T_world_camera).worth(), view.gain, 1e-9 + 1e-6 * view.gain);
  }
  EXPECT_NEAR(ranked.least_gain, 0.005 * 200.0, 0.3);
}

/// Lines of sight of every pose are the slow reference of those of the best alone.
TEST(SurfaceGain, TheBestByBoundsAreTheBestOfAll) {
  Choice choice{test::half_seen_box()};
  const std::vector<Pose> poses = poses_around();
  choice.checked = {{look_at({-0.6, 0.0, 0.2}, {0.0, 0.0, 0.05}), 0.3}};
  SurfaceGain gain{{.sensor = kSensor}};
  std::vector<double> all = gain.evaluate(choice.context(), choice.region(), poses).value();
  std::sort(all.begin(), all.end(), std::greater<>{});
  ASSERT_GT(all[0], 50.0);
  for (const std::size_t threads : {1U, 3U}) {
    choice.executor = Executor::with_threads(threads);
    const RankedViews ranked = gain.best(choice.context(), choice.region(), poses, 8).value();
    ASSERT_GE(ranked.views.size(), 8U);
    EXPECT_LT(ranked.views.size(), poses.size()) << "bounds spare most of the poses";
    EXPECT_FALSE(ranked.complete);
    for (std::size_t i = 0; i < ranked.views.size(); ++i) EXPECT_NEAR(ranked.views[i].gain, all[i], 1e-9);
  }
}

TEST(SurfaceGain, ThoseThatWereAttemptedTakeNoOthersPlace) {
  const Choice choice{test::half_seen_box()};
  const std::vector<Pose> poses = poses_around();
  for (const bool one_roll : {false, true}) {
    SurfaceGain gain{{.sensor = kSensor, .one_roll = one_roll}};
    PlanningContext context = choice.context();
    const RankedViews before = gain.best(context, choice.region(), poses, 8).value();
    // As if an arm had found no way to any of them.
    context.attempted = [&](const Pose& pose) {
      return std::any_of(before.views.begin(), before.views.end(),
                         [&](const RankedView& view) { return view.T_world_camera.matrix() == pose.matrix(); });
    };
    const RankedViews after = gain.best(context, choice.region(), poses, 8).value();
    std::size_t untried = 0;
    for (const RankedView& view : after.views) untried += context.was_attempted(view.T_world_camera) ? 0 : 1;
    EXPECT_GE(untried, 8U);
    EXPECT_GE(after.views.size(), untried + before.views.size()) << "attempted ones are told too";
    EXPECT_TRUE(std::is_sorted(after.views.begin(), after.views.end(),
                               [](const RankedView& a, const RankedView& b) { return a.gain > b.gain; }));
  }
}

}  // namespace
}  // namespace saccade
