// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/boundary_matching.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "saccade/segment/internal/boundary_sides.hpp"
#include "saccade/segment/internal/least_assignment.hpp"

namespace saccade {

Result<BoundarySide> BoundarySide::create(std::span<const Eigen::Vector3f> positions_m,
                                          std::span<const std::uint32_t> points, double reach_m) {
  SACCADE_TRY(PointCells cells, PointCells::create(positions_m, points, reach_m));
  BoundarySide side{std::move(cells), {}, {}, {}, {}};
  side.positions_m.reserve(points.size());
  for (const std::uint32_t point : side.cells.points()) side.positions_m.push_back(positions_m[point].cast<double>());
  side.cell_of.resize(points.size());
  for (std::uint32_t cell = 0; cell < side.cells.size(); ++cell) {
    for (std::uint32_t node = side.cells.first_of(cell); node < side.cells.end_of(cell); ++node) {
      side.cell_of[node] = cell;
    }
  }
  return side;
}

void BoundarySide::look_at(const BoundarySide& other) {
  around_starts.assign(1, 0);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const auto add = [&](std::uint64_t key) {
      const std::uint32_t found = other.cells.find(key);
      if (found != kUnlabelled) around.push_back(found);
    };
    add(cells.key(cell));
    for (const std::uint64_t offset : neighbour_offsets()) add(cells.key(cell) + offset);
    around_starts.push_back(static_cast<std::uint32_t>(around.size()));
  }
}

namespace {

/// Pairs by node; kUnlabelled where a node is unpaired.
class Pairs {
 public:
  Pairs(const BoundarySide& a, const BoundarySide& b, double reach_m)
      : a_{a},
        b_{b},
        reach_m2_{reach_m * reach_m},
        of_a_(a.size(), kUnlabelled),
        of_b_(b.size(), kUnlabelled),
        left_(b.size()),
        steps_a_(a.size()),
        steps_b_(b.size()) {}

  void set(std::uint32_t a, std::uint32_t b) {
    of_a_[a] = b;
    of_b_[b] = a;
  }
  void clear(std::uint32_t a, std::uint32_t b) {
    of_a_[a] = kUnlabelled;
    of_b_[b] = kUnlabelled;
  }
  [[nodiscard]] std::uint32_t of_a(std::uint32_t a) const { return of_a_[a]; }

  /// Pairs the nearest unpaired points within reach, until there is none.
  void make_nearest_first() {
    using Candidate = std::tuple<double, std::uint32_t, std::uint32_t>;  // squared distance, of a, of b
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
    const auto look = [&](std::uint32_t a) {
      Candidate nearest{reach_m2_, a, kUnlabelled};
      NearNodes near{a_, b_, a};
      for (std::uint32_t b = next(near); b != kUnlabelled; b = next(near)) {
        nearest = std::min(nearest, Candidate{(b_.positions_m[b] - a_.positions_m[a]).squaredNorm(), a, b});
      }
      if (std::get<2>(nearest) != kUnlabelled) candidates.push(nearest);
    };
    for (std::uint32_t a = 0; a < a_.size(); ++a) look(a);
    while (!candidates.empty()) {
      const auto [distance_m2, a, b] = candidates.top();
      candidates.pop();
      if (of_b_[b] == kUnlabelled) {
        set(a, b);
        left_.take(b);
      } else {
        look(a);
      }
    }
  }

  /// Maximises the number of pairs (Hopcroft and Karp): augments along shortest paths from unpaired nodes, many
  /// disjoint paths at once.
  void make_as_many_as_can_be() {
    while (find_shortest_ways()) {
      left_.reset();
      for (std::uint32_t a = 0; a < a_.size(); ++a) {
        if (of_a_[a] == kUnlabelled) change_along_way_from(a);
      }
    }
  }

 private:
  [[nodiscard]] std::uint32_t next(NearNodes& near) { return near.next(a_, b_, left_, reach_m2_); }

  /// Finds the number of steps from the unpaired nodes of a, up to the nearest unpaired node of b.
  [[nodiscard]] bool find_shortest_ways() {
    left_.reset();
    std::fill(steps_b_.begin(), steps_b_.end(), kUnlabelled);
    std::vector<std::uint32_t> front;
    for (std::uint32_t a = 0; a < a_.size(); ++a) {
      if (of_a_[a] == kUnlabelled) front.push_back(a);
    }
    bool found{false};
    for (std::uint32_t steps = 0; !front.empty() && !found; ++steps) {
      std::vector<std::uint32_t> after;
      for (const std::uint32_t a : front) {
        steps_a_[a] = steps;
        NearNodes near{a_, b_, a};
        for (std::uint32_t b = next(near); b != kUnlabelled; b = next(near)) {
          left_.take(b);
          steps_b_[b] = steps;
          if (of_b_[b] == kUnlabelled) {
            found = true;
          } else {
            after.push_back(of_b_[b]);
          }
        }
      }
      front.swap(after);
    }
    return found;
  }

  void change_along_way_from(std::uint32_t alone) {
    way_.clear();
    way_.push_back({{a_, b_, alone}, kUnlabelled});
    steps_a_[alone] = 0;
    while (!way_.empty()) {
      Step& last = way_.back();
      std::uint32_t b = next(last.near);
      while (b != kUnlabelled && steps_b_[b] != steps_a_[last.near.node()]) b = next(last.near);
      if (b == kUnlabelled) {
        way_.pop_back();
        continue;
      }
      left_.take(b);
      last.b = b;
      if (of_b_[b] == kUnlabelled) {
        for (const Step& step : way_) set(step.near.node(), step.b);
        return;
      }
      steps_a_[of_b_[b]] = steps_b_[b] + 1;
      way_.push_back({{a_, b_, of_b_[b]}, kUnlabelled});
    }
  }

