// SPDX-License-Identifier: Apache-2.0
// Faces by which rays come to voxels that score, and the pixels that see them.
#include "saccade/views/internal/footprint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "saccade/views/internal/cast_window.hpp"
#include "support/brute_force_gain.hpp"

namespace saccade {
namespace {

constexpr double kFaceVoxel_m{0.02};
const PinholeCamera kFootprintCamera{64, 48, 40.0, 45.0, 31.5, 23.5, 0.0, 2.0};

using Face = std::tuple<int, bool, int, int, int>;  // axis, forward, the voxel that is entered

/// Free space with unknown voxels and blocks in it, and a wall of known ones.
TsdfSnapshot spotted_map(std::uint32_t seed) {
  std::mt19937 random{seed};
  TsdfConfig config;
  config.voxel_size_m = kFaceVoxel_m;
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.free(Box{Eigen::Vector3d::Constant(-1.3), Eigen::Vector3d::Constant(1.3)}).ok());
  std::uniform_real_distribution<double> at{-0.45, 0.45};
  std::uniform_real_distribution<double> edge{0.01, 0.25};
  for (int i = 0; i < 14; ++i) {
    const Eigen::Vector3d lo{at(random), at(random), at(random)};
    EXPECT_TRUE(map.forget(Box{lo, lo + Eigen::Vector3d{edge(random), edge(random), edge(random)}}).ok());
  }
  return map.snapshot();
}

StopGrid grid_of(const TsdfSnapshot& map, const Region& region) {
  return StopGrid::build(map, region, UnknownOutside::blocks, {{-70, -70, -70}, {70, 70, 70}}, true, {}).value();
}

std::set<Face> naive_faces(const StopGrid& grid) {
  std::set<Face> faces;
  const IndexBox& box = grid.scoring_voxels();
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const Index3 voxel{x, y, z};
        const StopGrid::Brick brick = grid.brick(parent(voxel));
        const bool scores = brick.masks != nullptr && !stop_flags::uniform(brick.flags)
                                ? brick.masks->score.test(child_index(voxel))
                                : brick.flags == stop_flags::kAllScore;
        if (!scores) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (const bool forward : {false, true}) {
            const int back = forward ? -1 : 1;
            const Index3 from{x + (axis == 0 ? back : 0), y + (axis == 1 ? back : 0), z + (axis == 2 ? back : 0)};
            if (!grid.stops(from)) faces.emplace(axis, forward, x, y, z);
          }
        }
      }
    }
  }
  return faces;
}

TEST(EntryFaces, AreEachFaceBetweenAVoxelThatScoresAndOneThatStopsNothingOnce) {
  const TsdfSnapshot map = spotted_map(5);
  const StopGrid grid = grid_of(map, Box{{-0.4, -0.4, -0.4}, {0.5, 0.5, 0.5}});
  const std::set<Face> expected = naive_faces(grid);
  ASSERT_GT(expected.size(), 2000U);
  for (const std::size_t threads : {1U, 4U}) {
    const EntryFaces faces{grid, Executor::with_threads(threads)};
    std::set<Face> found;
    int larger{0};
    for (const FaceGroup& group : faces.groups()) {
      ASSERT_EQ((group.end - group.begin) % EntryFaces::kLanes, 0U);
      for (std::size_t i = group.begin; i < group.end; ++i) {
        const int edge = static_cast<int>(faces.edges_vox()[i]);
        larger += edge > 1 ? 1 : 0;
        for (int k = 0; k < edge * edge; ++k) {
          std::array<int, 3> at{faces.corners(0)[i], faces.corners(1)[i], faces.corners(2)[i]};
          const auto axis = static_cast<std::size_t>(group.axis);
          EXPECT_TRUE(at[0] >= group.lo.x && at[1] >= group.lo.y && at[2] >= group.lo.z);
          at[axis] -= group.forward ? 0 : 1;
          at[axis == 0 ? 1 : 0] += k % edge;
          at[axis == 2 ? 1 : 2] += k / edge;
          found.emplace(group.axis, group.forward, at[0], at[1], at[2]);
        }
      }
    }
    EXPECT_EQ(found, expected);
    EXPECT_GT(larger, 100);
  }
}

/// Cameras among the unknown voxels and around them: also those that faces come very close to.
std::vector<Pose> footprint_poses() {
  std::mt19937 random{8};
  std::uniform_real_distribution<double> at{-1.0, 1.0};
  std::vector<Pose> poses;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d from = Eigen::Vector3d{at(random), at(random), at(random)} * (i % 2 == 0 ? 0.5 : 1.2);
    const Eigen::Vector3d to = 0.3 * Eigen::Vector3d{at(random), at(random), at(random)};
    poses.push_back(look_at(from, to, Eigen::Vector3d::UnitZ(), 2.0 * i));
  }
  return poses;
}

