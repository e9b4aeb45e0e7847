// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/update_pictures.hpp"

#include <gtest/gtest.h>

#include "analytic_map.hpp"
#include "saccade/report/view_picture.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

/// A ball of 10 cm in a known cube of ±32 cm, and a hand that acted on either side of it.
struct BallTask {
  Box workspace{Eigen::Vector3d::Constant(-0.32), Eigen::Vector3d::Constant(0.32)};
  std::vector<Region> regions{Sphere{{-0.2, 0.0, 0.0}, 0.08}, Sphere{{0.2, 0.0, 0.0}, 0.08}};
  SyntheticTask hand{synthetic_task({{0.0, -0.5, 0.3}, {{-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}}, {}}, 1)};
  AttentionFindings findings;
  TaskPictureConfig config;

  BallTask() {
    for (const Eigen::Vector3d& p : hand.actions_m) findings.actions.push_back({p, 1.0, 1.0, {}});
    config.overview.width = 360;
    config.overview.height = 270;
    config.region_radius_m = 0.08;
  }
  [[nodiscard]] TaskScene scene() const { return {workspace, hand.trajectory, findings, regions}; }
};

TsdfMap ball_map() {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  return TsdfMap{test::map_of(config, {{-32, -32, -32}, {32, 32, 32}}, [](const Eigen::Vector3d& p) {
    return test::sphere_sdf(p, Eigen::Vector3d::Zero(), 0.1);
  })};
}

TEST(TaskPicture, ShowsTheHandAndWhereItActed) {
  const BallTask task;
  const TsdfSnapshot map = ball_map().snapshot();
  const ColorImage picture = task_picture(map, task.scene(), test::kSequential, task.config);
  EXPECT_GT(test::count(picture, poi_color()), 20U);
  EXPECT_EQ(picture.width(), 360);
  EXPECT_GT(picture.height(), 270) << "the scale of times below";
  const ColorImage idle = task_picture(map, {task.workspace, {}, {}, {}}, test::kSequential, task.config);
  EXPECT_EQ(test::count(idle, poi_color()), 0U);
  EXPECT_EQ(idle.height(), 270);
  EXPECT_EQ(picture.pixels(), task_picture(map, task.scene(), Executor::with_threads(2), task.config).pixels());
}

TEST(ForgottenPicture, IsBlackInTheRegionsAlone) {
  const BallTask task;
  TsdfMap map = ball_map();
  const auto dark = [&] {
    return test::count(forgotten_picture(map.snapshot(), task.scene(), test::kSequential, task.config),
                       test::is_unknown);
  };
  EXPECT_LT(dark(), 20U) << "nothing is forgotten, and what lies in the ball is no region's";
  ASSERT_TRUE(map.forget(task.regions[0]).ok());
  const std::size_t one = dark();
  EXPECT_GT(one, 300U);
  ASSERT_TRUE(map.forget(task.regions[1]).ok());
  const std::size_t both = dark();
  EXPECT_GT(both, one + 300);
  ASSERT_TRUE(map.forget(Region{Sphere{{0.0, 0.0, 0.25}, 0.05}}).ok());
  EXPECT_EQ(dark(), both) << "it lies in no region";
}

}  // namespace
}  // namespace saccade