  struct Step {
    NearNodes near;
    std::uint32_t b;
  };
  const BoundarySide& a_;
  const BoundarySide& b_;
  double reach_m2_;
  std::vector<std::uint32_t> of_a_, of_b_;
  PointsLeft left_;
  std::vector<std::uint32_t> steps_a_, steps_b_;
  std::vector<Step> way_;
};

struct Cluster {
  std::vector<std::uint32_t> a, b;  ///< nodes
};

/// Calls body with each cluster that has nodes of both sides.
template <class Body>
void for_each_cluster(const BoundarySide& a, const BoundarySide& b, double reach_m2, const Body& body) {
  PointsLeft left_of_a{a.size()};
  PointsLeft left_of_b{b.size()};
  const auto gather = [&](const BoundarySide& side, const BoundarySide& other, std::uint32_t node, PointsLeft& left,
                          std::vector<std::uint32_t>& into) {
    NearNodes near{side, other, node};
    for (std::uint32_t k = near.next(side, other, left, reach_m2); k != kUnlabelled;
         k = near.next(side, other, left, reach_m2)) {
      left.take(k);
      into.push_back(k);
    }
  };
  Cluster cluster;
  for (std::uint32_t first = left_of_a.from(0); first < a.size(); first = left_of_a.from(first)) {
    left_of_a.take(first);
    cluster.a.assign(1, first);
    cluster.b.clear();
    for (std::size_t i = 0, k = 0; i < cluster.a.size() || k < cluster.b.size();) {
      if (i < cluster.a.size()) {
        gather(a, b, cluster.a[i++], left_of_b, cluster.b);
      } else {
        gather(b, a, cluster.b[k++], left_of_a, cluster.a);
      }
    }
    if (!cluster.b.empty()) body(cluster);
  }
}

/// Pairs a cluster anew: as many pairs as possible, of these the nearest.
void assign(const BoundarySide& a, const BoundarySide& b, double reach_m, const Cluster& cluster, Pairs& pairs) {
  for (const std::uint32_t node : cluster.a) {
    if (pairs.of_a(node) != kUnlabelled) pairs.clear(node, pairs.of_a(node));
  }
  const bool is_turned = cluster.a.size() > cluster.b.size();
  const std::vector<std::uint32_t>& rows = is_turned ? cluster.b : cluster.a;
  const std::vector<std::uint32_t>& columns = is_turned ? cluster.a : cluster.b;
  const BoundarySide& side = is_turned ? b : a;
  const BoundarySide& other = is_turned ? a : b;
  const auto too_far = static_cast<double>(rows.size() + 1);  // costs more than all others together
  Eigen::MatrixXd costs(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double distance_m2 = (side.positions_m[rows[i]] - other.positions_m[columns[k]]).squaredNorm();
      costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          distance_m2 <= reach_m * reach_m ? std::sqrt(distance_m2) / reach_m : too_far;
    }
  }
  const std::vector<std::size_t> column_of = least_assignment(costs);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (costs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(column_of[i])) >= too_far) continue;
    const std::uint32_t row = rows[i];
    const std::uint32_t column = columns[column_of[i]];
    pairs.set(is_turned ? column : row, is_turned ? row : column);
  }
}

}  // namespace

Status BoundaryMatchingConfig::validate() const {
  constexpr std::size_t kMostExact{4096};
  if (!(std::isfinite(tolerance_m) && tolerance_m > 0.0)) {
    return Error{Errc::invalid_argument, "the tolerance must be finite and positive", "boundary matching"};
  }
  if (exact_cluster > kMostExact) {
    return Error{Errc::invalid_argument, "exact clusters of more than 4096 points take too long", "boundary matching"};
  }
  return {};
}

Result<BoundaryMatching> match_boundaries(std::span<const Eigen::Vector3f> positions_m,
                                          std::span<const std::uint32_t> a, std::span<const std::uint32_t> b,
                                          const BoundaryMatchingConfig& config) {
  SACCADE_CHECK(config.validate());
  if (a.size() > b.size()) {  // paths are searched from a, so a should be the smaller side
    SACCADE_TRY(BoundaryMatching matching, match_boundaries(positions_m, b, a, config));
    for (auto& [first, second] : matching.pairs) std::swap(first, second);
    std::sort(matching.pairs.begin(), matching.pairs.end());
    return matching;
  }
  const double reach_m = config.tolerance_m;
  SACCADE_TRY(BoundarySide side_a, BoundarySide::create(positions_m, a, reach_m));
  SACCADE_TRY(BoundarySide side_b, BoundarySide::create(positions_m, b, reach_m));
  side_a.look_at(side_b);
  side_b.look_at(side_a);
  Pairs pairs{side_a, side_b, reach_m};
  pairs.make_nearest_first();
  pairs.make_as_many_as_can_be();
  BoundaryMatching matching;
  for_each_cluster(side_a, side_b, reach_m * reach_m, [&](const Cluster& cluster) {
    matching.clusters += 1;
    if (cluster.a.size() + cluster.b.size() > config.exact_cluster) return;
    matching.exact_clusters += 1;
    assign(side_a, side_b, reach_m, cluster, pairs);
  });
  for (std::uint32_t node = 0; node < side_a.size(); ++node) {
    const std::uint32_t other = pairs.of_a(node);
    if (other != kUnlabelled) matching.pairs.emplace_back(side_a.point(node), side_b.point(other));
  }
  std::sort(matching.pairs.begin(), matching.pairs.end());
  for (const auto& [first, second] : matching.pairs) {
    matching.distance_m += (positions_m[first].cast<double>() - positions_m[second].cast<double>()).norm();
  }
  return matching;
}

}  // namespace saccade
