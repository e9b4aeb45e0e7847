// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/cell_index.hpp"

#include <sstream>
#include <string>

namespace saccade {

Result<PointCells> PointCells::create(std::span<const Eigen::Vector3f> positions_m,
                                      std::span<const std::uint32_t> points, double size_m) {
  PointCells made;
  made.size_m_ = size_m;
  made.starts_.assign(1, 0);
  std::vector<std::uint32_t> cells(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t key = cell_at(positions_m[points[i]], size_m);
    if (key == kFarCell) {
      std::ostringstream what;
      what << "a point farther than a million cells of " << size_m << " m";
      return Error{Errc::invalid_argument, what.str(), "point " + std::to_string(points[i])};
    }
    cells[i] = made.index_.insert(key);
    if (cells[i] + 2 > made.starts_.size()) made.starts_.push_back(0);
    made.starts_[cells[i] + 1] += 1;
  }
  for (std::size_t cell = 1; cell < made.starts_.size(); ++cell) made.starts_[cell] += made.starts_[cell - 1];
  std::vector<std::uint32_t> next{made.starts_.begin(), made.starts_.end() - 1};
  made.points_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) made.points_[next[cells[i]]++] = points[i];
  return made;
}

Eigen::Vector3d low_corner_m(std::uint64_t key, double size_m) {
  constexpr std::uint64_t kMask{(std::uint64_t{1} << kCellBits) - 1};
  constexpr double kHalf{static_cast<double>(1 << (kCellBits - 1))};
  const auto along = [&](int axis) {
    return (static_cast<double>((key >> (kCellBits * (2 - axis))) & kMask) - kHalf) * size_m;
  };
  return {along(0), along(1), along(2)};
}

std::vector<std::uint32_t> finite_points(std::span<const Eigen::Vector3f> positions_m) {
  std::vector<std::uint32_t> points;
  points.reserve(positions_m.size());
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    if (positions_m[i].allFinite()) points.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

}  // namespace saccade
