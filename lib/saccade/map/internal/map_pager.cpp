// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/map_pager.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace saccade {
namespace {

/// A sector that may go out, in the order in which they do.
struct Candidate {
  bool inside;
  std::uint64_t seen;
  Index3 key;
  std::size_t bytes;
  [[nodiscard]] bool operator<(const Candidate& other) const {
    if (inside != other.inside) return !inside;
    if (seen != other.seen) return seen < other.seen;
    return zyx_less(key, other.key);
  }
};

}  // namespace

Result<std::vector<LoadedSector>> read_away(const TsdfGrid& grid, std::span<const Index3> keys,
                                            const Executor& executor) {
  std::vector<Index3> away;
  for (const Index3& key : keys) {
    if (grid.is_away(key)) away.push_back(key);
  }
  std::vector<Result<SectorRef>> read(away.size(), Result<SectorRef>{SectorRef{}});
  executor.parallel_for(away.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) read[i] = grid.read(away[i]);
  });
  std::vector<LoadedSector> loaded;
  loaded.reserve(away.size());
  for (std::size_t i = 0; i < away.size(); ++i) {
    if (!read[i]) return read[i].error();
    loaded.push_back({away[i], std::move(*read[i])});
  }
  return loaded;
}

MapPager::MapPager(const PagingConfig& config, double voxel_size_m, const TsdfGrid& grid)
    : config_{config}, sector_m_{kSectorVoxelEdge * voxel_size_m}, center_world_{Eigen::Vector3d::Zero()} {
  for (const Index3& key : grid.sorted_sectors()) {
    if (const SectorRef ref = grid.in_memory(key)) note(key, memory_bytes(*ref));
  }
  stats_.sectors_away = grid.away_count();
}

Status MapPager::bring_in(TsdfGrid& grid, std::span<const Index3> needed, const Eigen::Vector3d* camera_world,
                          const Executor& executor) {
  ++clock_;
  std::size_t incoming{0};
  for (const Index3& key : needed) {
    const auto it = residents_.find(key);
    if (it != residents_.end()) {
      it->second.seen = clock_;
    } else if (const auto stored = grid.away(key)) {
      incoming += stored->summary().memory_bytes;
    }
  }
  const bool shifted = config_.moving_volume_m && camera_world != nullptr && shift(*camera_world);
  SACCADE_CHECK(take_out(grid, surplus(incoming, clock_), executor));
  SACCADE_CHECK(put_in(grid, needed, executor));
  if (shifted) SACCADE_CHECK(put_in(grid, returning(grid), executor));
  return {};
}

void MapPager::settle(TsdfGrid& grid, std::span<const Index3> written, const Executor& executor) {
  std::vector<std::size_t> bytes(written.size(), 0);
  executor.parallel_for(written.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const SectorRef ref = grid.in_memory(written[i])) bytes[i] = memory_bytes(*ref);
    }
  });
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (bytes[i] > 0) {
      note(written[i], bytes[i]);
    } else {
      forget(written[i]);
    }
  }
  constexpr std::uint64_t kNone{std::numeric_limits<std::uint64_t>::max()};
  static_cast<void>(take_out(grid, surplus(0, kNone), executor));
}

Status MapPager::page_out_all(TsdfGrid& grid, const Executor& executor) {
  std::vector<Index3> keys;
  for (const auto& entry : residents_) keys.push_back(entry.first);
  std::sort(keys.begin(), keys.end(), zyx_less);
  return take_out(grid, keys, executor);
}

void MapPager::note(const Index3& key, std::size_t bytes) {
  Resident& resident = residents_[key];
  stats_.map_bytes += bytes - resident.bytes;
  stats_.peak_map_bytes = std::max(stats_.peak_map_bytes, stats_.map_bytes);
  resident = {bytes, clock_};
}

void MapPager::forget(const Index3& key) {
  const auto it = residents_.find(key);
  if (it == residents_.end()) return;
  stats_.map_bytes -= it->second.bytes;
  residents_.erase(it);
}

bool MapPager::shift(const Eigen::Vector3d& camera_world) {
  const double edge_m = *config_.moving_volume_m;
  const bool left = !is_placed_ || (camera_world - center_world_).cwiseAbs().maxCoeff() > edge_m / 4.0;
  if (!left) return false;
  if (is_placed_) ++stats_.shifts;
  is_placed_ = true;
  center_world_ = camera_world;
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(edge_m / 2.0);
  volume_ = {voxel_at(camera_world - half, sector_m_), voxel_at(camera_world + half, sector_m_) + Index3{1, 1, 1}};
  return true;
}

std::vector<Index3> MapPager::surplus(std::size_t incoming, std::uint64_t spare) const {
  const std::size_t limit = config_.memory_bytes.value_or(std::numeric_limits<std::size_t>::max());
  const std::size_t allowed = limit - std::min(limit, incoming);
  if (stats_.map_bytes <= allowed && (!config_.moving_volume_m || !is_placed_)) return {};
  std::vector<Candidate> candidates;
  for (const auto& [key, resident] : residents_) {
    if (resident.seen < spare)
      candidates.push_back({!is_placed_ || is_inside(key), resident.seen, key, resident.bytes});
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<Index3> keys;
  std::size_t left = stats_.map_bytes;
  for (const Candidate& candidate : candidates) {
    if (candidate.inside && left <= allowed) break;
    left -= candidate.bytes;
    keys.push_back(candidate.key);
  }
  return keys;
}

Status MapPager::take_out(TsdfGrid& grid, std::span<const Index3> keys, const Executor& executor) {
  struct Going {
    Result<std::shared_ptr<const StoredSector>> stored{std::shared_ptr<const StoredSector>{}};
    bool written{false};
  };
  std::vector<Going> going(keys.size());
  executor.parallel_for(keys.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SectorRef ref = grid.in_memory(keys[i]);
      going[i].written = ref.stored() == nullptr;
      going[i].stored = ref.stored() != nullptr ? Result<std::shared_ptr<const StoredSector>>{ref.stored()}
                                                : StoredSector::write(config_.store, *ref);
    }
  });
  Status status;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!going[i].stored) {
      if (status.ok()) status = going[i].stored.error();
      continue;
    }
    if (going[i].written) stats_.bytes_written += (*going[i].stored)->stored_bytes();
    grid.page_out(keys[i], std::move(*going[i].stored));
    forget(keys[i]);
    ++stats_.sectors_out;
  }
  stats_.sectors_away = grid.away_count();
  return status;
}

Status MapPager::put_in(TsdfGrid& grid, std::span<const Index3> keys, const Executor& executor) {
  SACCADE_TRY(const std::vector<LoadedSector> loaded, read_away(grid, keys, executor));
  for (const LoadedSector& sector : loaded) {
    stats_.bytes_read += sector.ref.stored()->stored_bytes();
    note(sector.key, sector.ref.stored()->summary().memory_bytes);
    grid.page_in(sector.key, sector.ref);
    ++stats_.sectors_in;
  }
  stats_.sectors_away = grid.away_count();
  return {};
}

std::vector<Index3> MapPager::returning(const TsdfGrid& grid) const {
  const std::size_t limit = config_.memory_bytes.value_or(std::numeric_limits<std::size_t>::max());
  std::size_t bytes = stats_.map_bytes;
  std::vector<Index3> keys;
  for (const Index3& key : grid.away_in(volume_)) {
    bytes += grid.away(key)->summary().memory_bytes;
    if (bytes > limit) break;
    keys.push_back(key);
  }
  return keys;
}

}  // namespace saccade
