// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/find_supports.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/convex_hull.hpp"

namespace saccade {
namespace {

/// Columns whose voxel of a layer is occupied and has an empty one above, layer by layer.
std::vector<std::vector<std::uint32_t>> tops_of(const StateVolume& volume) {
  const auto layer = static_cast<std::size_t>(volume.layer());
  const auto layers = static_cast<std::size_t>(volume.box().size().z);
  std::vector<std::vector<std::uint32_t>> tops(layers);
  for (std::size_t z = 0; z + 1 < layers; ++z) {
    for (std::size_t column = 0; column < layer; ++column) {
      const std::size_t i = z * layer + column;
      if (volume[i] == VoxelState::occupied && volume[i + layer] == VoxelState::empty) {
        tops[z].push_back(static_cast<std::uint32_t>(column));
      }
    }
  }
  return tops;
}

}  // namespace

std::vector<std::uint32_t> hull_columns(std::span<const std::uint32_t> seen, std::int32_t width) {
  const auto columns_per_row = static_cast<std::uint32_t>(width);
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t column : seen) {
    const std::uint32_t row = column / columns_per_row;
    points.emplace_back(static_cast<double>(column % columns_per_row), static_cast<double>(row));
  }
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
  if (hull.size() < 3) return {seen.begin(), seen.end()};
  std::vector<std::uint32_t> columns;
  const auto [low, high] =
      std::minmax_element(hull.begin(), hull.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  for (double y = low->y(); y <= high->y(); y += 1.0) {
    double begin = width;
    double end = -1.0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) continue;
      const bool level = a.y() == b.y();  // then b is a corner of the next edge, too
      const double x = level ? a.x() : a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      begin = std::min(begin, x);
      end = std::max(end, x);
    }
    constexpr double kSlack{1e-9};  // corners lie in their own row
    const auto first = static_cast<std::uint32_t>(y) * columns_per_row;
    for (double x = std::ceil(begin - kSlack); x <= end + kSlack; x += 1.0) {
      columns.push_back(first + static_cast<std::uint32_t>(x));
    }
  }
  return columns;
}

std::vector<Support> find_supports(const StateVolume& volume, double min_area_m2) {
  std::vector<Support> supports;
  std::vector<std::vector<std::uint32_t>> tops = tops_of(volume);
  const double voxel_m = volume.voxel_size_m();
  const auto least = static_cast<std::size_t>(std::ceil(min_area_m2 / (voxel_m * voxel_m)));
  const auto near = [&](std::size_t z) {
    return std::pair{z == 0 ? std::size_t{0} : z - 1, std::min(z + 2, tops.size())};
  };
  for (;;) {
    std::size_t best = 0;
    std::size_t most = 0;
    for (std::size_t z = 0; z < tops.size(); ++z) {
      std::size_t count = 0;
      for (auto [i, end] = near(z); i < end; ++i) count += tops[i].size();
      if (count > most || (count == most && tops[z].size() > tops[best].size())) {
        most = count;
        best = z;
      }
    }
    if (most == 0 || most < least) return supports;
    std::vector<std::uint32_t> seen;
    double sum = 0.0;
    for (auto [i, end] = near(best); i < end; ++i) {
      sum += static_cast<double>(i) * static_cast<double>(tops[i].size());
      seen.insert(seen.end(), tops[i].begin(), tops[i].end());
      tops[i].clear();
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    Support& support = supports.emplace_back();
    const double z = sum / static_cast<double>(most);
    support.top = volume.box().lo.z + static_cast<std::int32_t>(best) + 1;
    support.height_m = (volume.box().lo.z + z + 1.0) * voxel_m;
    support.area_m2 = static_cast<double>(seen.size()) * voxel_m * voxel_m;
    support.columns.assign(static_cast<std::size_t>(volume.layer()), 0);
    for (const std::uint32_t column : hull_columns(seen, static_cast<std::int32_t>(volume.row()))) {
      support.columns[column] = 1;
    }
  }
}

}  // namespace saccade
