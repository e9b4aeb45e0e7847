// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/frame_fuser.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "saccade/map/internal/frustum_box.hpp"

namespace saccade {
namespace {

Index3 octant(const Index3& lo, int half, int i) {
  return {lo.x + ((i & 1) != 0 ? half : 0), lo.y + ((i & 2) != 0 ? half : 0), lo.z + ((i & 4) != 0 ? half : 0)};
}

tsdf::Float3 to_float3(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

FrameFuser::FrameFuser(const TsdfConfig& config, const RangeImage& ranges, const Pose& T_world_camera,
                       const ColorImage* color)
    : config_{config},
      ranges_{ranges},
      color_{color},
      T_camera_world_{T_world_camera.inverse()},
      camera_world_{T_world_camera.translation()} {
  for (int axis = 0; axis < 3; ++axis) {
    steps_[static_cast<std::size_t>(axis)] = to_float3(T_camera_world_.linear().col(axis) * config.voxel_size_m);
  }
}

Result<std::vector<Index3>> FrameFuser::candidate_sectors(const Executor& executor) const {
  const double reach_m = ranges_.max_reach_m();
  if (reach_m <= 0.0) return std::vector<Index3>{};
  SACCADE_TRY(const IndexBox sectors,
              sectors_in_frustum(ranges_.camera(), T_camera_world_.inverse(), reach_m, config_.voxel_size_m));
  std::vector<Index3> keys;
  sectors.for_each([&](const Index3& key) { keys.push_back(key); });
  std::vector<std::uint8_t> visible(keys.size());
  executor.parallel_for(keys.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      visible[i] = known_octants({keys[i] * kSectorVoxelEdge, kSectorVoxelEdge}).hidden != fusion::kAllOctants ? 1 : 0;
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
  const fusion::KnownOctants known = known_octants({sector_key * kSectorVoxelEdge, kSectorVoxelEdge});
  return (known.hidden | known.free_or_unseen) == fusion::kAllOctants;
}

FrameFuser::Counts FrameFuser::fuse(const Index3& sector_key, Sector& sector) const {
  Counts counts;
  fuse_cube({sector_key * kSectorVoxelEdge, kSectorVoxelEdge}, sector, counts);
  return counts;
}

fusion::KnownOctants FrameFuser::known_octants(const Cube& cube) const {
  fusion::OctantViews views;
  fusion::view_octants(ranges_.camera(), frame_at(cube.lo), cube.edge, views);
  // Masks rather than branches, which could not be predicted.
  unsigned beyond{0};        // farther than anything seen in its beams
  unsigned beyond_image{0};  // farther than anything seen at all
  unsigned in_front{0};      // nearer than any surface in its beams
  unsigned all_returned{0};
  for (unsigned i = 0; i < fusion::kOctants; ++i) {
    const BeamBounds seen = ranges_.bounds({views.u0[i], views.v0[i], views.u1[i], views.v1[i]});
    beyond |= static_cast<unsigned>(views.nearest_m[i] > seen.reach_m) << i;
    beyond_image |= static_cast<unsigned>(views.nearest_m[i] > ranges_.max_reach_m()) << i;
    in_front |= static_cast<unsigned>(views.farthest_m[i] < seen.clear_m) << i;
    all_returned |= static_cast<unsigned>(seen.nearest_m > 0.0F) << i;
  }
  const unsigned projected = ~unsigned{views.near};
  const unsigned hidden = views.hidden | beyond_image | (beyond & projected);
  const unsigned free_or_unseen = in_front & projected & ~hidden;
  const unsigned free = free_or_unseen & views.inside & all_returned;
  return {static_cast<fusion::OctantMask>(hidden), static_cast<fusion::OctantMask>(free),
          static_cast<fusion::OctantMask>(free_or_unseen), views.inside};
}

void FrameFuser::fuse_cube(const Cube& cube, Sector& sector, Counts& counts) const {
  const int edge = cube.edge / 2;
  const fusion::KnownOctants known = known_octants(cube);
  for (unsigned rest = ~unsigned{known.hidden} & fusion::kAllOctants; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const auto is = [i](fusion::OctantMask mask) { return ((mask >> i) & 1) != 0; };
    const Cube part{octant(cube.lo, edge, i), edge};
    if (is(known.free)) {
      observe_free(part, sector, counts);
    } else if (edge > kBrickEdge) {
      fuse_cube(part, sector, counts);
    } else if (is(known.free_or_unseen) && sector.saturated.test(child_index(parent(part.lo)))) {
      ++counts.bricks_free;
      ++counts.bricks_saturated;
    } else {
      fuse_brick(parent(part.lo), is(known.inside), sector, counts);
    }
  }
}

void FrameFuser::fuse_brick(const Index3& brick, bool inside, Sector& sector, Counts& counts) const {
  const Cube cube{brick * kBrickEdge, kBrickEdge};
  const fusion::KnownOctants known = known_octants(cube);
  if (known.hidden == fusion::kAllOctants) return;
  if (known.free == fusion::kAllOctants) return observe_free(cube, sector, counts);
  const int i = child_index(brick);
  fusion::BrickSamples observed;
  fusion::sample_brick(ranges_.camera(), frame_at(cube.lo), ranges_.ranges(), inside, known, observed);
  if (observe(observed, sector.bricks[static_cast<std::size_t>(i)])) {
    sector.update_summary(i, config_.free_weight);
    ++counts.bricks_updated;
  }
}

void FrameFuser::observe_free(const Cube& cube, Sector& sector, Counts& counts) const {
  IndexBox::cube(parent(cube.lo), cube.edge / kBrickEdge).for_each([&](const Index3& brick) {
    const int i = child_index(brick);
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
                             config_.clearing_share(), ref.writable_dense());
        ref.canonicalize(config_.free_weight);
        break;
      }
    }
    sector.update_summary(i, config_.free_weight);
  });
}

tsdf::BrickFrame FrameFuser::frame_at(const Index3& voxel) const {
  return {to_float3(T_camera_world_ * voxel_center(voxel, config_.voxel_size_m)), steps_[0], steps_[1], steps_[2]};
}

bool FrameFuser::observe(const fusion::BrickSamples& observed, BrickRef& ref) const {
  if (observed.seen.none()) return false;
  if (observed.surface.none() && ref.kind() != BrickKind::dense) {
    ref.expand_to_free().observe(observed.seen, config_.free_weight);
  } else {
    DenseBrick& dense = ref.densify();
    if (color_ != nullptr && config_.color) update_colors(observed, dense);
    fusion::update_brick(observed.samples, observed.seen, config_.max_weight, config_.free_weight,
                         config_.clearing_share(), dense);
  }
  ref.canonicalize(config_.free_weight);
  return true;
}

/// Updates colours within the truncation band. Runs before the weights change, since colours average over the old ones.
void FrameFuser::update_colors(const fusion::BrickSamples& observed, DenseBrick& dense) const {
  if (dense.colors == nullptr) dense.colors = std::make_unique<BrickColors>();
  observed.surface.for_each([&](std::size_t i) {
    if (observed.samples[i] <= -tsdf::kSampleOne) return;
    const Rgb8& seen = color_->pixels()[static_cast<std::size_t>(observed.pixels[i])];
    Rgb8& color = (*dense.colors)[i];
    const std::uint16_t w = color == Rgb8{} ? std::uint16_t{0} : dense.w[i];  // black means no colour yet
    for (std::size_t c = 0; c < 3; ++c) color[c] = tsdf::average_color(color[c], w, seen[c]);
    if (color == Rgb8{}) color = {1, 1, 1};
  });
}

}  // namespace saccade
