// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/neighbourhood.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "saccade/cloud/nearest_places.hpp"
#include "saccade/core/statistics.hpp"

namespace saccade {
namespace {

constexpr std::size_t kNodeGrain{1024};
constexpr int kMaxNeighbours{64};
constexpr int kNormalRounds{2};
constexpr std::uint32_t kNoNode{std::numeric_limits<std::uint32_t>::max()};

bool is_weight(double value) { return std::isfinite(value) && value >= 0.0; }

/// Returns the squared distance: symmetric, and to the bit as in nearest_neighbours.
float squared_distance_m2(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f d = a - b;
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

/// Data that edges are computed from.
class Nodes {
 public:
  Nodes(const PointCloud& cloud, const NearestNeighbours& neighbours, const NeighbourhoodConfig& config,
        const Executor& executor)
      : neighbours_{neighbours},
        nodes_(neighbours.order.size(), neighbours.nodes.get_allocator()),
        units_per_m_{config.position_weight_per_m / config.max_path * kPathUnits},
        units_per_normal_{config.normal_weight / config.max_path * kPathUnits},
        units_per_color_{config.color_weight / config.max_path * kPathUnits},
        adapt_to_density_{config.adapt_to_density},
        normals_are_oriented_{!cloud.normals.empty()} {
    std::vector<Eigen::Vector3f> estimated;
    if (config.normal_weight > 0.0 && !normals_are_oriented_) {
      estimated = estimate_normals(neighbours, kNormalRounds, executor);
    }
    if (config.color_weight > 0.0 && !cloud.colors.empty()) colors_.resize(nodes_.size());
    executor.parallel_for(nodes_.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t point = neighbours.order[i];
        if (!colors_.empty()) colors_[i] = cloud.colors[point];
        nodes_[i].p_m = neighbours.positions_m[i];
        nodes_[i].reach_m2 =
            neighbours.count == 0
                ? 0.0F
                : squared_distance_m2(neighbours.positions_m[i], neighbours.positions_m[neighbours.of(i).back()]);
        nodes_[i].normal = with_length(!estimated.empty()      ? estimated[i]
                                       : normals_are_oriented_ ? cloud.normals[point]
                                                               : Eigen::Vector3f::Zero());
      }
    });
    if (adapt_to_density_ && !nodes_.empty()) median_spacing_m_ = median_spacing_m();
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Returns a mask: bit n is set when the node's neighbour n does not have it among its own.
  [[nodiscard]] std::uint64_t one_sided(std::uint32_t node) const {
    std::uint64_t bits{0};
    const std::span<const std::uint32_t> row = neighbours_.of(node);
    for (std::size_t n = 0; n < row.size(); ++n) {
      const Node& other = nodes_[row[n]];
      const float distance_m2 = squared_distance_m2(nodes_[node].p_m, other.p_m);
      bool is_one_sided = distance_m2 > other.reach_m2;
      if (distance_m2 == other.reach_m2) {  // one of several at this distance
        const std::span<const std::uint32_t> theirs = neighbours_.of(row[n]);
        is_one_sided = std::find(theirs.begin(), theirs.end(), node) == theirs.end();
      }
      bits |= std::uint64_t{is_one_sided ? 1U : 0U} << n;
    }
    return bits;
  }

  /// Returns the cost by eq. 4.17, in path units, at most kPathUnits.
  [[nodiscard]] std::uint32_t cost(std::uint32_t a, std::uint32_t b) const {
    return in_units(units_per_m_ * distance_m(a, b) + units_per_normal_ * normal_difference(a, b) +
                    units_per_color_ * color_difference(a, b));
  }

  /// Returns the cost between a node and a point at the same place, whose estimated normals are the same, too.
  [[nodiscard]] std::uint32_t cost_of_copy(std::uint32_t node, std::uint32_t copy, const PointCloud& cloud) const {
    double units{0.0};
    if (!colors_.empty()) units += units_per_color_ * static_cast<double>((colors_[node] - cloud.colors[copy]).norm());
    if (normals_are_oriented_) {
      const Eigen::Vector4f theirs = with_length(cloud.normals[copy]);
      const float dot = nodes_[node].normal.head<3>().dot(theirs.head<3>());
      units += units_per_normal_ * static_cast<double>(std::max(0.0F, nodes_[node].normal.w() * theirs.w() - dot));
    }
    return in_units(units);
  }

 private:
  static std::uint32_t in_units(double units) {
    return units < kPathUnits ? static_cast<std::uint32_t>(units + 0.5) : kPathUnits;
  }

  struct alignas(32) Node {
    Eigen::Vector3f p_m;
    float reach_m2;          ///< squared distance of its farthest neighbour
    Eigen::Vector4f normal;  ///< normal and its length: 1, or 0 where it is unknown
  };

  static Eigen::Vector4f with_length(const Eigen::Vector3f& normal) {
    const float length = normal.norm();
    if (!(length > 0.0F) || !std::isfinite(length)) return Eigen::Vector4f::Zero();
    return {normal.x() / length, normal.y() / length, normal.z() / length, 1.0F};
  }

  [[nodiscard]] double distance_m(std::uint32_t a, std::uint32_t b) const {
    const auto distance = static_cast<double>(std::sqrt(squared_distance_m2(nodes_[a].p_m, nodes_[b].p_m)));
    if (!adapt_to_density_) return distance;
    const auto local = static_cast<double>(std::sqrt(std::max(nodes_[a].reach_m2, nodes_[b].reach_m2)));
    return local > 0.0 ? distance / local * median_spacing_m_ : 0.0;
  }

  /// Returns 1 − n_a · n_b. Estimated normals have arbitrary signs, so the smaller of both values counts.
  [[nodiscard]] double normal_difference(std::uint32_t a, std::uint32_t b) const {
    const Eigen::Vector4f& n = nodes_[a].normal;
    const Eigen::Vector4f& m = nodes_[b].normal;
    const float dot = n.x() * m.x() + n.y() * m.y() + n.z() * m.z();
    return static_cast<double>(std::max(0.0F, n.w() * m.w() - (normals_are_oriented_ ? dot : std::abs(dot))));
  }

  [[nodiscard]] double color_difference(std::uint32_t a, std::uint32_t b) const {
    return colors_.empty() ? 0.0 : static_cast<double>((colors_[a] - colors_[b]).norm());
  }

  [[nodiscard]] double median_spacing_m() const {
    std::vector<float> reach_m2;
    for (const Node& node : nodes_) reach_m2.push_back(node.reach_m2);
    return static_cast<double>(std::sqrt(upper_median(reach_m2)));
  }

  const NearestNeighbours& neighbours_;
  DiskVector<Node> nodes_;
  std::vector<Eigen::Vector3f> colors_;
  double median_spacing_m_{0.0};
  double units_per_m_;
  double units_per_normal_;
  double units_per_color_;
  bool adapt_to_density_;
  bool normals_are_oriented_;
};

/// One bit per node and neighbour, as packed as they can be. Chunks of kNodeGrain nodes share no word.
class EdgeBits {
 public:
  EdgeBits(std::size_t nodes, std::size_t per_node)
      : per_node_{per_node}, words_(nodes * per_node / kWord + 2, std::uint64_t{0}) {}

