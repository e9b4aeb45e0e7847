// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/frame_fuser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

/// Slack of the conservative tests: far above the rounding of the per-voxel floats, far below a voxel.
constexpr double kSlackM{1e-4};
constexpr double kSlackPx{0.6};  // rounding to the nearest pixel, and a little

constexpr int kOctants{8};

Index3 octant(const Index3& lo, int half, int i) {
  return {lo.x + ((i & 1) != 0 ? half : 0), lo.y + ((i & 2) != 0 ? half : 0), lo.z + ((i & 4) != 0 ? half : 0)};
}

tsdf::Float3 to_float3(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// Calls body(brick index in the sector) for the bricks of a cube within it.
template <class Body>
void for_each_brick(const Index3& first_brick, int edge_bricks, const Body& body) {
  for (int z = 0; z < edge_bricks; ++z) {
    for (int y = 0; y < edge_bricks; ++y) {
      for (int x = 0; x < edge_bricks; ++x) body(child_index(first_brick + Index3{x, y, z}));
    }
  }
}

}  // namespace

FrameFuser::FrameFuser(const TsdfConfig& config, const RangeImage& ranges, const Pose& T_world_camera,
                       const ColorImage* color)
    : config_{config},
      ranges_{ranges},
      color_{color},
      T_camera_world_{T_world_camera.inverse()},
      camera_world_{T_world_camera.translation()} {}

std::vector<Index3> FrameFuser::candidate_sectors(const Executor& executor) const {
  const double reach_m = ranges_.max_reach_m();
  if (reach_m <= 0.0) return {};
  // Box around the camera and the corners of its image at the farthest reach.
  const tsdf::FusionCamera& camera = ranges_.camera();
  const Pose T_world_camera = T_camera_world_.inverse();
  Eigen::Vector3d lo = camera_world_;
  Eigen::Vector3d hi = camera_world_;
  for (const double u : {-0.5, camera.width - 0.5}) {
    for (const double v : {-0.5, camera.height - 0.5}) {
      const Eigen::Vector3d ray{(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
      const Eigen::Vector3d corner = T_world_camera * Eigen::Vector3d{ray * reach_m};
      lo = lo.cwiseMin(corner);
      hi = hi.cwiseMax(corner);
    }
  }
  const double sector_m = kSectorVoxelEdge * config_.voxel_size_m;
  const Index3 first = voxel_at(lo - Eigen::Vector3d::Constant(kSlackM), sector_m);
  const Index3 last = voxel_at(hi + Eigen::Vector3d::Constant(kSlackM), sector_m);
  std::vector<Index3> keys;
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) keys.push_back({x, y, z});
    }
  }
  std::vector<std::uint8_t> visible(keys.size());
  executor.parallel_for(keys.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      visible[i] = visibility({keys[i] * kSectorVoxelEdge, kSectorVoxelEdge}) != Visibility::hidden ? 1 : 0;
    }
  });
  std::size_t kept{0};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (visible[i] != 0) keys[kept++] = keys[i];
  }
  keys.resize(kept);
  return keys;
}

bool FrameFuser::leaves_unchanged(const Index3& sector_key, const Sector& sector) const {
  return sector.saturated.all() &&
         visibility({sector_key * kSectorVoxelEdge, kSectorVoxelEdge}) == Visibility::all_free;
}

FrameFuser::Counts FrameFuser::fuse(const Index3& sector_key, Sector& sector) const {
  Counts counts;
  fuse_cube({sector_key * kSectorVoxelEdge, kSectorVoxelEdge}, sector, counts);
  return counts;
}

