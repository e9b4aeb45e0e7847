// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/refusion.hpp"

#include <gtest/gtest.h>

#include <array>

namespace saccade {
namespace {

Pose at(double x, double y = 0.0, double yaw_rad = 0.0) {
  Pose T{Pose::Identity()};
  T.translation() = Eigen::Vector3d{x, y, 0.0};
  T.rotate(Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()});
  return T;
}

TEST(CarriedAlong, PosesBetweenTwoCorrectedOnesAreBlended) {
  const std::array tracked{at(-1.0), at(0.0), at(1.0), at(2.0), at(3.0), at(4.0)};
  const std::array<std::size_t, 2> corrected{1, 4};
  const std::array T_corrected{at(0.0), at(3.0, 0.3)};
  const std::vector<Pose> poses = carried_along(tracked, corrected, T_corrected);
  ASSERT_EQ(poses.size(), tracked.size());
  const std::array expected{0.0, 0.0, 0.1, 0.2, 0.3, 0.3};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(poses[i].translation().x(), tracked[i].translation().x(), 1e-12) << i;
    EXPECT_NEAR(poses[i].translation().y(), expected[i], 1e-12) << i;
  }
}

TEST(CarriedAlong, ATurnCarriesWhatFollows) {
  const std::array tracked{at(0.0), at(1.0)};
  const std::vector<Pose> poses =
      carried_along(tracked, std::array<std::size_t, 1>{0}, std::array{at(0.0, 0.0, 0.5 * 3.14159265358979)});
  EXPECT_NEAR((poses[1].translation() - Eigen::Vector3d{0.0, 1.0, 0.0}).norm(), 0.0, 1e-9);
}

TEST(FuseAlong, EqualsFusingTheFramesOneByOne) {
  const PinholeCamera camera{40, 30, 40.0, 40.0, 19.5, 14.5, 0.3, 4.0};
  const auto frame_of = [&](std::size_t index) {
    Frame frame;
    frame.index = index;
    frame.depth = DepthImage{camera.width, camera.height, 1.0F + 0.01F * static_cast<float>(index)};
    return frame;
  };
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.color = false;
  TsdfMap one_by_one = TsdfMap::create(config).value();
  TsdfMap along = TsdfMap::create(config).value();
  std::vector<TrackedFrame> frames;
  for (const std::size_t i : {std::size_t{2}, std::size_t{5}, std::size_t{6}}) {
    frames.push_back({i, at(0.01 * static_cast<double>(i))});
    ASSERT_TRUE(one_by_one.integrate(camera, frame_of(i).depth, frames.back().T_world_camera, {}));
  }
  ASSERT_TRUE(fuse_along(along, camera, frames, [&](std::size_t i) -> Result<Frame> { return frame_of(i); }, {}));
  EXPECT_GT(along.content().grid.usage().bricks(), 0U);
  EXPECT_TRUE(along.content().grid == one_by_one.content().grid);
  const Error gone{Errc::not_found, "gone", "frame 5"};
  const auto failed =
      fuse_along(along, camera, frames,
                 [&](std::size_t i) -> Result<Frame> { return i == 5 ? Result<Frame>{gone} : frame_of(i); }, {});
  EXPECT_EQ(failed.error().message, "gone");
}

}  // namespace
}  // namespace saccade
