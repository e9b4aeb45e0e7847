// SPDX-License-Identifier: Apache-2.0
// The surface ray cast against the analytic scene that was fused, and to the bit against a walk through every cell.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saccade/core/simd.hpp"
#include "saccade/map/internal/cell.hpp"
#include "saccade/map/ray_walk.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/sensor/analytic_scene.hpp"

namespace saccade {
namespace {

constexpr double kVoxelM{0.008};

PinholeCamera small_camera() { return {157, 117, 131.25, 131.25, 80.0, 60.0, 0.2, 3.0}; }

TsdfSnapshot fused_tabletop(const PinholeCamera& camera, std::size_t views) {
  TsdfConfig config;
  config.voxel_size_m = kVoxelM;
  auto map = TsdfMap::create(config);
  EXPECT_TRUE(map.ok());
  const AnalyticScene scene = sample_tabletop();
  for (const Pose& T_world_camera : sample_trajectory(views)) {
    const auto frame = render(scene, camera, T_world_camera);
    EXPECT_TRUE(frame.ok());
    EXPECT_TRUE(map->integrate(camera, frame->depth, T_world_camera, Executor{}, &frame->color).ok());
  }
  return map->snapshot();
}

std::optional<Cell> cell_by_hash(const TsdfGrid& grid, const Index3& index) {
  Cell cell;
  for (int i = 0; i < 8; ++i) {
    const Voxel voxel = grid.voxel(index + Index3{i & 1, (i >> 1) & 1, (i >> 2) & 1});
    if (voxel.w == 0) return std::nullopt;
    cell.v[static_cast<std::size_t>(i)] = static_cast<float>(voxel.v);
  }
  return cell;
}

/// Differences of the interpolated v over two voxels; over the cell's own where a neighbour is unknown.
Eigen::Vector3f gradient_slowly(const TsdfGrid& grid, const CellHit& hit) {
  const Cell cell = cell_by_hash(grid, hit.cell).value();
  const auto at = [](const Cell& c, const std::array<float, 3>& f) { return c.at(f[0], f[1], f[2]); };
  Eigen::Vector3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Index3 step{axis == 0, axis == 1, axis == 2};
    const auto ahead = cell_by_hash(grid, hit.cell + step);
    const auto behind = cell_by_hash(grid, hit.cell - step);
    std::array<float, 3> low = hit.fraction;
    std::array<float, 3> high = hit.fraction;
    low[static_cast<std::size_t>(axis)] = 0.0F;
    high[static_cast<std::size_t>(axis)] = 1.0F;
    gradient[axis] = ahead && behind ? 0.5F * (at(*ahead, hit.fraction) - at(*behind, hit.fraction))
                                     : at(cell, high) - at(cell, low);
  }
  return gradient;
}

struct SlowHit {
  float depth{0.0F};
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
};

/// One ray by walking every cell from the camera to the maximum range.
SlowHit cast_slowly(const TsdfSnapshot& map, const PinholeCamera& camera, const Pose& T_world_camera, int u, int v) {
  const double e = map.config.voxel_size_m;
  const Eigen::Vector3d origin = T_world_camera.translation() / e - Eigen::Vector3d::Constant(0.5);
  const Eigen::Matrix3d per_cell = T_world_camera.linear() / e;
  const Eigen::Vector3d in_camera = camera.ray(u, v);
  const auto along = [&](int axis) {
    return static_cast<float>((per_cell(axis, 0) * in_camera.x() + per_cell(axis, 1) * in_camera.y()) +
                              per_cell(axis, 2));
  };
  const LatticeRay ray =
      make_lattice_ray(lattice_point(origin.x(), origin.y(), origin.z()), along(0), along(1), along(2));
  const RaySpan span{kRayStart, after_depth(static_cast<float>(camera.max_range_m))};
  SlowHit result;
  walk_cells<kVoxelLevel>(ray, span, [&](const Index3& index, const RaySpan& in_cell) {
    const std::optional<Cell> cell = cell_by_hash(map.grid, index);
    if (!cell) return false;
    CellHit hit;
    const CellCrossing crossing = cross_cell(ray, index, *cell, in_cell, hit);
    if (crossing == CellCrossing::front && hit.t >= static_cast<float>(camera.min_range_m)) {
      const Eigen::Vector3f gradient = gradient_slowly(map.grid, hit);
      const Eigen::Matrix3f R_camera_world = T_world_camera.linear().transpose().cast<float>();
      if (gradient.norm() > 0.0F) result = {hit.t, R_camera_world * gradient / gradient.norm()};
    }
    return crossing != CellCrossing::none;
  });
  return result;
}

TEST(Raycast, EqualsTheWalkThroughEveryCellToTheBit) {
  const PinholeCamera camera = small_camera();
  TsdfSnapshot map = fused_tabletop(camera, 6);
  std::size_t compared{0};
  std::size_t hits{0};
  std::vector<Pose> views = sample_trajectory(3);
  views.push_back(look_at({0.1, 0.0, 0.12}, {0.0, 0.2, 0.05}));  // between the objects
  views.push_back(look_at({0.3, -0.9, -0.4}, {0.0, 0.0, 0.0}));  // from below: surfaces from behind
  const Pose straight = [] {  // along the lattice: rays that never cross the planes of an axis
    Pose T = Pose::Identity();
    T.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    T.translation() << 4 * kVoxelM, 8 * kVoxelM, 100 * kVoxelM;
    return T;
  }();
  views.push_back(straight);
  for (const Pose& T_world_camera : views) {
    std::vector<SurfaceView> casts;
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(use_simd_target(target).ok());
      auto view = raycast(map, camera, T_world_camera, Executor::with_threads(2));
      ASSERT_TRUE(view.ok());
      casts.push_back(std::move(*view));
    }
    ASSERT_TRUE(use_simd_target("").ok());
    for (int v = 0; v < camera.height; v += 3) {
      for (int u = 0; u < camera.width; u += 3) {
        const SlowHit expected = cast_slowly(map, camera, T_world_camera, u, v);
        for (const SurfaceView& view : casts) {
          ASSERT_EQ(view.depth(u, v), expected.depth) << "pixel " << u << ", " << v;
          ASSERT_EQ(view.normals(u, v), expected.normal) << "pixel " << u << ", " << v;
        }
        ++compared;
        hits += expected.depth > 0.0F ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(compared, 6U * 39U * 53U);
  EXPECT_GT(hits, compared / 3);
}

TEST(Raycast, SeesTheSceneThatWasFused) {
  const PinholeCamera camera = small_camera();
  const TsdfSnapshot map = fused_tabletop(camera, 24);
  const Pose T_world_camera = sample_trajectory(24)[11];
  const auto view = raycast(map, camera, T_world_camera, Executor::with_threads(2), {.colors = true});
  ASSERT_TRUE(view.ok());
  const auto truth = render(sample_tabletop(), camera, T_world_camera);
  ASSERT_TRUE(truth.ok());
  std::vector<double> errors;
  std::vector<double> angles;
  std::size_t visible{0};
  std::size_t colored{0};
  const AnalyticScene scene = sample_tabletop();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (truth->depth(u, v) <= 0.0F) continue;
      ++visible;
      if (view->depth(u, v) <= 0.0F) continue;
      errors.push_back(std::abs(view->depth(u, v) - truth->depth(u, v)));
      const auto hit = scene.cast(T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v));
      ASSERT_TRUE(hit.has_value());
      const Eigen::Vector3d normal = T_world_camera.linear() * view->normals(u, v).cast<double>();
      angles.push_back(std::acos(std::clamp(normal.dot(hit->normal_world), -1.0, 1.0)));
      colored += view->colors(u, v) != Rgb8{128, 128, 128} ? 1 : 0;
    }
  }
  ASSERT_GT(visible, 10000U);
  EXPECT_GT(static_cast<double>(errors.size()) / static_cast<double>(visible), 0.97);
  std::sort(errors.begin(), errors.end());
  std::sort(angles.begin(), angles.end());
  EXPECT_LT(errors[errors.size() / 2], 0.1 * kVoxelM);
  EXPECT_LT(errors[errors.size() * 9 / 10], kVoxelM);
  EXPECT_LT(angles[angles.size() / 2], 0.05);
  EXPECT_GT(colored, errors.size() * 9 / 10);
}

