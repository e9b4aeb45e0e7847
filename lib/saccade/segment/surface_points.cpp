// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/surface_points.hpp"

#include <algorithm>
#include <array>

#include "saccade/map/surface_cells.hpp"

namespace saccade {

namespace {

constexpr int kRow{VoxelBlock::kEdge};
constexpr int kSlice{VoxelBlock::kEdge * VoxelBlock::kEdge};
constexpr std::array<int, 3> kStride{1, kRow, kSlice};

const BrickRef* find(const SectorTable& table, const Index3& brick) {
  const Sector* sector = table.find(parent(brick));
  return sector == nullptr ? nullptr : &sector->bricks[static_cast<std::size_t>(child_index(brick))];
}

/// Returns the mean of the zero crossings on the edges of a cell, in voxels from its lower corner.
Eigen::Vector3f mean_crossing(const std::array<float, 8>& v) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float crossings{0.0F};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t bit = std::size_t{1} << axis;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner & bit) != 0) continue;
      const float v0 = v[corner];
      const float v1 = v[corner | bit];
      if ((v0 <= 0.0F) == (v1 <= 0.0F)) continue;
      sum[static_cast<Eigen::Index>(axis)] += v0 / (v0 - v1);
      for (std::size_t other = 0; other < 3; ++other) {
        if (other != axis) sum[static_cast<Eigen::Index>(other)] += static_cast<float>((corner >> other) & 1U);
      }
      crossings += 1.0F;
    }
  }
  return sum / crossings;
}

/// Returns the sum of eq. 3.4 at the two middle voxels of four in a row; the outer ones may be unknown.
int gradient_sum(const std::int16_t* first, int stride) {
  const int b = first[stride];
  const int c = first[2 * stride];
  const int a = first[0] != VoxelBlock::kUnknown ? first[0] : 2 * b - c;
  const int d = first[3 * stride] != VoxelBlock::kUnknown ? first[3 * stride] : 2 * c - b;
  return (c - a) + (d - b);
}

}  // namespace

SurfaceExtraction::SurfaceExtraction(const SectorTable& table, double voxel_size_m, std::uint16_t min_weight)
    : table_{&table}, voxel_size_m_{voxel_size_m}, min_weight_{std::max<std::uint16_t>(min_weight, 1)} {}

const std::vector<SurfaceExtraction::Point>& SurfaceExtraction::points_of(const Index3& brick) {
  points_.clear();
  const Mask512 crossed = crossed_cells(*table_, brick);
  if (crossed.none()) return points_;
  block_.load(*table_, brick, min_weight_);
  has_colors_ = false;
  for (int i = 0; i < 8; ++i) {
    const BrickRef* ref = find(*table_, brick + Index3{i & 1, (i >> 1) & 1, i >> 2});
    has_colors_ = has_colors_ || (ref != nullptr && ref->dense() != nullptr && ref->dense()->colors != nullptr);
  }
  crossed.for_each([&](std::size_t i) { add_point(brick, child_offset(static_cast<int>(i))); });
  return points_;
}

void SurfaceExtraction::add_point(const Index3& brick, const Index3& local) {
  const std::int16_t* corner = block_.row(local.y, local.z) + (local.x + 1);
  std::array<float, 8> v{};
  bool occupied{false};
  bool empty{false};
  for (std::size_t i = 0; i < 8; ++i) {
    const std::int16_t value =
        corner[static_cast<int>(i & 1) + static_cast<int>((i >> 1) & 1) * kRow + static_cast<int>(i >> 2) * kSlice];
    if (value == VoxelBlock::kUnknown) return;  // observed too rarely
    occupied = occupied || value <= 0;
    empty = empty || value > 0;
    v[i] = static_cast<float>(value);
  }
  if (!occupied || !empty) return;
  Point point;
  point.cell = brick * kBrickEdge + local;
  const Eigen::Vector3d corner_m = voxel_center(point.cell, voxel_size_m_);
  point.position_m = (corner_m + voxel_size_m_ * mean_crossing(v).cast<double>()).cast<float>();
  Eigen::Vector3f gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int along = kStride[axis];
    const int u = kStride[(axis + 1) % 3];
    const int w = kStride[(axis + 2) % 3];
    const std::int16_t* row = corner - along;
    gradient[static_cast<Eigen::Index>(axis)] =
        static_cast<float>(gradient_sum(row, along) + gradient_sum(row + u, along) + gradient_sum(row + w, along) +
                           gradient_sum(row + u + w, along));
  }
  const float length = gradient.norm();
  point.normal = length > 0.0F ? Eigen::Vector3f{gradient / length} : Eigen::Vector3f{Eigen::Vector3f::Zero()};
  point.color = Eigen::Vector3f::Constant(0.5F);
  if (has_colors_) add_color(point.cell, point);
  points_.push_back(point);
}

void SurfaceExtraction::add_color(const Index3& cell, Point& point) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count{0.0F};
  for (int i = 0; i < 8; ++i) {
    const Index3 voxel = cell + Index3{i & 1, (i >> 1) & 1, i >> 2};
    const BrickRef* ref = find(*table_, parent(voxel));
    const DenseBrick* dense = ref == nullptr ? nullptr : ref->dense();
    if (dense == nullptr || dense->colors == nullptr) continue;
    const Rgb8 color = (*dense->colors)[static_cast<std::size_t>(child_index(voxel))];
    if (color == Rgb8{}) continue;  // black: none was fused
    sum += Eigen::Vector3f{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
    count += 1.0F;
  }
  if (count == 0.0F) return;
  point.color = sum / (255.0F * count);
  point.colored = true;
}

PointCloud surface_points(const TsdfSnapshot& map, const Executor& executor, std::uint16_t min_weight) {
  const SectorTable table{map.grid};
  std::vector<Index3> bricks;
  for (const Index3& sector : map.grid.sorted_sectors()) {
    bricks_with_occupied_corner(table, sector).for_each([&](std::size_t i) {
      bricks.push_back(sector * kSectorEdge + child_offset(static_cast<int>(i)));
    });
  }
  std::sort(bricks.begin(), bricks.end(), zyx_less);
  constexpr std::size_t kGrain{64};
  std::vector<std::vector<SurfaceExtraction::Point>> chunks((bricks.size() + kGrain - 1) / kGrain);
  executor.parallel_for(bricks.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    SurfaceExtraction extraction{table, map.config.voxel_size_m, min_weight};
    std::vector<SurfaceExtraction::Point>& chunk = chunks[begin / kGrain];
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<SurfaceExtraction::Point>& points = extraction.points_of(bricks[i]);
      chunk.insert(chunk.end(), points.begin(), points.end());
    }
  });
  PointCloud cloud;
  bool colored{false};
  for (const auto& chunk : chunks) {
    for (const SurfaceExtraction::Point& point : chunk) {
      cloud.positions_m.push_back(point.position_m);
      cloud.normals.push_back(point.normal);
      cloud.colors.push_back(point.color);
      colored = colored || point.colored;
    }
  }
  if (!colored) cloud.colors.clear();
  return cloud;
}

}  // namespace saccade
