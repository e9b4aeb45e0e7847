// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/find_supports.hpp"

#include <algorithm>
#include <array>
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

void fill_hull(std::span<const std::uint32_t> seen, std::int32_t width, std::span<std::uint8_t> columns) {
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t column : seen) {
    columns[column] = 1;
    const std::uint32_t row = column / static_cast<std::uint32_t>(width);
    points.emplace_back(static_cast<double>(column % static_cast<std::uint32_t>(width)), static_cast<double>(row));
  }
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
  if (hull.size() < 3) return;
  const auto [low, high] =
      std::minmax_element(hull.begin(), hull.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  for (double y = low->y(); y <= high->y(); y += 1.0) {
    double begin = width;
    double end = -1.0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) continue;
      for (const double share :
           a.y() == b.y() ? std::array{0.0, 1.0} : std::array{(y - a.y()) / (b.y() - a.y()), -1.0}) {
        if (share < 0.0) continue;
        const double x = a.x() + share * (b.x() - a.x());
        begin = std::min(begin, x);
        end = std::max(end, x);
      }
    }
    constexpr double kSlack{1e-9};  // corners lie in their own row
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (double x = std::ceil(begin - kSlack); x <= end + kSlack; x += 1.0)
      columns[row + static_cast<std::size_t>(x)] = 1;
  }
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
    fill_hull(seen, static_cast<std::int32_t>(volume.row()), support.columns);
  }
}

}  // namespace saccade