  void set(std::size_t node, std::uint64_t bits) {
    const auto [word, shift] = place(node);
    words_[word] |= bits << shift;
    if (shift + per_node_ > kWord) words_[word + 1] |= bits >> (kWord - shift);
  }
  [[nodiscard]] std::uint64_t of(std::size_t node) const {
    const auto [word, shift] = place(node);
    std::uint64_t bits = words_[word] >> shift;
    if (shift + per_node_ > kWord) bits |= words_[word + 1] << (kWord - shift);
    return per_node_ == kWord ? bits : bits & ((std::uint64_t{1} << per_node_) - 1);
  }

 private:
  static constexpr std::size_t kWord{64};
  static_assert(kNodeGrain % kWord == 0);

  [[nodiscard]] std::pair<std::size_t, std::size_t> place(std::size_t node) const {
    return {node * per_node_ / kWord, node * per_node_ % kWord};
  }

  std::size_t per_node_;
  std::vector<std::uint64_t> words_;
};

struct Joined {
  std::vector<std::uint32_t> starts;
  DiskVector<Neighbourhood::Edge> edges;
};

/// Makes edges symmetric: a node's own nearest, then, in ascending order, the others that have it among theirs.
Joined join(const NearestNeighbours& neighbours, std::size_t points, const Nodes& nodes, const Executor& executor) {
  const std::size_t size = nodes.size();
  const std::size_t k = neighbours.count;
  std::vector<std::uint32_t> others(size, 0);
  EdgeBits one_sided{size, k};
  executor.parallel_for(size, kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (auto node = static_cast<std::uint32_t>(begin); node < end; ++node) {
      const std::uint64_t found = nodes.one_sided(node);
      one_sided.set(node, found);
      for (std::uint64_t bits = found; bits != 0; bits &= bits - 1) {
        const std::uint32_t other = neighbours.of(node)[static_cast<std::size_t>(std::countr_zero(bits))];
        std::atomic_ref{others[other]}.fetch_add(1, std::memory_order_relaxed);
      }
    }
  });
  Joined joined{{}, DiskVector<Neighbourhood::Edge>(neighbours.nodes.get_allocator())};
  joined.starts.resize(points + 1);
  for (std::size_t i = 0; i < size; ++i) {
    joined.starts[i + 1] = joined.starts[i] + static_cast<std::uint32_t>(k) + others[i];
  }
  for (std::size_t i = size; i < points; ++i) joined.starts[i + 1] = joined.starts[i];
  joined.edges.resize(joined.starts.back());
  executor.parallel_for(size, kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (auto node = static_cast<std::uint32_t>(begin); node < end; ++node) {
      Neighbourhood::Edge* edges = joined.edges.data() + joined.starts[node];
      const std::span<const std::uint32_t> nearest = neighbours.of(node);
      for (std::size_t n = 0; n < k; ++n) edges[n] = {nearest[n], nodes.cost(node, nearest[n])};
      for (std::uint64_t bits = one_sided.of(node); bits != 0; bits &= bits - 1) {
        const Neighbourhood::Edge& edge = edges[std::countr_zero(bits)];
        const std::uint32_t left = std::atomic_ref{others[edge.node]}.fetch_sub(1, std::memory_order_relaxed);
        joined.edges[joined.starts[edge.node] + k + left - 1] = {node, edge.cost};
      }
    }
  });
  executor.parallel_for(size, kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      std::sort(joined.edges.data() + joined.starts[node] + k, joined.edges.data() + joined.starts[node + 1],
                [](const Neighbourhood::Edge& a, const Neighbourhood::Edge& b) { return a.node < b.node; });
    }
  });
  return joined;
}

