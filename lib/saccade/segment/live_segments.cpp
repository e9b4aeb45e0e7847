// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/live_segments.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/map/surface_cells.hpp"
#include "saccade/segment/internal/surface_block.hpp"
#include "saccade/segment/surface_points.hpp"

namespace saccade {

namespace {

constexpr std::size_t kBlockGrain{32};
constexpr double kSeedSpacing_vox{4.0};

std::size_t voxels_in(const SurfaceBlocks& blocks, std::span<const std::uint32_t> slots) {
  std::size_t voxels{0};
  for (const std::uint32_t slot : slots) voxels += blocks[slot].voxels.size();
  return voxels;
}

/// Computes the means of the points of each voxel in `mask`.
void make_voxels(SurfaceBlock& block) {
  const auto count = static_cast<std::size_t>(block.mask.count());
  std::vector<Eigen::Matrix<double, 9, 1>> sums(count, Eigen::Matrix<double, 9, 1>::Zero());
  block.voxels.resize(count);
  for (std::size_t i = 0; i < block.positions_m.size(); ++i) {
    const std::uint16_t voxel = block.voxel_of[i];
    sums[voxel].head<3>() += block.positions_m[i].cast<double>();
    sums[voxel].segment<3>(3) += block.normals[i].cast<double>();
    if (!block.colors.empty()) sums[voxel].tail<3>() += block.colors[i].cast<double>();
    block.voxels[voxel].points += 1;
  }
  for (std::size_t v = 0; v < count; ++v) {
    CloudVoxel& voxel = block.voxels[v];
    const Eigen::Matrix<double, 9, 1> mean = sums[v] / static_cast<double>(voxel.points);
    voxel.position_m = mean.head<3>().cast<float>();
    voxel.place = voxel.position_m;
    const double length = mean.segment<3>(3).norm();
    voxel.normal = Eigen::Vector3f::UnitZ();  // fallback where the normals cancel out
    if (length > 0.0) voxel.normal = (mean.segment<3>(3) / length).cast<float>();
    voxel.color =
        block.colors.empty() ? Eigen::Vector3f::Constant(0.5F) : Eigen::Vector3f{mean.tail<3>().cast<float>()};
  }
}

}  // namespace

Status MapSegmentsConfig::validate() const {
  if (!(std::isfinite(voxel_size_m) && voxel_size_m > 0.0)) {
    return Error{Errc::invalid_argument, "voxel_size_m must be positive", "segments of a map"};
  }
  if (within) SACCADE_CHECK(saccade::validate(Region{*within}));
  SACCADE_CHECK(supervoxels(voxel_size_m).validate());
  return lccp.validate();
}

SupervoxelConfig MapSegmentsConfig::supervoxels(double map_voxel_size_m) const {
  SupervoxelConfig made;
  made.voxels.voxel_size_m = map_voxel_size_m;
  for (int doubled = 0; doubled < 3; ++doubled) {
    if (voxel_size_m < 1.5 * made.voxels.voxel_size_m) break;
    made.voxels.voxel_size_m *= 2.0;
  }
  made.seed_spacing_m = kSeedSpacing_vox * made.voxels.voxel_size_m;
  made.spatial_weight = spatial_weight;
  made.normal_weight = normal_weight;
  made.color_weight = color_weight;
  made.min_seed_share = min_seed_share;
  return made;
}

LiveSegments::LiveSegments(const MapSegmentsConfig& config) : config_{config}, blocks_{SurfaceBlocks{}} {}

Result<LiveSegments> LiveSegments::create(const MapSegmentsConfig& config) {
  SACCADE_CHECK(config.validate());
  return LiveSegments{config};
}

MapSegmentsUpdate LiveSegments::update(const TsdfSnapshot& map, const Executor& executor) {
  SACCADE_EXPECTS(map_.grid.empty() || map.config.voxel_size_m == map_.config.voxel_size_m);
  const Stopwatch stopwatch;
  MapSegmentsUpdate done;
  supervoxel_config_ = config_.supervoxels(map.config.voxel_size_m);
  shift_ = static_cast<int>(std::lround(std::log2(supervoxel_config_.voxels.voxel_size_m / map.config.voxel_size_m)));
  const std::vector<SectorBricks> changed = changed_sectors(map_.grid, map.grid, executor);
  for (const SectorBricks& sector : changed) done.bricks_changed += static_cast<std::size_t>(sector.bricks.count());

  const Slots renewed = renew_surface(map, with_neighbors(changed), executor);
  done.voxels_changed = voxels_in(*blocks_, renewed);
  if (renewed.empty()) {
    map_ = map;
    done.ms = stopwatch.elapsed_ms();
    return done;
  }
  const Slots stale = blocks_->with_rings(renewed, 2);
  done.voxels_labelled = voxels_in(*blocks_, stale);
  Slots touched = renew_labels(stale, executor);
  touched.insert(touched.end(), renewed.begin(), renewed.end());
  touched = blocks_->with_rings(touched, 1);
  renew_parts(touched, executor);
  renew_own(blocks_->with_rings(touched, 1), executor);
  reorder(renewed);
  join(executor);
  map_ = map;
  done.ms = stopwatch.elapsed_ms();
  return done;
}

/// Returns the keys of the blocks that have or had a surface in these bricks.
std::vector<Index3> LiveSegments::keys_of(const SectorTable& table, std::span<const SectorBricks> stale) const {
  std::vector<Index3> keys;
  for (const SectorBricks& sector : stale) {
    const Mask512 crossed = bricks_with_occupied_corner(table, sector.sector);
    sector.bricks.for_each([&](std::size_t i) {
      const Index3 brick = sector.sector * kSectorEdge + child_offset(static_cast<int>(i));
      const Index3 key{brick.x >> shift_, brick.y >> shift_, brick.z >> shift_};
      if (!keys.empty() && keys.back() == key) return;
      if (!is_wanted(key)) return;
      if (crossed.test(static_cast<int>(i)) || blocks_->find(key) != SurfaceBlocks::kNone) keys.push_back(key);
    });
  }
  std::sort(keys.begin(), keys.end(), zyx_less);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

bool LiveSegments::is_wanted(const Index3& key) const {
  if (!config_.within) return true;
  const double edge_m = kBrickEdge * supervoxel_config_.voxels.voxel_size_m;
  const Eigen::Vector3d low =
      edge_m * Eigen::Vector3d{static_cast<double>(key.x), static_cast<double>(key.y), static_cast<double>(key.z)};
  return overlap(*config_.within, {low, low.array() + edge_m}) != Overlap::none;
}

SurfaceBlock LiveSegments::read_block(const SectorTable& table, const Index3& key) const {
  SurfaceExtraction extraction{table, supervoxel_config_.voxels.voxel_size_m / (1 << shift_), config_.min_weight};
  std::vector<std::pair<std::uint16_t, SurfaceExtraction::Point>> points;  // with their voxels
  bool colored{false};
  SurfaceBlock block;
  block.key = key;
  const int edge = 1 << shift_;
  IndexBox::cube(key * edge, edge).for_each([&](const Index3& brick) {
    for (const SurfaceExtraction::Point& point : extraction.points_of(brick)) {
      const int voxel = child_index({point.cell.x >> shift_, point.cell.y >> shift_, point.cell.z >> shift_});
      block.mask.set(voxel);
      points.emplace_back(static_cast<std::uint16_t>(voxel), point);
      colored = colored || point.colored;
    }
  });
  block.voxel_of.reserve(points.size());
  block.positions_m.reserve(points.size());
  block.normals.reserve(points.size());
  if (shift_ > 0)
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::uint16_t voxel{0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i].first != points[i - 1].first) ++voxel;
    block.voxel_of.push_back(voxel);
    block.positions_m.push_back(points[i].second.position_m);
    block.normals.push_back(points[i].second.normal);
    if (colored) block.colors.push_back(points[i].second.color);
  }
  make_voxels(block);
  return block;
}

