// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace saccade {

namespace {

constexpr std::size_t kCellsAtOnce{128};

/// Returns the steps to all cells that may hold a point nearer than two widths, sorted by the distance of their
/// middles.
std::vector<std::uint64_t> offsets_within_two() {
  constexpr int kSteps{2};
  std::vector<std::pair<int, std::array<int, 3>>> steps;
  for (int x = -kSteps; x <= kSteps; ++x) {
    for (int y = -kSteps; y <= kSteps; ++y) {
      for (int z = -kSteps; z <= kSteps; ++z) steps.push_back({x * x + y * y + z * z, {x, y, z}});
    }
  }
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::uint64_t> offsets;
  for (const auto& [squared, step] : steps) offsets.push_back(cell_offset(step[0], step[1], step[2]));
  return offsets;
}

}  // namespace

/// Labels by node, and the common label of each cell.
struct BoundaryFinder::Labelled {
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> of_cell;  ///< label of its first point
  std::vector<std::uint8_t> is_mixed;  ///< whether its points have several labels

  [[nodiscard]] bool all_have(std::size_t cell, std::uint32_t label) const {
    return is_mixed[cell] == 0 && of_cell[cell] == label;
  }
};

Result<BoundaryFinder> BoundaryFinder::create(std::span<const Eigen::Vector3f> positions_m,
                                              std::span<const std::uint32_t> points, double reach_m,
                                              const Executor& executor) {
  if (!(std::isfinite(reach_m) && reach_m > 0.0)) {
    return Error{Errc::invalid_argument, "the reach must be finite and positive", "boundary"};
  }
  SACCADE_TRY(PointCells cells, PointCells::create(positions_m, points, 0.5 * reach_m));
  BoundaryFinder made{std::move(cells)};
  made.reach_m_ = reach_m;
  for (const std::uint32_t point : made.cells_.points()) made.positions_m_.push_back(positions_m[point]);
  const std::vector<std::uint64_t> offsets = offsets_within_two();
  const std::size_t count = made.cells_.size();
  std::vector<std::vector<std::uint32_t>> found((count + kCellsAtOnce - 1) / kCellsAtOnce);
  made.around_starts_.assign(count + 1, 0);
  executor.parallel_for(count, kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& chunk = found[begin / kCellsAtOnce];
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::size_t before = chunk.size();
      for (const std::uint64_t offset : offsets) {
        const std::uint32_t other = made.cells_.find(made.cells_.key(cell) + offset);
        if (other != kUnlabelled) chunk.push_back(other);
      }
      made.around_starts_[cell + 1] = static_cast<std::uint32_t>(chunk.size() - before);
    }
  });
  for (std::size_t cell = 0; cell < count; ++cell) made.around_starts_[cell + 1] += made.around_starts_[cell];
  made.around_.reserve(made.around_starts_.back());
  for (const auto& chunk : found) made.around_.insert(made.around_.end(), chunk.begin(), chunk.end());
  return made;
}

std::uint32_t BoundaryFinder::nearest_other(const Labelled& labelled, std::size_t cell, std::uint32_t node) const {
  const Eigen::Vector3d p_m = positions_m_[node].cast<double>();
  const std::uint32_t own = labelled.labels[node];
  const double size_m = cells_.size_m();
  const double margin_m = 1e-6 * size_m;  // covers the rounding of positions to cells
  double least_m2 = reach_m_ * reach_m_;
  std::uint32_t nearest{kUnlabelled};
  for (std::uint32_t i = around_starts_[cell]; i < around_starts_[cell + 1]; ++i) {
    const std::uint32_t other = around_[i];
    if (labelled.all_have(other, own)) continue;
    const Eigen::Vector3d low_m = low_corner_m(cells_.key(other), size_m);
    const Eigen::Array3d gap_m =
        (low_m - p_m).array().max(p_m.array() - low_m.array() - size_m).max(margin_m) - margin_m;
    if (gap_m.matrix().squaredNorm() > least_m2) continue;
    for (std::uint32_t k = cells_.first_of(other); k < cells_.end_of(other); ++k) {
      if (labelled.labels[k] == own) continue;
      const double distance_m2 = (positions_m_[k].cast<double>() - p_m).squaredNorm();
      const bool is_first =
          distance_m2 == least_m2 && nearest != kUnlabelled && cells_.points()[k] < cells_.points()[nearest];
      if (!(distance_m2 < least_m2 || is_first)) continue;
      least_m2 = distance_m2;
      nearest = k;
    }
  }
  return nearest;
}

std::vector<std::uint32_t> BoundaryFinder::boundary(std::span<const std::uint32_t> labels,
                                                    const Executor& executor) const {
  const std::span<const std::uint32_t> points = cells_.points();
  const std::size_t count = cells_.size();
  Labelled labelled;
  labelled.labels.resize(points.size());
  labelled.of_cell.resize(count);
  labelled.is_mixed.resize(count);
  executor.parallel_for(count, kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::uint32_t first = labels[points[cells_.first_of(cell)]];
      labelled.of_cell[cell] = first;
      for (std::uint32_t node = cells_.first_of(cell); node < cells_.end_of(cell); ++node) {
        labelled.labels[node] = labels[points[node]];
        if (labelled.labels[node] != first) labelled.is_mixed[cell] = 1;
      }
    }
  });
  std::vector<std::uint32_t> nearest(points.size(), kUnlabelled);
  executor.parallel_for(count, kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::span around =
          std::span{around_}.subspan(around_starts_[cell], around_starts_[cell + 1] - around_starts_[cell]);
      const bool is_inside = std::all_of(around.begin(), around.end(), [&](std::uint32_t other) {
        return labelled.all_have(other, labelled.of_cell[cell]);
      });
      if (is_inside) continue;
      for (std::uint32_t node = cells_.first_of(cell); node < cells_.end_of(cell); ++node) {
        nearest[node] = nearest_other(labelled, cell, node);
      }
    }
  });
  std::vector<std::uint32_t> boundary;
  for (const std::uint32_t node : nearest) {
    if (node != kUnlabelled) boundary.push_back(points[node]);
  }
  std::sort(boundary.begin(), boundary.end());
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  return boundary;
}

}  // namespace saccade