FrameFuser::Visibility FrameFuser::visibility(const Cube& cube) const {
  // Box of the voxel centres, in camera coordinates: centre and half edges.
  const double e = config_.voxel_size_m;
  const double half_m = 0.5 * (cube.edge - 1) * e;
  const Eigen::Vector3d center_world{(cube.lo.x + 0.5 * cube.edge) * e, (cube.lo.y + 0.5 * cube.edge) * e,
                                     (cube.lo.z + 0.5 * cube.edge) * e};
  const Eigen::Vector3d center = T_camera_world_ * center_world;
  const Eigen::Matrix3d half = T_camera_world_.linear() * half_m;
  const double half_z = half.row(2).cwiseAbs().sum();
  if (center.z() + half_z < 0.0) return Visibility::hidden;

  const double nearest_m = std::max(0.0, (center_world - camera_world_).norm() - half_m * std::sqrt(3.0)) - kSlackM;
  if (nearest_m > ranges_.max_reach_m()) return Visibility::hidden;
  constexpr double kNearestProjected{0.02};
  if (center.z() - half_z < kNearestProjected) return Visibility::mixed;

  const tsdf::FusionCamera& camera = ranges_.camera();
  double u_min{1e30};
  double u_max{-1e30};
  double v_min{1e30};
  double v_max{-1e30};
  double farthest_squared{0.0};
  for (int i = 0; i < kOctants; ++i) {
    const Eigen::Vector3d sign{(i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0};
    const Eigen::Vector3d corner = center + half * sign;
    const double inv_z = 1.0 / corner.z();
    const double u = camera.fx * corner.x() * inv_z + camera.cx;
    const double v = camera.fy * corner.y() * inv_z + camera.cy;
    u_min = std::min(u_min, u);
    u_max = std::max(u_max, u);
    v_min = std::min(v_min, v);
    v_max = std::max(v_max, v);
    farthest_squared = std::max(farthest_squared, corner.squaredNorm());
  }
  u_min -= kSlackPx;
  v_min -= kSlackPx;
  u_max += kSlackPx;
  v_max += kSlackPx;
  const double last_u = camera.width - 1;
  const double last_v = camera.height - 1;
  if (u_max < 0.0 || v_max < 0.0 || u_min > last_u || v_min > last_v) return Visibility::hidden;
  const bool inside = u_min >= 0.0 && v_min >= 0.0 && u_max <= last_u && v_max <= last_v;
  const PixelRect rect{static_cast<int>(std::max(u_min, 0.0)), static_cast<int>(std::max(v_min, 0.0)),
                       static_cast<int>(std::ceil(std::min(u_max, last_u))),
                       static_cast<int>(std::ceil(std::min(v_max, last_v)))};
  const BeamBounds seen = ranges_.bounds(rect);
  if (nearest_m > seen.reach_m) return Visibility::hidden;
  const double farthest_m = std::sqrt(farthest_squared) + kSlackM;
  return inside && farthest_m < seen.clear_m ? Visibility::all_free : Visibility::mixed;
}

void FrameFuser::fuse_cube(const Cube& cube, Sector& sector, Counts& counts) const {
  switch (visibility(cube)) {
    case Visibility::hidden: return;
    case Visibility::all_free: observe_free(cube, sector, counts); return;
    case Visibility::mixed: break;
  }
  if (cube.edge > kBrickEdge) {
    for (int i = 0; i < kOctants; ++i) {
      fuse_cube({octant(cube.lo, cube.edge / 2, i), cube.edge / 2}, sector, counts);
    }
    return;
  }
  const Index3 brick = parent(cube.lo);
  const int i = child_index(brick);
  if (fuse_brick(brick, sector.bricks[static_cast<std::size_t>(i)])) {
    sector.update_summary(i, config_.free_weight);
    ++counts.bricks_updated;
  }
}

void FrameFuser::observe_free(const Cube& cube, Sector& sector, Counts& counts) const {
  for_each_brick(parent(cube.lo), cube.edge / kBrickEdge, [&](int i) {
    ++counts.bricks_free;
    if (sector.saturated.test(i)) {
      ++counts.bricks_saturated;
      return;
    }
    BrickRef& ref = sector.bricks[static_cast<std::size_t>(i)];
    switch (ref.kind()) {
      case BrickKind::unknown: ref = BrickRef::constant_free(1); break;
      case BrickKind::constant_free:
        ref = BrickRef::constant_free(
            std::min<std::uint16_t>(static_cast<std::uint16_t>(ref.constant_weight() + 1), config_.free_weight));
        break;
      case BrickKind::free:
        ref.writable_free().observe(Mask512::all_set(), config_.free_weight);
        ref.canonicalize(config_.free_weight);
        break;
      case BrickKind::dense: {
        alignas(fusion::kVectorBytes) std::array<std::int16_t, kBrickVoxels> samples;
        samples.fill(tsdf::kSampleOne);
        fusion::update_brick(samples, config_.max_weight, config_.free_weight, ref.writable_dense());
        ref.canonicalize(config_.free_weight);
        break;
      }
    }
    sector.update_summary(i, config_.free_weight);
  });
}

tsdf::BrickFrame FrameFuser::brick_frame(const Index3& brick) const {
  const double e = config_.voxel_size_m;
  const Eigen::Matrix3d step = T_camera_world_.linear() * e;
  return {to_float3(T_camera_world_ * voxel_center(brick * kBrickEdge, e)), to_float3(step.col(0)),
          to_float3(step.col(1)), to_float3(step.col(2))};
}

bool FrameFuser::fuse_brick(const Index3& brick, BrickRef& ref) const {
  fusion::BrickSamples observed;
  fusion::sample_brick(ranges_.camera(), brick_frame(brick), ranges_.ranges(), observed);
  if (observed.seen.none()) return false;
  if (observed.surface.none() && ref.kind() != BrickKind::dense) {
    ref.expand_to_free().observe(observed.seen, config_.free_weight);
  } else {
    DenseBrick& dense = ref.densify();
    if (color_ != nullptr && config_.color) update_colors(observed, dense);
    fusion::update_brick(observed.samples, config_.max_weight, config_.free_weight, dense);
  }
  ref.canonicalize(config_.free_weight);
  return true;
}

/// Colours of the voxels within the truncation band; before the weights change, since they average over the old ones.
void FrameFuser::update_colors(const fusion::BrickSamples& observed, DenseBrick& dense) const {
  if (dense.colors == nullptr) dense.colors = std::make_unique<BrickColors>();
  observed.surface.for_each([&](std::size_t i) {
    if (observed.samples[i] <= -tsdf::kSampleOne) return;
    const Rgb8& seen = color_->pixels()[static_cast<std::size_t>(observed.pixels[i])];
    Rgb8& color = (*dense.colors)[i];
    const std::uint16_t w = color == Rgb8{} ? std::uint16_t{0} : dense.w[i];  // black: no colour yet
    for (std::size_t c = 0; c < 3; ++c) color[c] = tsdf::average_color(color[c], w, seen[c]);
    if (color == Rgb8{}) color = {1, 1, 1};
  });
}

}  // namespace saccade