/// @return the blocks whose surface changed; those without a surface now are empty.
LiveSegments::Slots LiveSegments::renew_surface(const TsdfSnapshot& map, std::span<const SectorBricks> stale,
                                                const Executor& executor) {
  const SectorTable table{map.grid};
  const std::vector<Index3> keys = keys_of(table, stale);
  std::vector<SurfaceBlock> fresh(keys.size());
  executor.parallel_for(keys.size(), kBlockGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fresh[i] = read_block(table, keys[i]);
  });
  Slots renewed;
  for (SurfaceBlock& block : fresh) {
    std::uint32_t slot = blocks_->find(block.key);
    if (slot == SurfaceBlocks::kNone) {
      if (block.voxels.empty()) continue;
      slot = blocks_->insert(std::move(block));
    } else {
      if ((*blocks_)[slot].same_surface(block)) continue;
      (*blocks_)[slot] = std::move(block);
    }
    renewed.push_back(slot);
  }
  return renewed;
}

std::uint32_t LiveSegments::number(VoxelName name) const {
  const std::uint32_t slot = name / kBrickVoxels;
  const std::vector<SurfaceBlock::OwnedSupervoxel>& own = (*blocks_)[slot].own;
  std::uint32_t position{0};
  while (own[position].name != name) ++position;
  return first_number_[slot] + position;
}

/// Removes empty blocks and inserts new ones.
void LiveSegments::reorder(const Slots& renewed) {
  std::erase_if(order_, [&](std::uint32_t slot) { return (*blocks_)[slot].voxels.empty(); });
  std::vector<bool> known(blocks_->slots());
  for (const std::uint32_t slot : order_) known[slot] = true;
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return blocks_->block_before(a, b); };
  const auto old_end = static_cast<std::ptrdiff_t>(order_.size());
  for (const std::uint32_t slot : renewed) {
    if ((*blocks_)[slot].voxels.empty()) {
      blocks_->erase(slot);
    } else if (!known[slot]) {
      order_.push_back(slot);
    }
  }
  std::sort(order_.begin() + old_end, order_.end(), before);
  std::inplace_merge(order_.begin(), order_.begin() + old_end, order_.end(), before);
}

