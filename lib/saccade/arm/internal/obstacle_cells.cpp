// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/obstacle_cells.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Divides by a positive number, rounding down.
std::int32_t cell_of(std::int32_t voxel, std::int32_t voxels_along) {
  return voxel >= 0 ? voxel / voxels_along : -((-voxel - 1) / voxels_along) - 1;
}

std::size_t unsigned_of(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Returns the mask of rows y0 … y1 − 1 of a slice of a brick.
std::uint64_t rows_mask(int y0, int y1) {
  return (~std::uint64_t{0} << (kBrickEdge * y0)) & (~std::uint64_t{0} >> (64 - kBrickEdge * y1));
}
/// Returns the mask of columns x0 … x1 − 1.
std::uint64_t columns_mask(int x0, int x1) {
  return (0xFFU >> (kBrickEdge - x1) & 0xFFU << x0) * std::uint64_t{0x0101010101010101};
}

const BrickRef& brick_of(const Sector* sector, std::size_t i) {
  static const BrickRef unknown;
  return sector == nullptr ? unknown : sector->bricks[i];
}

bool is_uniform(const BrickRef& brick) { return brick.is_unknown() || brick.kind() == BrickKind::constant_free; }

}  // namespace

Result<ObstacleCells> ObstacleCells::create(const TsdfConfig& map, double cell_size_m, bool unknown_is_obstacle) {
  const auto fail = [](const std::string& what) { return Error{Errc::invalid_argument, what, "obstacle cells"}; };
  if (!map.workspace) return fail("the map has no workspace; give it the box that the arm works in");
  if (!(cell_size_m > 0.0)) return fail("the cell size must be positive");
  const double voxels_along = std::max(1.0, std::round(cell_size_m / map.voxel_size_m));
  if (!(voxels_along <= kMostVoxelsAlong)) {
    return fail("the cell size must be at most " + std::to_string(kMostVoxelsAlong) + " voxels");
  }
  const IndexBox voxels = voxels_with_center_in(*map.workspace, map.voxel_size_m);
  if (voxels.empty()) return fail("the workspace holds no voxel's centre");

  ObstacleCells made;
  made.unknown_is_obstacle_ = unknown_is_obstacle;
  const auto n = static_cast<std::int32_t>(voxels_along);
  made.voxels_along_ = n;
  made.cell_edge_m_ = n * map.voxel_size_m;
  made.box_ = {{cell_of(voxels.lo.x, n), cell_of(voxels.lo.y, n), cell_of(voxels.lo.z, n)},
               {cell_of(voxels.hi.x - 1, n) + 1, cell_of(voxels.hi.y - 1, n) + 1, cell_of(voxels.hi.z - 1, n) + 1}};
  const Index3 size = made.size();
  if ((size.x + 64.0) * size.y * size.z > kMostCells) {
    return fail("the workspace holds more than " + std::to_string(std::lround(kMostCells)) +
                " cells; choose larger cells");
  }
  made.bricks_ = parents(voxels);
  made.cut_axis(0, voxels.lo.x, voxels.hi.x);
  made.cut_axis(1, voxels.lo.y, voxels.hi.y);
  made.cut_axis(2, voxels.lo.z, voxels.hi.z);
  made.reset_to_unknown();
  return made;
}

void ObstacleCells::cut_axis(std::size_t axis, std::int32_t voxel_lo, std::int32_t voxel_hi) {
  const std::int32_t cell_lo = cell_of(voxel_lo, voxels_along_);
  for (std::int32_t first = voxel_lo & ~(kBrickEdge - 1); first < voxel_hi; first += kBrickEdge) {
    const std::int32_t end = std::min(first + kBrickEdge, voxel_hi);
    std::int32_t voxel = std::max(first, voxel_lo);
    AxisPartition cut{cell_of(voxel, voxels_along_) - cell_lo, 0, {}, {}, {}};
    while (voxel < end) {
      cut.start[unsigned_of(cut.parts++)] = static_cast<std::uint8_t>(voxel - first);
      voxel = (cell_of(voxel, voxels_along_) + 1) * voxels_along_;
    }
    cut.start[unsigned_of(cut.parts)] = static_cast<std::uint8_t>(end - first);
    for (std::size_t i = 0; i < unsigned_of(cut.parts); ++i) {
      cut.rows[i] = rows_mask(cut.start[i], cut.start[i + 1]);
      cut.columns[i] = columns_mask(cut.start[i], cut.start[i + 1]);
    }
    cuts_[axis].push_back(cut);
  }
}

