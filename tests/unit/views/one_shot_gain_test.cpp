// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/one_shot_gain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "saccade/views/fixed_views.hpp"

namespace saccade {
namespace {

/// Promises of views by their height: sets of voxels along x, each worth 1. Counts how often it is asked.
class PromisingGain final : public Gain {
 public:
  explicit PromisingGain(std::map<int, std::vector<int>> shown) : shown_{std::move(shown)} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& /*context*/,
                                                     const RegionOfInterest& /*region*/,
                                                     std::span<const Pose> T_world_camera) override {
    std::vector<double> gains;
    for (const Pose& pose : T_world_camera) gains.push_back(promised(pose).worth());
    return gains;
  }
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t /*count*/) override {
    ++asked;
    SACCADE_TRY(const std::vector<double> gains, evaluate(context, region, T_world_camera));
    RankedViews ranked;
    for (std::size_t i = 0; i < gains.size(); ++i) ranked.views.push_back({T_world_camera[i], gains[i]});
    order_by_gain(ranked.views);
    ranked.promise = [this](const Pose& pose) { return promised(pose); };
    return ranked;
  }
  int asked{0};

 private:
  [[nodiscard]] Promise promised(const Pose& pose) const {
    Promise promise;
    for (const int x : shown_.at(static_cast<int>(std::lround(pose.translation().z())))) {
      promise.voxels.push_back({{x, 0, 0}, 1.0});
    }
    return promise;
  }
  std::map<int, std::vector<int>> shown_;
};

std::vector<int> heights_of(const RankedViews& ranked) {
  std::vector<int> heights;
  for (const RankedView& view : ranked.views) {
    heights.push_back(static_cast<int>(std::lround(view.T_world_camera.translation().z())));
  }
  return heights;
}

struct Planned {
  std::vector<Pose> poses;
  TsdfSnapshot map{};
  Executor executor{};
  std::vector<int> tried{};

  explicit Planned(int views) {
    for (int i = 0; i < views; ++i) {
      poses.emplace_back(Pose::Identity());
      poses.back().translation().z() = i;
    }
  }
  Result<RankedViews> ask(Gain& gain) {
    PlanningContext context{map, executor};
    context.attempted = [this](const Pose& pose) {
      return std::count(tried.begin(), tried.end(), static_cast<int>(std::lround(pose.translation().z()))) > 0;
    };
    return gain.best(context, {}, poses, 1);
  }
};

TEST(OneShotGain, CoversWhatIsPromisedAndNeverPlansAgain) {
  // View 1 shows most; view 2 shows much of the same, so view 3 comes before it, and view 2 adds a single voxel.
  const auto inner = std::make_shared<PromisingGain>(
      std::map<int, std::vector<int>>{{0, {0}}, {1, {0, 1, 2, 3, 4}}, {2, {1, 2, 3, 9}}, {3, {6, 7}}});
  OneShotGain gain{inner, {.max_views = 3}};
  Planned scene{4};
  const auto plan = scene.ask(gain);
  ASSERT_TRUE(plan);
  EXPECT_EQ(heights_of(*plan), (std::vector<int>{1, 3, 2}));  // view 0 adds nothing
  EXPECT_FALSE(plan->by_gain);
  EXPECT_EQ(plan->views[0].gain, 5.0);
  EXPECT_EQ(plan->views[1].gain, 2.0);
  EXPECT_EQ(plan->views[2].gain, 1.0);
  scene.tried = {1};
  EXPECT_EQ(heights_of(*scene.ask(gain)), (std::vector<int>{3, 2}));
  scene.tried = {1, 3, 2};
  EXPECT_TRUE(scene.ask(gain)->views.empty());
  EXPECT_EQ(inner->asked, 1);
}

TEST(OneShotGain, OnceLittleIsAddedTheFarthestViewsFollow) {
  std::map<int, std::vector<int>> shown{{3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}, {4, {10, 11}}, {8, {12}}};
  for (const int promises_nothing : {0, 1, 2, 5, 6, 7}) shown[promises_nothing] = {};
  Planned scene{9};
  OneShotGain gain{std::make_shared<PromisingGain>(shown), {.max_views = 5, .least_share = 0.2, .min_addition = 0.5}};
  const auto plan = scene.ask(gain);
  ASSERT_TRUE(plan);
  // Views 3 and 4 by what they add; view 8 adds too little, but is as far as they come, then view 0. Views 1, 2 and 6
  // are near, and the last is the farthest of the rest.
  EXPECT_EQ(heights_of(*plan), (std::vector<int>{3, 4, 8, 0, 6}));
  EXPECT_EQ(plan->views[1].gain, 2.0);
  EXPECT_EQ(plan->views[2].gain, 0.5);

  Planned tried{9};
  tried.tried = {8};  // a view that was taken counts as one of the plan
  OneShotGain after{std::make_shared<PromisingGain>(shown), {.max_views = 3, .least_share = 0.2}};
  EXPECT_EQ(heights_of(*tried.ask(after)), (std::vector<int>{3, 4, 0}));

  const std::map<int, std::vector<int>> nothing{{0, {}}, {1, {}}};
  OneShotGain empty{std::make_shared<PromisingGain>(nothing), {.max_views = 2}};
  Planned two{2};
  EXPECT_TRUE(two.ask(empty)->views.empty()) << "there is nothing to explore";
}

TEST(OneShotGain, EndsAfterItsViews) {
  const std::map<int, std::vector<int>> shown{{0, {0, 1, 2}}, {1, {3, 4}}, {2, {5}}};
  Planned scene{3};
  OneShotGain two{std::make_shared<PromisingGain>(shown), {.max_views = 2}};
  EXPECT_EQ(heights_of(*scene.ask(two)), (std::vector<int>{0, 1}));
  OneShotGain more{std::make_shared<PromisingGain>(shown), {.max_views = 8, .min_addition = 2.0}};
  EXPECT_EQ(heights_of(*scene.ask(more)), (std::vector<int>{0, 1, 2})) << "there are no others";
}

TEST(FixedViews, AreTheSameWhateverTheMap) {
  const auto views = std::make_shared<const std::vector<Pose>>(hemisphere_views({0.1, 0.2, 0.3}, 0.5, 7));
  FixedViews generator{views};
  const TsdfSnapshot map;
  const Executor executor;
  const auto found = generator.views({map, executor}, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->T_world_camera.size(), 7U);
  EXPECT_EQ(found->in_all, 7U);
  EXPECT_EQ(found->T_world_camera[3].matrix(), (*views)[3].matrix());
}

TEST(ShellViews, DependOnTheirSeedAndRefuseWhatHasNoRoom) {
  const auto first = shell_views({0.0, 0.0, 0.0}, {.count = 50});
  const auto again = shell_views({0.0, 0.0, 0.0}, {.count = 50});
  const auto other = shell_views({0.0, 0.0, 0.0}, {.count = 50, .seed = 2});
  ASSERT_TRUE(first && again && other);
  EXPECT_EQ((*first)[49].matrix(), (*again)[49].matrix());
  EXPECT_NE((*first)[49].matrix(), (*other)[49].matrix());
  for (const ShellViewsConfig& bad : {ShellViewsConfig{.inner_half_edge_m = 0.0}, ShellViewsConfig{.count = 0},
                                      ShellViewsConfig{.inner_half_edge_m = 0.4, .outer_radius_m = 0.4}}) {
    EXPECT_EQ(shell_views({0.0, 0.0, 0.0}, bad).error().code, Errc::invalid_argument);
  }
}

}  // namespace
}  // namespace saccade