/// Numbers supervoxels and edges, and joins them.
void LiveSegments::join(const Executor& executor) {
  first_number_.assign(blocks_->slots(), 0);
  std::vector<std::size_t> first_edges;
  std::size_t supervoxels{0};
  std::size_t edges{0};
  SupervoxelResult made;
  made.voxel_size_m = supervoxel_config_.voxels.voxel_size_m;
  for (const std::uint32_t slot : order_) {
    first_number_[slot] = static_cast<std::uint32_t>(supervoxels);
    first_edges.push_back(edges);
    supervoxels += (*blocks_)[slot].own.size();
    edges += (*blocks_)[slot].edges.size();
    made.voxels += (*blocks_)[slot].voxels.size();
  }
  made.supervoxels.resize(supervoxels);
  made.edges.resize(edges);
  std::vector<std::uint8_t> convex(edges);
  executor.parallel_for(order_.size(), 16 * kBlockGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SurfaceBlock& block = (*blocks_)[order_[b]];
      const std::uint32_t first = first_number_[order_[b]];
      for (std::size_t i = 0; i < block.own.size(); ++i) made.supervoxels[first + i] = block.own[i].supervoxel;
      for (std::size_t i = 0; i < block.edges.size(); ++i) {
        made.edges[first_edges[b] + i] = {first + block.edges[i].from, number(block.edges[i].to)};
        convex[first_edges[b] + i] = block.edges[i].convex ? 1 : 0;
      }
    }
  });
  supervoxels_ = std::move(made);
  segments_ = join_convex(supervoxels_, {convex.begin(), convex.end()}, config_.lccp);
}

/// Reads the number of each voxel's supervoxel.
void LiveSegments::read_numbers(const SurfaceBlock& block, Slots& numbers) const {
  numbers.clear();
  for (const VoxelName name : block.labels) numbers.push_back(number(name));
}

VoxelSegments LiveSegments::voxels(const Executor& executor) const {
  VoxelSegments made{{}, {}, segments_.segments};
  std::vector<std::size_t> firsts;
  std::size_t voxels{0};
  for (const std::uint32_t slot : order_) {
    firsts.push_back(voxels);
    voxels += (*blocks_)[slot].voxels.size();
  }
  made.positions_m.resize(voxels);
  made.labels.resize(voxels);
  executor.parallel_for(order_.size(), kBlockGrain, [&](std::size_t begin, std::size_t end) {
    Slots numbers;
    for (std::size_t b = begin; b < end; ++b) {
      const SurfaceBlock& block = (*blocks_)[order_[b]];
      read_numbers(block, numbers);
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        made.positions_m[firsts[b] + i] = block.voxels[i].position_m;
        made.labels[firsts[b] + i] = segments_.segment_of[numbers[i]];
      }
    }
  });
  return made;
}

MapSegments LiveSegments::segments(const Executor& executor) const {
  MapSegments made{{}, supervoxels_, segments_};
  std::vector<std::size_t> firsts;
  std::size_t points{0};
  bool colored{false};
  for (const std::uint32_t slot : order_) {
    firsts.push_back(points);
    points += (*blocks_)[slot].positions_m.size();
    colored = colored || !(*blocks_)[slot].colors.empty();
  }
  made.points.positions_m.resize(points);
  made.points.normals.resize(points);
  if (colored) made.points.colors.assign(points, Eigen::Vector3f::Constant(0.5F));
  made.supervoxels.labels.resize(points);
  made.segments.labels.resize(points);
  executor.parallel_for(order_.size(), kBlockGrain, [&](std::size_t begin, std::size_t end) {
    Slots numbers;
    for (std::size_t b = begin; b < end; ++b) {
      const SurfaceBlock& block = (*blocks_)[order_[b]];
      read_numbers(block, numbers);
      const auto first = static_cast<std::ptrdiff_t>(firsts[b]);
      std::copy(block.positions_m.begin(), block.positions_m.end(), made.points.positions_m.begin() + first);
      std::copy(block.normals.begin(), block.normals.end(), made.points.normals.begin() + first);
      std::copy(block.colors.begin(), block.colors.end(), made.points.colors.begin() + (colored ? first : 0));
      for (std::size_t i = 0; i < block.voxel_of.size(); ++i) {
        made.supervoxels.labels[firsts[b] + i] = numbers[block.voxel_of[i]];
        made.segments.labels[firsts[b] + i] = segments_.segment_of[numbers[block.voxel_of[i]]];
      }
    }
  });
  return made;
}

Result<MapSegments> segment_map(const TsdfSnapshot& map, const Executor& executor, const MapSegmentsConfig& config) {
  SACCADE_TRY(LiveSegments live, LiveSegments::create(config));
  static_cast<void>(live.update(map, executor));
  return live.segments(executor);
}

}  // namespace saccade