TEST(Footprint, HoldsEveryPixelThatScoresAndFewOthers) {
  const TsdfSnapshot map = spotted_map(6);
  const Region region{Box{{-0.4, -0.4, -0.4}, {0.5, 0.5, 0.5}}};
  const StopGrid grid = grid_of(map, region);
  const EntryFaces faces{grid, {}};
  GainConfig config;
  config.sensor = kFootprintCamera;
  const test::BruteForceGain brute_force{map, region, config};
  std::size_t scoring{0};
  std::size_t shown{0};
  std::size_t pixels{0};
  for (const Pose& pose : footprint_poses()) {
    const SensorRays rays = sensor_rays(pose, kFaceVoxel_m);
    if (grid.stops(rays.origin.voxel)) continue;
    const PixelAxes axes = pixel_axes(kFootprintCamera, rays.quarter_turns);
    const CastWindow window = whole_image(rays, axes);
    Footprint footprint;
    footprint.draw(faces, rays, window.grid(), kFaceVoxel_m, 0.0F, 2.0F);
    std::uint64_t set{0};
    for (int row = 0; row < static_cast<int>(axes.b.size()); ++row) {
      for (int column = 0; column < static_cast<int>(axes.a.size()); ++column) {
        const LatticeRay ray =
            rays.ray(axes.a[static_cast<std::size_t>(column)], axes.b[static_cast<std::size_t>(row)]);
        const bool scores = brute_force.scores(ray);
        set += footprint.test(column, row) ? 1 : 0;
        scoring += scores ? 1 : 0;
        ASSERT_TRUE(!scores || footprint.test(column, row)) << "column " << column << ", row " << row;
      }
    }
    const auto columns = static_cast<int>(axes.a.size());
    const auto rows = static_cast<int>(axes.b.size());
    ASSERT_EQ(footprint.count({0, columns, 0, rows}), set);
    EXPECT_EQ(footprint.count({0, columns, 0, 9}) + footprint.count({0, 13, 9, rows}) +
                  footprint.count({13, columns, 9, rows}),
              set);
    shown += set;
    pixels += axes.a.size() * axes.b.size();
  }
  EXPECT_GT(scoring, 10000U);
  EXPECT_LT(shown, 2 * scoring);
  EXPECT_LT(shown, pixels * 2 / 3);
}

/// From the middle of the free voxel beside an unknown block, towards it: all rays score.
TEST(Footprint, ShowsWhatTheCameraTouches) {
  TsdfConfig config;
  config.voxel_size_m = kFaceVoxel_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      SCOPED_TRACE("axis " + std::to_string(axis) + ", " + (side > 0.0 ? "from above" : "from below"));
      const auto along = static_cast<Eigen::Index>(axis);
      const Box block{Eigen::Vector3d::Constant(-0.2), Eigen::Vector3d::Constant(0.2)};
      TsdfMap map = TsdfMap::create(config).value();
      ASSERT_TRUE(map.free(Box{Eigen::Vector3d::Constant(-1.3), Eigen::Vector3d::Constant(1.3)}).ok());
      ASSERT_TRUE(map.forget(block).ok());
      Eigen::Vector3d from = Eigen::Vector3d::Constant(0.01);
      from[along] = side * 0.21;
      Eigen::Vector3d to = from;
      to[along] = 0.0;
      const StopGrid grid = grid_of(map.snapshot(), block);
      const Eigen::Vector3d up = axis == 2 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
      const SensorRays rays = sensor_rays(look_at(from, to, up, 0.0), kFaceVoxel_m);
      ASSERT_FALSE(grid.stops(rays.origin.voxel));
      const PixelGrid pixels = whole_image(rays, pixel_axes(kFootprintCamera, rays.quarter_turns)).grid();
      Footprint footprint;
      footprint.draw(EntryFaces{grid, {}}, rays, pixels, kFaceVoxel_m, 0.0F, 2.0F);
      const auto all = static_cast<std::uint64_t>(pixels.columns) * static_cast<std::uint64_t>(pixels.rows);
      EXPECT_EQ(footprint.count({0, pixels.columns, 0, pixels.rows}), all);
    }
  }
}

TEST(Footprint, DoesNotShowWhatIsNearerThanTheSensorMeasuresOrFarther) {
  const TsdfSnapshot map = spotted_map(7);
  const StopGrid grid = grid_of(map, Box{{-0.4, -0.4, -0.4}, {0.5, 0.5, 0.5}});
  const EntryFaces faces{grid, {}};
  const SensorRays rays =
      sensor_rays(look_at({-1.2, 0.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ(), 0.0), kFaceVoxel_m);
  const PixelAxes axes = pixel_axes(kFootprintCamera, rays.quarter_turns);
  const PixelGrid pixels = whole_image(rays, axes).grid();
  const auto count = [&](float min_t, float max_t) {
    Footprint footprint;
    footprint.draw(faces, rays, pixels, kFaceVoxel_m, min_t, max_t);
    return footprint.count({0, pixels.columns, 0, pixels.rows});
  };
  EXPECT_GT(count(0.0F, 2.0F), 200U);
  EXPECT_EQ(count(0.0F, 0.7F), 0U);
  EXPECT_EQ(count(1.95F, 2.0F), 0U);
  EXPECT_LT(count(0.0F, 1.1F), count(0.0F, 2.0F));
}

TEST(Footprint, IsEmptyWithoutFacesAndWithoutPixels) {
  Footprint footprint;
  footprint.draw(EntryFaces{}, sensor_rays(Pose::Identity(), kFaceVoxel_m), {0.0, 0.0, 10.0, 10.0, 20, 10},
                 kFaceVoxel_m, 0.0F, 2.0F);
  EXPECT_EQ(footprint.count({0, 20, 0, 10}), 0U);
  footprint.draw(EntryFaces{}, sensor_rays(Pose::Identity(), kFaceVoxel_m), {}, kFaceVoxel_m, 0.0F, 2.0F);
  EXPECT_EQ(footprint.count({0, 0, 0, 0}), 0U);
}

}  // namespace
}  // namespace saccade
