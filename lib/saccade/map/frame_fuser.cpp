// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/frame_fuser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

/// Slack of the conservative tests: far above the rounding of the per-voxel floats, far below a voxel.
constexpr double kSlackM{1e-4};
constexpr float kSlackPx{0.6F};  // rounding to the nearest pixel, and a little

constexpr int kOctants{8};

Index3 octant(const Index3& lo, int half, int i) {
  return {lo.x + ((i & 1) != 0 ? half : 0), lo.y + ((i & 2) != 0 ? half : 0), lo.z + ((i & 4) != 0 ? half : 0)};
}

/// Signs of the eight corners of a box.
using Corners = Eigen::Array<float, kOctants, 1>;
const struct {
  Corners x{-1, 1, -1, 1, -1, 1, -1, 1};
  Corners y{-1, -1, 1, 1, -1, -1, 1, 1};
  Corners z{-1, -1, -1, -1, 1, 1, 1, 1};
  /// Coordinate i of the corners of the box with that centre and, as columns, half edges.
  [[nodiscard]] Corners coordinate(const Eigen::Vector3f& center, const Eigen::Matrix3f& half, int i) const {
    return center[i] + half(i, 0) * x + half(i, 1) * y + half(i, 2) * z;
  }
} kCorners;

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
  if (!sector.saturated.all()) return false;
  const Visibility seen = visibility({sector_key * kSectorVoxelEdge, kSectorVoxelEdge});
  return seen == Visibility::all_free || seen == Visibility::free_or_unseen;
}

FrameFuser::Counts FrameFuser::fuse(const Index3& sector_key, Sector& sector) const {
  Counts counts;
  fuse_cube({sector_key * kSectorVoxelEdge, kSectorVoxelEdge}, sector, counts);
  return counts;
}

FrameFuser::Visibility FrameFuser::visibility(const Cube& cube) const {
  // Box of the voxel centres: centre and half edge; in camera coordinates, half edges.
  const double e = config_.voxel_size_m;
  const double half_m = 0.5 * (cube.edge - 1) * e;
  const Eigen::Vector3d center_world =
      e * Eigen::Vector3d{cube.lo.x + 0.5 * cube.edge, cube.lo.y + 0.5 * cube.edge, cube.lo.z + 0.5 * cube.edge};
  const Eigen::Vector3f center = (T_camera_world_ * center_world).cast<float>();
  const Eigen::Matrix3f half = (T_camera_world_.linear() * half_m).cast<float>();
  const float half_z = half.row(2).cwiseAbs().sum();
  if (center.z() + half_z < 0.0F) return Visibility::hidden;

  const Eigen::Array3d offset = (center_world - camera_world_).array().abs();
  const double nearest_m = (offset - half_m).max(0.0).matrix().norm() - kSlackM;
  if (nearest_m > ranges_.max_reach_m()) return Visibility::hidden;
  constexpr float kNearestProjected{0.02F};
  if (center.z() - half_z < kNearestProjected) return Visibility::mixed;

  const tsdf::FusionCamera& camera = ranges_.camera();
  const Corners inv_z = kCorners.coordinate(center, half, 2).inverse();
  const Corners u = camera.fx * kCorners.coordinate(center, half, 0) * inv_z + camera.cx;
  const Corners v = camera.fy * kCorners.coordinate(center, half, 1) * inv_z + camera.cy;
  const float u_min = u.minCoeff() - kSlackPx;
  const float v_min = v.minCoeff() - kSlackPx;
  const float u_max = u.maxCoeff() + kSlackPx;
  const float v_max = v.maxCoeff() + kSlackPx;
  const auto last_u = static_cast<float>(camera.width - 1);
  const auto last_v = static_cast<float>(camera.height - 1);
  if (u_max < 0.0F || v_max < 0.0F || u_min > last_u || v_min > last_v) return Visibility::hidden;
  const bool inside = u_min >= 0.0F && v_min >= 0.0F && u_max <= last_u && v_max <= last_v;
  const PixelRect rect{static_cast<int>(std::max(u_min, 0.0F)), static_cast<int>(std::max(v_min, 0.0F)),
                       static_cast<int>(std::ceil(std::min(u_max, last_u))),
                       static_cast<int>(std::ceil(std::min(v_max, last_v)))};
  const BeamBounds seen = ranges_.bounds(rect);
  if (nearest_m > seen.reach_m) return Visibility::hidden;
  const double farthest_m = (offset + half_m).matrix().norm() + kSlackM;
  if (farthest_m >= seen.clear_m) return inside ? Visibility::mixed_inside : Visibility::mixed;
  return inside && seen.nearest_m > 0.0F ? Visibility::all_free : Visibility::free_or_unseen;
}

void FrameFuser::fuse_cube(const Cube& cube, Sector& sector, Counts& counts) const {
  const Visibility seen = visibility(cube);
  if (seen == Visibility::hidden) return;
  if (seen == Visibility::all_free) return observe_free(cube, sector, counts);
  if (cube.edge > kBrickEdge) {
    for (int i = 0; i < kOctants; ++i) {
      fuse_cube({octant(cube.lo, cube.edge / 2, i), cube.edge / 2}, sector, counts);
    }
    return;
  }
  const Index3 brick = parent(cube.lo);
  const int i = child_index(brick);
  if (seen == Visibility::free_or_unseen && sector.saturated.test(i)) {
    ++counts.bricks_free;
    ++counts.bricks_saturated;
  } else if (fuse_brick(brick, seen == Visibility::mixed_inside, sector.bricks[static_cast<std::size_t>(i)])) {
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
        fusion::update_brick(samples, Mask512::all_set(), config_.max_weight, config_.free_weight,
                             ref.writable_dense());
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

bool FrameFuser::fuse_brick(const Index3& brick, bool inside, BrickRef& ref) const {
  fusion::BrickSamples observed;
  fusion::sample_brick(ranges_.camera(), brick_frame(brick), ranges_.ranges(), inside, observed);
  if (observed.seen.none()) return false;
  if (observed.surface.none() && ref.kind() != BrickKind::dense) {
    ref.expand_to_free().observe(observed.seen, config_.free_weight);
  } else {
    DenseBrick& dense = ref.densify();
    if (color_ != nullptr && config_.color) update_colors(observed, dense);
    fusion::update_brick(observed.samples, observed.seen, config_.max_weight, config_.free_weight, dense);
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
