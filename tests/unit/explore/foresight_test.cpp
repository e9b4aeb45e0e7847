// SPDX-License-Identifier: Apache-2.0
// Order of views that are weighed by later views, by their time, and by what is seen during the motion.
#include "saccade/explore/foresight.hpp"

#include <gtest/gtest.h>

#include "saccade/map/tsdf_map.hpp"

namespace saccade {
namespace {

Pose at(double x) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x;
  return pose;
}

/// Takes as many seconds to a view as its x, and comes by the pose (0, 1, 0) on its way to those beyond 5.
class SlowRobot final : public Robot {
 public:
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, MotionKind /*way*/) override {
    const double x = T_world_camera.front().translation().x();
    if (x == unreachable_x) return PlannedMotion{{}, Refusal::no_path, "no way"};
    Motion motion{0, T_world_camera.front(), {}};
    const Configuration rest = Configuration::Zero(1);
    motion.trajectory = Trajectory{{{x, rest, rest, rest}}};
    return PlannedMotion{motion, {}, ""};
  }
  [[nodiscard]] std::vector<MotionSample> camera_on_way(const Motion& motion, double every_s) const override {
    if (motion.T_world_camera.translation().x() <= 5.0) return {};
    return {{every_s, on_way()}};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& /*motion*/,
                                                       const MotionObserver& /*on_way*/) override {
    return std::optional<Arrival>{};
  }
  static Pose on_way() {
    Pose pose = Pose::Identity();
    pose.translation().y() = 1.0;
    return pose;
  }
  double unreachable_x{-1.0};
};

/// Views at x = 1, 2, … that promise these voxels, each worth 1.
class Foresighted : public ::testing::Test {
 protected:
  Foresighted() : map_{*TsdfMap::create(TsdfConfig{})}, scene_{map_.content(), executor_} {}

  Ranking ranking(const std::vector<std::vector<int>>& voxels, const std::vector<int>& on_way = {}) {
    const auto promise_of = [](const std::vector<int>& shown) {
      Promise promise;
      for (const int voxel : shown) promise.voxels.push_back({{voxel, 0, 0}, 1.0});
      return promise;
    };
    RankedViews ranked;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      ranked.views.push_back({at(static_cast<double>(i + 1)), static_cast<double>(voxels[i].size())});
    }
    order_by_gain(ranked.views);
    ranked.promise = [=](const Pose& pose) {
      if (pose.translation().y() > 0.0) return promise_of(on_way);
      return promise_of(voxels[static_cast<std::size_t>(pose.translation().x()) - 1]);
    };
    Ranking ranking;
    ranking.add(RegionOfInterest{}, ViewCandidates{}, RefusalCounts{}, std::move(ranked), scene_);
    ranking.end(scene_);
    return ranking;
  }

  /// The x of the views, in their order after looking ahead.
  std::vector<double> order(const Foresight& foresight, Ranking ranking) {
    EXPECT_TRUE(look_ahead(foresight, robot_, executor_, ranking).ok());
    std::vector<double> order;
    for (const RankedView& view : ranking.untried()) order.push_back(view.T_world_camera.translation().x());
    EXPECT_EQ(ranking.as_good_as_best(0.01).size() == 1, foresight.is_needed());
    return order;
  }

  Executor executor_;
  TsdfMap map_;
  PlanningScene scene_;
  SlowRobot robot_;
};

TEST_F(Foresighted, WithoutItTheOrderIsThatOfGains) {
  EXPECT_EQ(order({}, ranking({{1}, {2, 3, 4}, {5, 6}})), (std::vector<double>{2, 3, 1}));
}

TEST_F(Foresighted, ViewsThatShowMoreTogetherComeBeforeTheBestAlone) {
  const std::vector<std::vector<int>> views{{1, 2, 3, 4, 5, 6}, {1, 2, 3, 7, 8}, {4, 5, 6, 9, 10}};
  EXPECT_EQ(order({.lookahead = 2}, ranking(views)), (std::vector<double>{3, 2, 1})) << "5 + 10 is more than 6 + 8";
}

TEST_F(Foresighted, ViewsOfASetThatCannotBeReachedStayWhereTheyWere) {
  const std::vector<std::vector<int>> views{{1, 2, 3, 4, 5, 6}, {1, 2, 3, 7, 8}, {4, 5, 6, 9, 10}};
  robot_.unreachable_x = 2.0;
  EXPECT_EQ(order({.lookahead = 2}, ranking(views)), (std::vector<double>{3, 1, 2}));
}

TEST_F(Foresighted, GainForTimePrefersWhatIsNear) {
  // 3 within 1 + 1 s is more than 9 within 9 + 1 s.
  std::vector<std::vector<int>> views(9);
  views[0] = {1, 2, 3};
  views[8] = {11, 12, 13, 14, 15, 16, 17, 18, 19};
  const Foresight for_time{.objective = Objective::surface_per_second};
  EXPECT_EQ(order(for_time, ranking(views)).front(), 1.0);
  EXPECT_EQ(order({}, ranking(views)).front(), 9.0);
}

TEST_F(Foresighted, FramesOnTheWayCount) {
  std::vector<std::vector<int>> views(6);
  views[0] = {1, 2, 3};
  views[5] = {4, 5};
  const Foresight on_way{.frame_on_way_s = 0.5};
  EXPECT_EQ(order(on_way, ranking(views, {})).front(), 1.0);
  EXPECT_EQ(order(on_way, ranking(views, {5, 6})).front(), 1.0);  // as much, of which the better view comes first
  EXPECT_EQ(order(on_way, ranking(views, {5, 6, 7})).front(), 6.0);
}

}  // namespace
}  // namespace saccade