/// Joins each copy to the point that stands for its place.
void add_copies(std::span<const PointCopy> copies, std::span<const std::uint32_t> node_of, const Nodes& nodes,
                const PointCloud& cloud, Joined& joined) {
  std::vector<std::uint32_t> more(node_of.size(), 0);
  for (const PointCopy& copy : copies) {
    ++more[node_of[copy.point]];
    ++more[node_of[copy.original]];
  }
  std::vector<std::uint32_t> starts(joined.starts.size(), 0);
  for (std::size_t node = 0; node < more.size(); ++node) {
    starts[node + 1] = starts[node] + joined.starts[node + 1] - joined.starts[node] + more[node];
  }
  DiskVector<Neighbourhood::Edge> edges(joined.edges.get_allocator());
  edges.resize(starts.back());
  for (std::size_t node = 0; node < more.size(); ++node) {
    std::copy(joined.edges.begin() + joined.starts[node], joined.edges.begin() + joined.starts[node + 1],
              edges.begin() + starts[node]);
  }
  for (const PointCopy& copy : copies) {  // ascending by point, and so by node
    const std::uint32_t original = node_of[copy.original];
    const std::uint32_t node = node_of[copy.point];
    const std::uint32_t cost = nodes.cost_of_copy(original, copy.point, cloud);
    edges[starts[original + 1] - more[original]--] = {node, cost};
    edges[starts[node + 1] - more[node]--] = {original, cost};
  }
  joined.starts = std::move(starts);
  joined.edges = std::move(edges);
}

Error cancelled_build() { return {Errc::cancelled, "the neighbourhood graph was not finished", "neighbourhood"}; }

std::uint32_t median_of_sample(std::span<const Neighbourhood::Edge> edges) {
  constexpr std::size_t kSamples{10007};
  std::vector<std::uint32_t> costs;
  for (std::size_t i = 0; i < edges.size(); i += 1 + edges.size() / kSamples) costs.push_back(edges[i].cost);
  if (costs.empty()) return 1;
  return upper_median(costs);
}

