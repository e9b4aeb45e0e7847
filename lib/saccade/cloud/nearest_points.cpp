// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_points.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "saccade/cloud/internal/leaf_tree.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr std::size_t kQueryGrain{1024};
constexpr float kFarthestPlace_m{1e18F};  // squares of larger numbers are infinite
constexpr float kInfinity{std::numeric_limits<float>::infinity()};

bool is_place(const Eigen::Vector3f& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthestPlace_m; }

/// Search for the nearest site of one place, nearer boxes first.
struct NearestSite {
  const LeafTree& tree;
  Eigen::Vector3f place_m;
  float squared_m2;  ///< distance of the nearest site so far, or the limit
  std::uint32_t point{kNoNearPoint};

  void look_at(std::size_t leaf) {
    for (std::size_t i = tree.first_of(leaf); i < tree.end_of(leaf); ++i) {
      const LeafTree::IndexedPoint& site = tree.sites()[i];
      const float away_m2 = squared_length(site.p_m() - place_m);
      const bool is_nearer = away_m2 < squared_m2 || (away_m2 == squared_m2 && site.point() < point);
      if (is_nearer) {
        squared_m2 = away_m2;
        point = site.point();
      }
    }
  }

  void descend(std::size_t level, std::size_t group) {
    const LeafTree::Boxes& boxes = tree.levels()[level][group];
    std::array<std::pair<float, std::size_t>, LeafTree::kWidth> children;
    for (std::size_t i = 0; i < children.size(); ++i) children[i] = {squared_gap(boxes, i), i};
    std::sort(children.begin(), children.end());
    for (const auto& [gap_m2, child] : children) {
      if (!(gap_m2 <= squared_m2) || gap_m2 == kInfinity) return;
      const std::size_t below = group * LeafTree::kWidth + child;
      level == 0 ? look_at(below) : descend(level - 1, below);
    }
  }

 private:
  static float squared_length(const Eigen::Vector3f& d) { return d.x() * d.x() + d.y() * d.y() + d.z() * d.z(); }
  /// Never more than the squared distance to a site in the box: each side is rounded as its difference is.
  [[nodiscard]] float squared_gap(const LeafTree::Boxes& boxes, std::size_t child) const {
    Eigen::Vector3f gap_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float at = place_m[static_cast<Eigen::Index>(axis)];
      const float gap = std::max(boxes.low_m[axis][child] - at, at - boxes.high_m[axis][child]);
      gap_m[static_cast<Eigen::Index>(axis)] = std::max(gap, 0.0F);
    }
    return squared_length(gap_m);
  }
};

}  // namespace

std::vector<std::uint32_t> nearest_points(std::span<const Eigen::Vector3f> from_m,
                                          std::span<const Eigen::Vector3f> to_m, float within_m,
                                          const Executor& executor) {
  SACCADE_EXPECTS(to_m.size() < kNoNearPoint && within_m >= 0.0F);
  std::vector<std::uint32_t> nearest(from_m.size(), kNoNearPoint);
  UninitializedVector<LeafTree::IndexedPoint> sites;
  for (std::size_t i = 0; i < to_m.size(); ++i) {
    if (is_place(to_m[i])) sites.emplace_back(to_m[i], static_cast<std::uint32_t>(i));
  }
  if (sites.empty()) return nearest;
  const LeafTree tree{std::move(sites), executor};
  const std::size_t top = tree.levels().size() - 1;
  executor.parallel_for(from_m.size(), kQueryGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_place(from_m[i])) continue;
      NearestSite search{tree, from_m[i], within_m * within_m};
      search.descend(top, 0);
      nearest[i] = search.point;
    }
  });
  return nearest;
}

}  // namespace saccade
