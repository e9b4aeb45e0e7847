// SPDX-License-Identifier: Apache-2.0
#include "table_map.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade::bench {

const AnalyticScene& table() {
  static const AnalyticScene scene = [] {
    const auto box = [](const Eigen::Vector3d& center, const Eigen::Vector3d& half_m) {
      return Box{center - half_m, center + half_m};
    };
    AnalyticScene made;
    made.objects = {{"table", HalfSpace{}},
                    {"bin, left", box({-0.135, -0.04, 0.05}, {0.007, 0.06, 0.05})},
                    {"bin, right", box({-0.015, -0.04, 0.05}, {0.007, 0.06, 0.05})},
                    {"bin, front", box({-0.075, -0.1, 0.05}, {0.06, 0.007, 0.05})},
                    {"bin, back", box({-0.075, 0.02, 0.05}, {0.06, 0.007, 0.05})},
                    {"shelf, left", box({0.03, 0.06, 0.06}, {0.007, 0.05, 0.06})},
                    {"shelf, right", box({0.13, 0.06, 0.06}, {0.007, 0.05, 0.06})},
                    {"shelf, middle", box({0.08, 0.06, 0.06}, {0.05, 0.05, 0.007})},
                    {"shelf, top", box({0.08, 0.06, 0.12}, {0.057, 0.05, 0.007})},
                    {"ball", Sphere{{0.06, -0.08, 0.035}, 0.035}},
                    {"can", Cylinder{{-0.06, 0.1, 0.0}, {-0.06, 0.1, 0.11}, 0.03}},
                    {"tall", box({0.35, 0.1, 0.12}, {0.05, 0.08, 0.12})},
                    {"low", box({-0.2, -0.3, 0.08}, {0.1, 0.05, 0.08})},
                    {"wide", box({0.05, 0.45, 0.2}, {0.2, 0.05, 0.2})}};
    return made;
  }();
  return scene;
}

TsdfSnapshot table_map(const TableMapConfig& wanted) {
  TsdfSnapshot map;
  map.config.voxel_size_m = wanted.voxel_size_m;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(wanted.reach_m);
  if (wanted.workspace) map.config.workspace = Box{-half, half};
  const TsdfConfig& config = map.config;
  const double brick_m = kBrickEdge * config.voxel_size_m;
  const double half_diagonal_m = 0.5 * std::sqrt(3.0) * brick_m;
  const int n = static_cast<int>(std::ceil(wanted.reach_m / brick_m));
  for (int i = 0; i < 8 * n * n * n; ++i) {
    const Index3 brick{i % (2 * n) - n, i / (2 * n) % (2 * n) - n, i / (4 * n * n) - n};
    const Eigen::Vector3d center = voxel_center(brick, brick_m);
    const double distance = table().signed_distance_m(center);
    if (distance < -config.truncation_m() - half_diagonal_m) continue;
    BrickRef ref = BrickRef::constant_free(config.free_weight);
    if (distance < config.truncation_m() + half_diagonal_m) {
      DenseBrick& dense = ref.densify();
      for (int k = 0; k < kBrickVoxels; ++k) {
        const Index3 voxel = brick * kBrickEdge + child_offset(k);
        const double v = table().signed_distance_m(voxel_center(voxel, config.voxel_size_m)) / config.truncation_m();
        const auto at = static_cast<std::size_t>(k);
        dense.w[at] = v < -1.0 ? std::uint16_t{0} : std::uint16_t{5};
        dense.v[at] = static_cast<std::int16_t>(v < -1.0 ? 0.0 : std::round(std::min(v, 1.0) * kTsdfOne));
      }
      dense.update_masks();
      ref.canonicalize(config.free_weight);
    }
    Sector& sector = map.grid.writable(parent(brick));
    sector.bricks[static_cast<std::size_t>(child_index(brick))] = ref;
    sector.update_summary(child_index(brick), config.free_weight);
  }
  TsdfMap forgetting{std::move(map)};
  if (!forgetting.forget(kRegion)) return {};
  return forgetting.snapshot();
}

const std::vector<Pose>& all_poses() {
  static const std::vector<Pose> poses = poses_of(view_sphere(kPoi).value());
  return poses;
}

std::vector<Pose> every_nth_pose(std::size_t n) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < all_poses().size(); i += n) poses.push_back(all_poses()[i]);
  return poses;
}

const TsdfSnapshot& map_after(std::size_t views) {
  static const std::vector<TsdfSnapshot> maps = [] {
    const Executor executor = Executor::with_threads(0);
    const GainConfig config;
    std::vector<TsdfSnapshot> made{table_map()};
    TsdfMap map{made.back()};
    for (int view = 0; view < kMostViews; ++view) {
      const auto gains = evaluate_views(made.back(), kRegion, all_poses(), config, executor).value().gains;
      const Pose& best =
          all_poses()[static_cast<std::size_t>(std::max_element(gains.begin(), gains.end()) - gains.begin())];
      const RenderedFrame seen = render(table(), config.sensor, best, executor).value();
      SACCADE_EXPECTS(map.integrate(config.sensor, seen.depth, best, executor).ok());
      made.push_back(map.snapshot());
    }
    return made;
  }();
  return maps.at(views);
}

std::vector<TsdfSnapshot> fine_maps_after_views(int frames) {
  constexpr int kViews{6};
  std::vector<TsdfSnapshot> made{table_map({.voxel_size_m = kFineVoxel_m})};
  TsdfMap map{made.front()};
  const PinholeCamera camera;
  for (int view = 0; view < kViews; ++view) {
    const double turn_rad = view * 1.2;
    const Eigen::Vector3d target{0.3 * std::cos(turn_rad), 0.3 * std::sin(turn_rad), 0.05};
    const Eigen::Vector3d eye{0.37 * std::cos(turn_rad + 0.3), 0.37 * std::sin(turn_rad + 0.3), 0.44};
    const Pose T_world_camera = look_at(eye, target, Eigen::Vector3d::UnitZ());
    const RenderedFrame seen = render(table(), camera, T_world_camera, {}).value();
    for (int frame = 0; frame < frames; ++frame) {
      SACCADE_EXPECTS(map.integrate(camera, seen.depth, T_world_camera, {}).ok());
    }
    made.push_back(map.snapshot());
  }
  return made;
}

}  // namespace saccade::bench
