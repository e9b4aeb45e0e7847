// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/segmented_points.hpp"

#include <limits>
#include <numeric>

#include "saccade/cloud/cell_index.hpp"

namespace saccade {
namespace {

/// Indices of the points cell by cell, in order within each.
class PointsByCell {
 public:
  PointsByCell(std::span<const Eigen::Vector3f> positions_m, double edge_m) : edge_m_{edge_m} {
    std::vector<std::uint32_t> cell_of(positions_m.size(), kUnlabelled);
    for (std::size_t i = 0; i < positions_m.size(); ++i) {
      const std::uint64_t cell = cell_at(positions_m[i], edge_m_);
      if (cell == kFarCell) {
        far_.push_back(static_cast<std::uint32_t>(i));
        continue;
      }
      cell_of[i] = cells_.insert(cell);
    }
    starts_.assign(cells_.cells().size() + 1, 0);
    for (const std::uint32_t cell : cell_of) {
      if (cell != kUnlabelled) ++starts_[cell + 1];
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    points_.resize(starts_.back());
    std::vector<std::uint32_t> next{starts_.begin(), starts_.end() - 1};
    for (std::size_t i = 0; i < cell_of.size(); ++i) {
      if (cell_of[i] != kUnlabelled) points_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Visits all points within an edge length of the place, and some beyond; returns false where that is impossible.
  template <class Body>
  bool for_each_around(const Eigen::Vector3d& place_m, const Body& body) const {
    const std::uint64_t center = cell_at(place_m.cast<float>(), edge_m_);
    if (center == kFarCell || !far_.empty()) return false;
    visit(center, body);
    for (const std::uint64_t offset : neighbour_offsets()) visit(center + offset, body);
    return true;
  }

 private:
  template <class Body>
  void visit(std::uint64_t cell, const Body& body) const {
    const std::uint32_t number = cells_.find(cell);
    if (number == kUnlabelled) return;
    for (std::uint32_t i = starts_[number]; i < starts_[number + 1]; ++i) body(points_[i]);
  }

  double edge_m_;
  CellIndex cells_;
  std::vector<std::uint32_t> starts_;  ///< start of each cell, then the end
  std::vector<std::uint32_t> points_;
  std::vector<std::uint32_t> far_;  ///< beyond the index
};

}  // namespace

std::vector<std::uint32_t> nearest_segments(const SegmentedPoints& points, std::span<const Eigen::Vector3d> places_m,
                                            const Executor& executor) {
  constexpr double kMore{1.0 + 1e-4};  // for rounding
  constexpr std::size_t kGrain{64};
  const std::span<const Eigen::Vector3f> positions_m = points.positions_m();
  const PointsByCell cells{positions_m, kMore * kNearSurface_m};
  const auto nearest_of = [&](const Eigen::Vector3d& place_m) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = positions_m.size();
    const auto consider = [&](std::size_t i) {
      const double squared = (positions_m[i].cast<double>() - place_m).squaredNorm();
      if (squared < least || (squared == least && i < nearest)) {
        least = squared;
        nearest = i;
      }
    };
    if (!cells.for_each_around(place_m, consider) || least > kNearSurface_m * kNearSurface_m) {
      for (std::size_t i = 0; i < positions_m.size(); ++i) consider(i);
    }
    if (nearest == positions_m.size()) return kUnlabelled;
    const std::uint32_t segment = points.segment_of()[nearest];
    return segment < points.segments() ? segment : kUnlabelled;
  };
  std::vector<std::uint32_t> segments(places_m.size());
  executor.parallel_for(places_m.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) segments[i] = nearest_of(places_m[i]);
  });
  return segments;
}

}  // namespace saccade
