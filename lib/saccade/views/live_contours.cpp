// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/contours.hpp"

#include <algorithm>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

/// Tells whether contours mean the same in both maps, so that contours of one can be updated to the other.
bool same_terms(const TsdfConfig& a, const TsdfConfig& b) {
  if (a.voxel_size_m != b.voxel_size_m || a.free_weight != b.free_weight) return false;
  if (a.workspace.has_value() != b.workspace.has_value()) return false;
  return !a.workspace || (a.workspace->min == b.workspace->min && a.workspace->max == b.workspace->max);
}

int brick_of(const ContourVoxel& voxel) { return child_index(parent(voxel.voxel)); }

}  // namespace

Result<LiveContours> LiveContours::create(const ContourConfig& config) {
  SACCADE_CHECK(config.validate());
  return LiveContours{config};
}

ContoursUpdate LiveContours::update(const TsdfSnapshot& map, const Executor& executor) {
  const Stopwatch stopwatch;
  ContoursUpdate done;
  if (!same_terms(map_.config, map.config)) {
    sectors_.clear();
    map_.grid = {};
  }
  const std::vector<SectorBricks> changed = changed_sectors(map_.grid, map.grid, executor);
  for (const SectorBricks& sector : changed) done.bricks_changed += static_cast<std::size_t>(sector.bricks.count());
  const std::vector<SectorBricks> stale = with_neighbors(changed);
  const std::vector<std::vector<ContourVoxel>> fresh = contour_voxels_in(map, stale, config_, executor);
  for (std::size_t i = 0; i < stale.size(); ++i) replace(stale[i], fresh[i]);
  std::erase_if(sectors_, [](const Sector& sector) { return sector.voxels.empty(); });
  map_ = map;
  done.ms = stopwatch.elapsed_ms();
  return done;
}

void LiveContours::replace(const SectorBricks& stale, const std::vector<ContourVoxel>& fresh) {
  auto at = std::lower_bound(sectors_.begin(), sectors_.end(), stale.sector,
                             [](const Sector& sector, const Index3& key) { return zyx_less(sector.key, key); });
  if (at == sectors_.end() || !(at->key == stale.sector)) {
    if (fresh.empty()) return;
    at = sectors_.insert(at, {stale.sector, {}});
  }
  std::vector<ContourVoxel>& voxels = at->voxels;
  std::erase_if(voxels, [&](const ContourVoxel& voxel) { return stale.bricks.test(brick_of(voxel)); });
  const auto kept = static_cast<std::ptrdiff_t>(voxels.size());
  voxels.insert(voxels.end(), fresh.begin(), fresh.end());
  std::inplace_merge(voxels.begin(), voxels.begin() + kept, voxels.end(),
                     [](const ContourVoxel& a, const ContourVoxel& b) { return brick_of(a) < brick_of(b); });
}

std::vector<ContourVoxel> LiveContours::voxels() const {
  std::vector<ContourVoxel> all;
  for (const Sector& sector : sectors_) all.insert(all.end(), sector.voxels.begin(), sector.voxels.end());
  return all;
}

std::vector<ContourPoint> LiveContours::points() const {
  return contour_points(voxels(), map_.config.voxel_size_m, config_);
}

}  // namespace saccade