/// Resets to a map without bricks, in which all voxels are unknown.
void ObstacleCells::reset_to_unknown() {
  const Index3 n = size();
  const std::array<std::size_t, 3> lengths{unsigned_of(n.x), unsigned_of(n.y), unsigned_of(n.z)};
  words_per_row_ = lengths[0] / 64 + 2;
  const std::size_t rows = lengths[1] * lengths[2];
  const std::size_t cells = rows * lengths[0];
  makers_.assign(cells, 0);
  bits_.assign(rows * words_per_row_, 0);
  row_changed_.assign(rows, 1);
  if (!unknown_is_obstacle_) return;

  std::array<std::vector<std::uint16_t>, 3> bricks_at;  // per axis and cell
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bricks_at[axis].assign(lengths[axis], 0);
    for (const AxisPartition& cut : cuts_[axis]) {
      for (std::int32_t i = 0; i < cut.parts; ++i) ++bricks_at[axis][unsigned_of(cut.first_cell + i)];
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const int across = bricks_at[1][row % lengths[1]] * bricks_at[2][row / lengths[1]];
    for (std::size_t x = 0; x < lengths[0]; ++x) {
      makers_[row * lengths[0] + x] = static_cast<std::uint16_t>(bricks_at[0][x] * across);
      bits_[row * words_per_row_ + x / 64] |= std::uint64_t{1} << (x % 64);
    }
  }
  obstacle_count_ = cells;
}

Box ObstacleCells::bounds_of(const Index3& cell) const {
  const auto corner = [&](const Index3& c) {
    return Eigen::Vector3d{c.x * cell_edge_m_, c.y * cell_edge_m_, c.z * cell_edge_m_};
  };
  return {corner(cell), corner(cell + Index3{1, 1, 1})};
}

bool ObstacleCells::is_obstacle(const Index3& cell) const {
  if (!box_.contains(cell)) return false;
  const Index3 i = cell - box_.lo;
  const std::uint64_t* words = row(unsigned_of(i.z) * unsigned_of(size().y) + unsigned_of(i.y));
  return (words[i.x / 64] >> (i.x % 64) & 1U) != 0;
}

bool ObstacleCells::operator==(const ObstacleCells& other) const {
  return cell_edge_m_ == other.cell_edge_m_ && box_ == other.box_ && bits_ == other.bits_;
}

ObstacleCells::Words ObstacleCells::stops_of(const BrickRef& brick) const {
  Words words{};
  if (const DenseBrick* dense = brick.dense()) {
    words = dense->occupied.words;
    if (!unknown_is_obstacle_) return words;
    for (std::size_t z = 0; z < words.size(); ++z) words[z] |= dense->unknown.words[z];
  } else if (unknown_is_obstacle_) {
    words = brick.unknown_mask().words;
  }
  return words;
}

/// Returns the bricks with an obstacle voxel before or after, judged by the summaries.
Mask512 ObstacleCells::may_differ(const Sector* before, const Sector* after) const {
  const auto stopping = [&](const Sector* sector) {
    if (sector == nullptr) return unknown_is_obstacle_ ? Mask512::all_set() : Mask512{};
    return unknown_is_obstacle_ ? sector->has_occupied | sector->has_unknown : sector->has_occupied;
  };
  return stopping(before) | stopping(after);
}

ObstacleCells::Changes ObstacleCells::update(const TsdfGrid& map, const Executor& executor) {
  const IndexBox around = parents(bricks_);
  const Index3 n = around.size();
  const std::size_t sectors = unsigned_of(n.x) * unsigned_of(n.y) * unsigned_of(n.z);
  std::vector<ObstacleChanges> flips(sectors);
  std::vector<std::size_t> bricks(sectors, 0);
  executor.parallel_for(sectors, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto k = static_cast<std::int32_t>(i);
      const Index3 sector = around.lo + Index3{k % n.x, k / n.x % n.y, k / n.x / n.y};
      const Sector* before = seen_.find(sector);
      const Sector* after = map.find(sector);
      if (before != after) bricks[i] = compare(sector, before, after, flips[i]);
    }
  });
  Changes changes;
  std::fill(row_changed_.begin(), row_changed_.end(), updated_ ? std::uint8_t{0} : std::uint8_t{1});
  updated_ = true;
  for (const std::size_t differing : bricks) changes.bricks += differing;
  // Beginnings first, so that no cell that stays an obstacle is without a maker meanwhile.
  for (const ObstacleChanges& of_sector : flips) {
    for (const std::uint32_t cell : of_sector.begun) {
      if (makers_[cell]++ > 0) continue;
      toggle(cell);
      ++obstacle_count_;
      ++changes.cells;
    }
  }
  for (const ObstacleChanges& of_sector : flips) {
    for (const std::uint32_t cell : of_sector.ended) {
      if (--makers_[cell] > 0) continue;
      toggle(cell);
      --obstacle_count_;
      ++changes.cells;
    }
  }
  seen_ = map;
  return changes;
}

