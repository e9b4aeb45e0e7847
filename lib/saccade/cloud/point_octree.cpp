// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/point_octree.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/cloud/internal/morton_order.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

using internal::MortonPoint;
using Node = PointOctree::Node;

constexpr unsigned kBits{internal::kMortonBits};
constexpr unsigned kFinestGrid{7};  // 2⁷ cells along an edge
constexpr unsigned kGrids{3};
static_assert(PointOctree::kMostLevels + kFinestGrid == kBits);

/// Node to be made of the points in a cube that no ancestor has taken.
struct Task {
  Node node;
  std::span<MortonPoint> left;
};

/// Node with its points, and the tasks of its children.
struct Made {
  Node node;
  std::vector<std::uint32_t> points;
  std::vector<Task> children;
};

/// Number of low bits of a code inside a cell of a node's grid.
unsigned shift_of(std::uint32_t level, unsigned grid_bits) { return 3 * (kBits - level - grid_bits); }

/// Returns the bits of the finest grid whose occupied cells fit into a node.
unsigned grid_bits_of(std::span<const MortonPoint> points, std::uint32_t level) {
  std::array<std::size_t, kGrids> occupied{};
  occupied.fill(1);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::uint64_t differ = points[i].code ^ points[i - 1].code;
    for (unsigned grid = 0; grid < kGrids; ++grid) {
      if (differ >> shift_of(level, kFinestGrid - grid) == 0) break;  // nor do coarser cells differ
      ++occupied[grid];
    }
  }
  unsigned grid{0};
  while (grid + 1 < kGrids && occupied[grid] > PointOctree::kMostNodePoints) ++grid;
  return kFinestGrid - grid;
}

/// Takes one point of each cell, the middle one along the curve, and closes the gaps. Returns the others.
std::span<MortonPoint> sample(std::span<MortonPoint> points, unsigned shift, std::vector<std::uint32_t>& taken) {
  std::size_t kept{0};
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    const std::uint64_t cell = points[begin].code >> shift;
    for (end = begin + 1; end < points.size() && points[end].code >> shift == cell;) ++end;
    const std::size_t middle = begin + (end - begin) / 2;
    taken.push_back(points[middle].point);
    for (std::size_t i = begin; i < end; ++i) {
      if (i != middle) points[kept++] = points[i];
    }
  }
  return points.first(kept);
}

/// Divides what is left of a node's points among the eight cubes inside its own.
void divide(const Node& node, std::span<MortonPoint> left, std::vector<Task>& children) {
  const unsigned shift = shift_of(node.level, 1);
  while (!left.empty()) {
    const std::uint64_t cell = left.front().code >> shift;
    const auto end = std::partition_point(left.begin(), left.end(),
                                          [&](const MortonPoint& point) { return point.code >> shift == cell; });
    const auto count = static_cast<std::size_t>(end - left.begin());
    Node child;
    child.level = node.level + 1;
    child.x = 2 * node.x + static_cast<std::uint32_t>(cell & 1U);
    child.y = 2 * node.y + static_cast<std::uint32_t>(cell >> 1U & 1U);
    child.z = 2 * node.z + static_cast<std::uint32_t>(cell >> 2U & 1U);
    children.push_back({child, left.first(count)});
    left = left.subspan(count);
  }
}

Made make(const Task& task, const PointOctreeConfig& config, double edge_m) {
  Made made{task.node, {}, {}};
  const bool deepest = task.node.level >= PointOctree::kMostLevels;
  if (task.left.size() <= config.leaf_points || deepest) {
    const std::size_t here = std::min(task.left.size(), PointOctree::kMostNodePoints);
    for (const MortonPoint& point : task.left.first(here)) made.points.push_back(point.point);
    if (here < task.left.size()) made.children.push_back({task.node, task.left.subspan(here)});
  } else {
    const unsigned bits = grid_bits_of(task.left, task.node.level);
    made.node.spacing_m = static_cast<float>(std::ldexp(edge_m, -static_cast<int>(task.node.level + bits)));
    divide(made.node, sample(task.left, shift_of(task.node.level, bits), made.points), made.children);
  }
  std::sort(made.points.begin(), made.points.end());
  made.node.count = static_cast<std::uint32_t>(made.points.size());
  return made;
}

}  // namespace

PointOctree::PointOctree(std::span<const Eigen::Vector3f> positions_m, const PointOctreeConfig& config,
                         const Executor& executor) {
  SACCADE_EXPECTS(config.leaf_points >= 1 && config.leaf_points <= kMostNodePoints);
  internal::MortonOrder sorted = internal::morton_order(positions_m, executor);
  origin_m_ = sorted.origin_m;
  edge_m_ = sorted.edge_m;
  order_.resize(sorted.points.size());
  std::uint32_t first{0};
  std::vector<Task> level;
  if (!sorted.points.empty()) level.push_back({Node{}, sorted.points});
  while (!level.empty()) {
    std::vector<Made> made(level.size());
    executor.parallel_for(level.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) made[i] = make(level[i], config, edge_m_);
    });
    level.clear();
    for (Made& one : made) {
      one.node.first = first;
      std::copy(one.points.begin(), one.points.end(), order_.begin() + first);
      first += one.node.count;
      const auto id = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(one.node);
      for (Task& child : one.children) {
        child.node.parent = id;
        level.push_back(child);
      }
    }
  }
}

std::vector<std::uint32_t> PointOctree::nodes_of_points(std::size_t points, const Executor& executor) const {
  std::vector<std::uint32_t> node_of(points, kNoNode);
  executor.parallel_for(nodes_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t id = begin; id < end; ++id) {
      for (const std::uint32_t point : this->points(nodes_[id])) node_of[point] = static_cast<std::uint32_t>(id);
    }
  });
  return node_of;
}

}  // namespace saccade