TEST(Raycast, ThreadsNeverChangeABit) {
  const PinholeCamera camera = small_camera();
  const TsdfSnapshot map = fused_tabletop(camera, 4);
  const Pose T_world_camera = sample_trajectory(9)[4];
  const auto one = raycast(map, camera, T_world_camera, Executor{}, {.colors = true});
  const auto seven = raycast(map, camera, T_world_camera, Executor::with_threads(7), {.colors = true});
  ASSERT_TRUE(one.ok() && seven.ok());
  EXPECT_EQ(one->depth, seven->depth);
  EXPECT_EQ(one->colors, seven->colors);
  EXPECT_TRUE(std::equal(one->normals.pixels().begin(), one->normals.pixels().end(), seven->normals.pixels().begin()));
  EXPECT_GT(std::count_if(one->depth.pixels().begin(), one->depth.pixels().end(), [](float d) { return d > 0.0F; }),
            5000);
}

TEST(Raycast, AnEmptyMapShowsNothing) {
  auto map = TsdfMap::create({});
  ASSERT_TRUE(map.ok());
  const auto view = raycast(map->content(), small_camera(), Pose::Identity(), Executor{});
  ASSERT_TRUE(view.ok());
  EXPECT_TRUE(std::all_of(view->depth.pixels().begin(), view->depth.pixels().end(), [](float d) { return d == 0.0F; }));
}

}  // namespace
}  // namespace saccade
