// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/internal/isolation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "saccade/cloud/cell_index.hpp"

namespace saccade {

namespace {

constexpr std::size_t kPlaceGrain{8192};
constexpr std::size_t kCellGrain{512};
constexpr std::size_t kQueryGrain{1024};
constexpr std::uint32_t kMixed{kUnlabelled};  // more than one segment

struct Member {
  Eigen::Vector3f p_m;
  std::uint32_t segment;
  std::uint32_t point;  ///< index among all
};

/// Points of several segments in nested boxes.
class SegmentTree {
 public:
  explicit SegmentTree(std::vector<Member> members) : members_{std::move(members)} {
    nodes_.reserve(members_.size() / 4 + 1);
    if (!members_.empty()) build(0, static_cast<std::uint32_t>(members_.size()));
  }

  [[nodiscard]] const std::vector<Member>& members() const { return members_; }

  /// Tells whether a point of another segment lies within the distance. The boxes' bounds are rounded as the distances
  /// are, so the answer equals that of testing all points.
  [[nodiscard]] bool has_foreign(const Member& of, double squared_distance) const {
    const Eigen::Vector3d p = of.p_m.cast<double>();
    std::array<std::uint32_t, kMostDepth> open;  // NOLINT(*-member-init): filled as it is used
    std::size_t count{0};
    open[count++] = 0;
    while (count > 0) {
      const std::uint32_t at = open[--count];
      const Node& node = nodes_[at];
      if (node.segment == of.segment) continue;
      const Eigen::Array3d below = node.low.cast<double>().array() - p.array();
      const Eigen::Array3d above = p.array() - node.high.cast<double>().array();
      const Eigen::Vector3d nearest = below.max(above).max(0.0).matrix();
      if (nearest.squaredNorm() > squared_distance) continue;
      const Eigen::Vector3d farthest = below.abs().max(above.abs()).matrix();
      if (farthest.squaredNorm() <= squared_distance) return true;
      if (node.right != 0) {
        open[count++] = node.right;
        open[count++] = at + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.last; ++i) {
        if (members_[i].segment == of.segment) continue;
        if ((members_[i].p_m.cast<double>() - p).squaredNorm() <= squared_distance) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kLeaf{8};
  static constexpr std::size_t kMostDepth{64};  // a node's points are half its parent's

  struct Node {
    Eigen::Vector3f low, high;
    std::uint32_t first, last;  ///< range of its members
    std::uint32_t segment;      ///< segment of all of them, or kMixed
    std::uint32_t right;        ///< its second child; the first follows it; 0: a leaf
  };

  void build(std::uint32_t first, std::uint32_t last) {
    const std::size_t at = nodes_.size();
    const Member& one = members_[first];
    Node node{one.p_m, one.p_m, first, last, one.segment, 0};
    for (std::uint32_t i = first + 1; i < last; ++i) {
      node.low = node.low.cwiseMin(members_[i].p_m);
      node.high = node.high.cwiseMax(members_[i].p_m);
      if (members_[i].segment != node.segment) node.segment = kMixed;
    }
    nodes_.push_back(node);
    if (last - first <= kLeaf) return;
    Eigen::Index axis{0};
    (node.high - node.low).maxCoeff(&axis);
    const std::uint32_t middle = first + (last - first) / 2;
    const auto begin = members_.begin();
    std::nth_element(begin + first, begin + middle, begin + last, [axis](const Member& a, const Member& b) {
      return a.p_m[axis] < b.p_m[axis] || (a.p_m[axis] == b.p_m[axis] && a.point < b.point);
    });
    build(first, middle);
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(middle, last);
  }

  std::vector<Member> members_;
  std::vector<Node> nodes_;
};

/// Points in cells slightly longer than the distance: all points within it of a point are in its cell or in a
/// neighbouring one.
class Cells {
 public:
  Cells(const SegmentedPoints& points, double distance_m, const Executor& executor) {
    constexpr double kMore{1.0 + 1e-6};  // for rounding
    const std::span<const Eigen::Vector3f> positions_m = points.positions_m();
    std::vector<std::uint64_t> cells(positions_m.size());
    executor.parallel_for(cells.size(), kPlaceGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) cells[i] = cell_at(positions_m[i], kMore * distance_m);
    });
    cell_of_.resize(cells.size(), kUnlabelled);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i] == kFarCell) continue;
      const bool again = i > 0 && cells[i] == cells[i - 1];
      const std::uint32_t cell = cell_of_[i] = again ? cell_of_[i - 1] : index_.insert(cells[i]);
      const std::uint32_t segment = points.segment_of()[i];
      if (cell == segments_.size()) segments_.push_back(segment);
      if (segments_[cell] != segment) segments_[cell] = kMixed;
    }
  }

  /// Returns the points with another segment in their cell or a neighbouring one; points beyond the index count as
  /// such.
  [[nodiscard]] std::vector<Member> points_near_others(const SegmentedPoints& points, const Executor& executor) const {
    std::vector<std::uint8_t> is_near(segments_.size(), 0);
    executor.parallel_for(is_near.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell) is_near[cell] = meets_others(cell) ? 1 : 0;
    });
    std::vector<Member> near;
    for (std::size_t i = 0; i < cell_of_.size(); ++i) {
      if (cell_of_[i] != kUnlabelled && is_near[cell_of_[i]] == 0) continue;
      near.push_back({points.positions_m()[i], points.segment_of()[i], static_cast<std::uint32_t>(i)});
    }
    return near;
  }

 private:
  [[nodiscard]] bool meets_others(std::size_t cell) const {
    if (segments_[cell] == kMixed) return true;
    const auto& offsets = neighbour_offsets();
    return std::any_of(offsets.begin(), offsets.end(), [&](std::uint64_t offset) {
      const std::uint32_t other = index_.find(index_.cells()[cell] + offset);
      return other != kUnlabelled && segments_[other] != segments_[cell];
    });
  }

  CellIndex index_;
  std::vector<std::uint32_t> cell_of_;   ///< per point; kUnlabelled: beyond the index
  std::vector<std::uint32_t> segments_;  ///< per cell, or kMixed
};

}  // namespace

std::vector<std::uint8_t> isolated_points(const SegmentedPoints& points, double distance_m, const Executor& executor) {
  SACCADE_EXPECTS(distance_m > 0.0);
  const SegmentTree tree{Cells{points, distance_m, executor}.points_near_others(points, executor)};
  std::vector<std::uint8_t> isolated(points.positions_m().size(), 1);
  executor.parallel_for(tree.members().size(), kQueryGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Member& member = tree.members()[i];
      isolated[member.point] = tree.has_foreign(member, distance_m * distance_m) ? 0 : 1;
    }
  });
  return isolated;
}

}  // namespace saccade
