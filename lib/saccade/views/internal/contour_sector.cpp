// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/contour_sector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kFirstColumn{0x0101010101010101ULL};
constexpr std::uint64_t kLastColumn{kFirstColumn << 7};

/// Sets every bit and its neighbours along an axis; `before` and `after` are the adjacent masks.
Mask512 spread_x(const Mask512& before, const Mask512& mask, const Mask512& after) {
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    const std::uint64_t word = mask.words[z];
    out.words[z] = word | ((word << 1) & ~kFirstColumn) | ((word >> 1) & ~kLastColumn) |
                   ((before.words[z] >> 7) & kFirstColumn) | ((after.words[z] << 7) & kLastColumn);
  }
  return out;
}
Mask512 spread_y(const Mask512& before, const Mask512& mask, const Mask512& after) {
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    const std::uint64_t word = mask.words[z];
    out.words[z] = word | (word << 8) | (word >> 8) | (before.words[z] >> 56) | (after.words[z] << 56);
  }
  return out;
}
Mask512 spread_z(const Mask512& before, const Mask512& mask, const Mask512& after) {
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    out.words[z] =
        mask.words[z] | (z > 0 ? mask.words[z - 1] : before.words[7]) | (z < 7 ? mask.words[z + 1] : after.words[0]);
  }
  return out;
}

/// Sets every bit and its 6-neighbours. mask_at({x, y, z}) returns the surrounding masks.
template <class MaskAt>
Mask512 spread_to_6(const MaskAt& mask_at) {
  const Mask512& mask = mask_at(Index3{});
  return spread_x(mask_at({-1, 0, 0}), mask, mask_at({1, 0, 0})) |
         spread_y(mask_at({0, -1, 0}), mask, mask_at({0, 1, 0})) |
         spread_z(mask_at({0, 0, -1}), mask, mask_at({0, 0, 1}));
}

/// Sets every bit and its 18-neighbours: those within one step along each of any two axes.
template <class MaskAt>
Mask512 spread_to_18(const MaskAt& mask_at) {
  const auto along_x = [&](int y, int z) {
    return spread_x(mask_at({-1, y, z}), mask_at({0, y, z}), mask_at({1, y, z}));
  };
  const auto along_z = [&](int y) { return spread_z(mask_at({0, y, -1}), mask_at({0, y, 0}), mask_at({0, y, 1})); };
  const Mask512 x = along_x(0, 0);
  return spread_y(along_x(-1, 0), x, along_x(1, 0)) | spread_z(along_x(0, -1), x, along_x(0, 1)) |
         spread_y(along_z(-1), along_z(0), along_z(1));
}

/// Returns the number of a step among the 3³ around, z slowest.
std::size_t number_of(const Index3& step) {
  return static_cast<std::size_t>(((step.z + 1) * 3 + step.y + 1) * 3 + step.x + 1);
}

const Mask512 kNone;

}  // namespace

ContourSector::ContourSector(const TsdfSnapshot& map, const SectorTable& table, std::uint16_t known_weight)
    : table_{&table}, known_weight_{known_weight}, free_weight_{map.config.free_weight}, masks_(kBricks) {
  if (map.config.workspace) workspace_ = voxels_with_center_in(*map.config.workspace, map.config.voxel_size_m);
}