/// Multiplies each cost by its ratio to the median, at most by kMostContrast: noise that a long path adds up then
/// counts little beside a border. A cost that is not 0 stays so.
void strengthen(std::span<Neighbourhood::Edge> edges, std::uint32_t median_cost, const Executor& executor) {
  constexpr double kMostContrast{10.0};
  constexpr double kBlocked{kPathUnits};
  constexpr std::size_t kEdgeGrain{16384};
  const double per_unit = 1.0 / std::max(1U, median_cost);
  executor.parallel_for(edges.size(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {  // without branches or divisions, as vectors
      const double cost = edges[i].cost;
      const double stronger = cost * std::min(cost * per_unit, kMostContrast);
      edges[i].cost = static_cast<std::uint32_t>(std::min(std::max(stronger, std::min(cost, 1.0)), kBlocked));
    }
  });
}

}  // namespace

Status NeighbourhoodConfig::validate() const {
  if (neighbours < 1 || neighbours > kMaxNeighbours) {
    return Error{Errc::invalid_argument, "a point has 1 to 64 neighbours, not " + std::to_string(neighbours),
                 "neighbourhood"};
  }
  if (!is_weight(position_weight_per_m) || !is_weight(normal_weight) || !is_weight(color_weight) ||
      position_weight_per_m + normal_weight + color_weight <= 0.0) {
    return Error{Errc::invalid_argument, "weights must be finite and not negative, and one of them positive",
                 "neighbourhood"};
  }
  if (!std::isfinite(max_path) || max_path <= 0.0) {
    return Error{Errc::invalid_argument, "the longest path must be positive", "neighbourhood"};
  }
  return {};
}

std::size_t Neighbourhood::building_bytes(std::size_t points, const NeighbourhoodConfig& config) {
  constexpr std::size_t kPerNeighbour{13};
  constexpr std::size_t kPerPoint{54};
  return points * (kPerNeighbour * static_cast<std::size_t>(config.neighbours) + kPerPoint);
}

Result<Neighbourhood> Neighbourhood::build(const PointCloud& cloud, const NeighbourhoodConfig& config,
                                           const Executor& executor, const Progress& progress,
                                           const std::shared_ptr<const DiskMemory>& disk) {
  constexpr std::size_t kStages{3};
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(cloud.validate());
  if (2 * cloud.positions_m.size() * static_cast<std::size_t>(config.neighbours) >
      std::numeric_limits<std::uint32_t>::max()) {
    return Error{Errc::invalid_argument, "points times neighbours may be 2³¹ at most; thin the cloud out or split it",
                 "neighbourhood"};
  }
  progress.report("graph", 0, kStages);
  const auto count = static_cast<std::size_t>(config.neighbours);
  NearestPlaces nearest = config.strong_borders
                              ? nearest_places(cloud.positions_m, count, executor, disk)
                              : NearestPlaces{nearest_neighbours(cloud.positions_m, count, executor, disk), {}};
  NearestNeighbours& neighbours = nearest.neighbours;
  if (progress.cancelled()) return cancelled_build();
  progress.report("graph", 1, kStages);
  const Nodes nodes{cloud, neighbours, config, executor};
  if (progress.cancelled()) return cancelled_build();
  progress.report("graph", 2, kStages);
  Neighbourhood graph;
  graph.config_ = config;
  const std::size_t size = cloud.positions_m.size();
  std::vector<Eigen::Vector3f>{}.swap(neighbours.positions_m);  // the nodes have them: memory is at its peak in join
  graph.point_of_ = std::move(neighbours.order);
  graph.node_of_.resize(size);
  if (graph.point_of_.size() < size) std::fill(graph.node_of_.begin(), graph.node_of_.end(), kNoNode);
  executor.parallel_for(nodes.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      graph.node_of_[graph.point_of_[node]] = static_cast<std::uint32_t>(node);
    }
  });
  if (graph.point_of_.size() < size) {
    for (std::uint32_t point = 0; point < size; ++point) {  // points without neighbours come last
      if (graph.node_of_[point] != kNoNode) continue;
      graph.node_of_[point] = static_cast<std::uint32_t>(graph.point_of_.size());
      graph.point_of_.push_back(point);
    }
  }
  Joined joined = join(neighbours, size, nodes, executor);
  if (!nearest.copies.empty()) add_copies(nearest.copies, graph.node_of_, nodes, cloud, joined);
  graph.starts_ = std::move(joined.starts);
  graph.edges_ = std::move(joined.edges);
  graph.median_cost_ = median_of_sample(graph.edges_);
  if (config.strong_borders) {
    strengthen(graph.edges_, graph.median_cost_, executor);
    graph.median_cost_ = median_of_sample(graph.edges_);
  }
  progress.report("graph", kStages, kStages);
  return graph;
}

}  // namespace saccade
