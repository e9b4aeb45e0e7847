// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/contours.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "saccade/views/internal/contour_sector.hpp"

namespace saccade {
namespace {

/// Contour voxels in cells of a cube, so that all within a distance lie in 27 cells. Voxels can be removed.
class VoxelCells {
 public:
  VoxelCells(std::span<const ContourVoxel> voxels, double distance_vox) {
    constexpr double kLargest{1 << 28};
    edge_ = static_cast<std::int32_t>(std::clamp(std::ceil(distance_vox), 1.0, kLargest));
    for (std::size_t i = 0; i < voxels.size(); ++i) cells_[cell_of(voxels[i].voxel)].push_back(i);
  }

  /// Removes the voxels near a voxel for which `take` returns true, in a fixed order.
  template <class Take>
  void take_near(const Index3& voxel, const Take& take) {
    const Index3 middle = cell_of(voxel);
    for (int i = 0; i < 27; ++i) {
      const auto cell = cells_.find(middle + Index3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
      if (cell == cells_.end()) continue;
      std::erase_if(cell->second, take);
      if (cell->second.empty()) cells_.erase(cell);
    }
  }

 private:
  /// Rounds towards zero. The cells around zero are larger, which does no harm.
  [[nodiscard]] Index3 cell_of(const Index3& voxel) const {
    return {voxel.x / edge_, voxel.y / edge_, voxel.z / edge_};
  }

  std::int32_t edge_{1};
  std::unordered_map<Index3, std::vector<std::size_t>, Index3Hash> cells_;
};

double squared_distance_vox(const Index3& a, const Index3& b) {
  const double x = static_cast<double>(a.x) - b.x;
  const double y = static_cast<double>(a.y) - b.y;
  const double z = static_cast<double>(a.z) - b.z;
  return x * x + y * y + z * z;
}

}  // namespace

Status ContourConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "contours"}; };
  if (known_weight < 1) return fail("known_weight must be at least 1");
  if (!(std::isfinite(group_distance_m) && group_distance_m > 0.0)) return fail("group_distance_m must be positive");
  if (!(group_angle_rad > 0.0 && group_angle_rad <= 90_deg)) {
    return fail("group_angle_rad must lie above 0 and not above 90 deg");
  }
  return {};
}

std::vector<std::vector<ContourVoxel>> contour_voxels_in(const TsdfSnapshot& map, std::span<const SectorBricks> sectors,
                                                         const ContourConfig& config, const Executor& executor) {
  SACCADE_EXPECTS(config.validate().ok());
  const SectorTable table{map.grid};
  std::vector<std::vector<ContourVoxel>> found(sectors.size());
  executor.parallel_for(sectors.size(), 4, [&](std::size_t begin, std::size_t end) {
    ContourSector sector{map, table, config.known_weight};
    for (std::size_t i = begin; i < end; ++i) found[i] = sector.find(sectors[i]);
  });
  return found;
}

Result<std::vector<ContourVoxel>> contour_voxels(const TsdfSnapshot& map, const ContourConfig& config,
                                                 const Executor& executor) {
  SACCADE_CHECK(config.validate());
  std::vector<SectorBricks> sectors;
  for (const Index3& sector : map.grid.sorted_sectors()) sectors.push_back({sector, Mask512::all_set()});
  std::vector<ContourVoxel> all;
  for (const std::vector<ContourVoxel>& found : contour_voxels_in(map, sectors, config, executor)) {
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

std::vector<ContourPoint> contour_points(std::span<const ContourVoxel> voxels, double voxel_size_m,
                                         const ContourConfig& config) {
  SACCADE_EXPECTS(config.validate().ok() && voxel_size_m > 0.0);
  const double distance_vox = config.group_distance_m / voxel_size_m;
  const double least_cosine = std::cos(config.group_angle_rad);
  VoxelCells left{voxels, distance_vox};
  std::vector<bool> grouped(voxels.size());
  std::vector<ContourPoint> points;
  for (std::size_t first = 0; first < voxels.size(); ++first) {
    if (grouped[first]) continue;
    const ContourVoxel& seed = voxels[first];
    ContourPoint point;
    left.take_near(seed.voxel, [&](std::size_t i) {
      const ContourVoxel& other = voxels[i];
      const bool similar = i == first || (squared_distance_vox(seed.voxel, other.voxel) < distance_vox * distance_vox &&
                                          seed.normal.cast<double>().dot(other.normal.cast<double>()) > least_cosine);
      if (!similar) return false;
      grouped[i] = true;
      point.position_m += voxel_center(other.voxel, voxel_size_m);
      point.normal += other.normal.cast<double>();
      point.voxels += 1;
      return true;
    });
    point.position_m /= static_cast<double>(point.voxels);
    point.normal.normalize();
    points.push_back(point);
  }
  return points;
}

}  // namespace saccade