void ContourSector::enter(const Index3& sector) {
  sector_ = sector;
  made_.reset();
  for (int i = 0; i < 27; ++i) {
    around_[static_cast<std::size_t>(i)] = table_->find(sector + Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
  }
}

const BrickRef& ContourSector::brick(const Index3& local) const {
  static const BrickRef kUnknown;
  const Sector* sector = around_[number_of(parent(local))];
  return sector == nullptr ? kUnknown : sector->bricks[static_cast<std::size_t>(child_index(local))];
}

const ContourSector::Masks& ContourSector::masks(const Index3& local) {
  const auto at = static_cast<std::size_t>(((local.z + 1) * kEdge + local.y + 1) * kEdge + local.x + 1);
  Masks& masks = masks_[at];
  if (made_.test(at)) return masks;
  made_.set(at);
  const BrickRef& ref = brick(local);
  const auto least = static_cast<std::uint16_t>(known_weight_);
  Mask512 known;
  masks.occupied = kNone;
  if (const DenseBrick* dense = ref.dense()) {
    for (std::size_t z = 0; z < 8; ++z) known.words[z] = dense->weight_at_least(z, least);
    masks.occupied = known & dense->occupied;
  } else if (const FreeBrick* free = ref.free()) {
    for (std::size_t z = 0; z < 8; ++z) known.words[z] = free->weight_at_least(z, least);
  } else if (ref.constant_weight() >= least) {
    known = Mask512::all_set();
  }
  masks.unknown = ~known;
  if (workspace_) {
    const Index3 lo = (sector_ * kSectorEdge + local) * kBrickEdge;
    masks.unknown = masks.unknown & voxels_inside(*workspace_, lo);
  }
  return masks;
}

/// Applies eq. 3.2.
Mask512 ContourSector::contour(const Index3& local) {
  const Masks& here = masks(local);
  Mask512 found = ~(here.occupied | here.unknown);
  if (workspace_) found = found & voxels_inside(*workspace_, (sector_ * kSectorEdge + local) * kBrickEdge);
  if (found.none()) return found;
  found = found & spread_to_6([&](const Index3& step) -> const Mask512& { return masks(local + step).unknown; });
  if (found.none()) return found;
  return found & spread_to_18([&](const Index3& step) -> const Mask512& { return masks(local + step).occupied; });
}

/// Returns w' of eq. 3.6; 0 outside the workspace where unknown. The voxel counts from the sector's first one.
int ContourSector::modified_weight(const Index3& local_voxel) const {
  const BrickRef& ref = brick(parent(local_voxel));
  const int i = child_index(local_voxel);
  int w{0};
  int v{kTsdfOne};
  if (const DenseBrick* dense = ref.dense()) {
    w = dense->w[static_cast<std::size_t>(i)];
    v = dense->v[static_cast<std::size_t>(i)];
  } else if (const FreeBrick* free = ref.free()) {
    w = free->weight(i);
  } else {
    w = ref.constant_weight();
  }
  if (w < known_weight_) {
    const bool outside = workspace_ && !workspace_->contains(sector_ * kSectorVoxelEdge + local_voxel);
    return outside ? 0 : w - known_weight_;
  }
  if (v <= 0) return -known_weight_;
  const bool saturated = v == kTsdfOne && w == free_weight_;
  return saturated ? known_weight_ : std::min(w - known_weight_, known_weight_);
}

/// Applies eq. 3.5. Sums of integers per length of step are exact, so the order of the neighbours does not matter, and
/// they vanish only where the normal does.
std::optional<Eigen::Vector3f> ContourSector::frontier_normal(const Index3& local_voxel) const {
  std::array<Eigen::Vector3i, 3> sums;  // by the number of axes that a step follows
  sums.fill(Eigen::Vector3i::Zero());
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const int axes = x * x + y * y + z * z;
        if (axes == 0) continue;
        sums[static_cast<std::size_t>(axes - 1)] +=
            modified_weight(local_voxel + Index3{x, y, z}) * Eigen::Vector3i{x, y, z};
      }
    }
  }
  if (std::all_of(sums.begin(), sums.end(), [](const Eigen::Vector3i& sum) { return sum.isZero(); })) return {};
  const Eigen::Vector3d n = sums[0].cast<double>() + sums[1].cast<double>() / std::numbers::sqrt2 +
                            sums[2].cast<double>() / std::numbers::sqrt3;
  return n.normalized().cast<float>();
}

std::vector<ContourVoxel> ContourSector::find(const SectorBricks& bricks) {
  std::vector<ContourVoxel> found;
  enter(bricks.sector);
  if (around_[number_of({})] == nullptr) return found;
  const Mask512 near_surface = spread_to_18([&](const Index3& step) -> const Mask512& {
    const Sector* sector = around_[number_of(step)];
    return sector == nullptr ? kNone : sector->has_occupied;
  });
  (bricks.bricks & near_surface).for_each([&](std::size_t i) {
    const Index3 local = child_offset(static_cast<int>(i));
    contour(local).for_each([&](std::size_t k) {
      const Index3 voxel = local * kBrickEdge + child_offset(static_cast<int>(k));
      const auto normal = frontier_normal(voxel);
      if (normal) found.push_back({bricks.sector * kSectorVoxelEdge + voxel, *normal});
    });
  });
  return found;
}

}  // namespace saccade