std::size_t ObstacleCells::compare(const Index3& sector, const Sector* before, const Sector* after,
                                   ObstacleChanges& flips) const {
  std::size_t differing{0};
  may_differ(before, after).for_each([&](std::size_t i) {
    const Index3 brick = sector * kSectorEdge + child_offset(static_cast<int>(i));
    const BrickRef& was = brick_of(before, i);
    const BrickRef& is = brick_of(after, i);
    if (!bricks_.contains(brick) || was.shares(is)) return;
    if (is_uniform(was) && is_uniform(is)) {
      if (!unknown_is_obstacle_ || was.is_unknown() == is.is_unknown()) return;
      ++differing;
      return add_all(brick, is.is_unknown() ? flips.begun : flips.ended);
    }
    const Words words_before = stops_of(was);
    const Words words_after = stops_of(is);
    if (words_before == words_after) return;
    ++differing;
    compare(brick, words_before, words_after, flips);
  });
  return differing;
}

/// Adds all cells that overlap the brick.
void ObstacleCells::add_all(const Index3& brick, std::vector<std::uint32_t>& to) const {
  const Index3 i = brick - bricks_.lo;
  const AxisPartition& cut_x = cuts_[0][unsigned_of(i.x)];
  const AxisPartition& cut_y = cuts_[1][unsigned_of(i.y)];
  const AxisPartition& cut_z = cuts_[2][unsigned_of(i.z)];
  const Index3 n = size();
  for (std::int32_t z = cut_z.first_cell; z < cut_z.first_cell + cut_z.parts; ++z) {
    for (std::int32_t y = cut_y.first_cell; y < cut_y.first_cell + cut_y.parts; ++y) {
      for (std::int32_t x = cut_x.first_cell; x < cut_x.first_cell + cut_x.parts; ++x) {
        to.push_back(static_cast<std::uint32_t>((z * n.y + y) * n.x + x));
      }
    }
  }
}

void ObstacleCells::compare(const Index3& brick, const Words& before, const Words& after,
                            ObstacleChanges& flips) const {
  const Index3 i = brick - bricks_.lo;
  const AxisPartition& cut_x = cuts_[0][unsigned_of(i.x)];
  const AxisPartition& cut_y = cuts_[1][unsigned_of(i.y)];
  const AxisPartition& cut_z = cuts_[2][unsigned_of(i.z)];
  const Index3 n = size();
  std::array<std::uint32_t, kBrickVoxels> begun;
  std::array<std::uint32_t, kBrickVoxels> ended;
  std::size_t begun_count{0};
  std::size_t ended_count{0};
  for (std::size_t z = 0; z < unsigned_of(cut_z.parts); ++z) {
    std::uint64_t slice_before{0};
    std::uint64_t slice_after{0};
    for (std::size_t k = cut_z.start[z]; k < cut_z.start[z + 1]; ++k) {
      slice_before |= before[k];
      slice_after |= after[k];
    }
    if (slice_before == slice_after) continue;
    const std::int32_t layer = (cut_z.first_cell + static_cast<std::int32_t>(z)) * n.y;
    for (std::size_t y = 0; y < unsigned_of(cut_y.parts); ++y) {
      const std::int32_t row = layer + cut_y.first_cell + static_cast<std::int32_t>(y);
      auto cell = static_cast<std::uint32_t>(row * n.x + cut_x.first_cell);
      for (std::size_t x = 0; x < unsigned_of(cut_x.parts); ++x, ++cell) {
        const std::uint64_t part = cut_y.rows[y] & cut_x.columns[x];
        const bool was = (slice_before & part) != 0;
        const bool is = (slice_after & part) != 0;
        begun[begun_count] = cell;  // without a branch, which would be hard to predict
        ended[ended_count] = cell;
        begun_count += static_cast<std::size_t>(!was & is);
        ended_count += static_cast<std::size_t>(was & !is);
      }
    }
  }
  flips.begun.insert(flips.begun.end(), begun.begin(), begun.begin() + static_cast<std::ptrdiff_t>(begun_count));
  flips.ended.insert(flips.ended.end(), ended.begin(), ended.begin() + static_cast<std::ptrdiff_t>(ended_count));
}

void ObstacleCells::toggle(std::uint32_t cell) {
  const auto length = static_cast<std::uint32_t>(size().x);
  const std::uint32_t row = cell / length;
  const std::uint32_t x = cell % length;
  bits_[row * words_per_row_ + x / 64] ^= std::uint64_t{1} << (x % 64);
  row_changed_[row] = 1;
}

}  // namespace saccade
