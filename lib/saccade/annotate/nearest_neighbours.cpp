// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/nearest_neighbours.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr std::size_t kLeaf{8};  // points
constexpr std::size_t kMostNeighbours{64};
constexpr std::size_t kSplitAlone{4096};  // leaves of a range that one thread splits to its end
constexpr std::size_t kLeafGrain{64};
constexpr float kFar{std::numeric_limits<float>::infinity()};
constexpr float kFarthest_m{1e18F};  // beyond it squares are infinite

struct Site {
  Eigen::Vector3f p;
  std::uint32_t point;
};

struct Bounds {
  Eigen::Array3f low{Eigen::Array3f::Constant(kFar)};
  Eigen::Array3f high{Eigen::Array3f::Constant(-kFar)};

  void add(const Eigen::Vector3f& p) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  void add(const Bounds& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  [[nodiscard]] float squared_distance(const Bounds& other) const {
    return (low - other.high).max(other.low - high).max(0.0F).square().sum();
  }
  [[nodiscard]] float squared_distance(const Eigen::Vector3f& p) const {
    return (low - p.array()).max(p.array() - high).max(0.0F).square().sum();
  }
};

/// Leaves [first, end); its halves are 2 i + 1 and 2 i + 2.
struct Range {
  std::size_t index;
  std::size_t first;
  std::size_t end;

  [[nodiscard]] bool is_leaf() const { return end - first == 1; }
  [[nodiscard]] std::size_t middle() const { return first + (end - first + 1) / 2; }
  [[nodiscard]] Range left() const { return {2 * index + 1, first, middle()}; }
  [[nodiscard]] Range right() const { return {2 * index + 2, middle(), end}; }
};

/// A k-d tree of leaves of eight points, the last of which may have fewer.
class Leaves {
 public:
  Leaves(std::vector<Site> sites, const Executor& executor)
      : sites_{std::move(sites)}, count_{(sites_.size() + kLeaf - 1) / kLeaf} {
    std::vector<Range> open{{0, 0, count_}};
    while (!open.empty()) {  // widest ranges first, as many threads as there are ranges
      std::vector<Range> next;
      executor.parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          open[i].end - open[i].first > kSplitAlone ? split(open[i]) : sort(open[i]);
      });
      for (const Range& range : open) {
        if (range.end - range.first <= kSplitAlone) continue;
        next.push_back(range.left());
        next.push_back(range.right());
      }
      open = std::move(next);
    }
    bounds_.resize(2 * std::bit_ceil(count_));
    lanes_.resize(count_ * kLeaf * 3, kFar);
    executor.parallel_for(count_, kLeafGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf) fill_lanes(leaf);
    });
    bound({0, 0, count_});
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] Range root() const { return {0, 0, count_}; }
  [[nodiscard]] const Bounds& bounds(const Range& range) const { return bounds_[range.index]; }
  [[nodiscard]] const std::vector<Site>& sites() const { return sites_; }
  [[nodiscard]] std::size_t first_of(std::size_t leaf) const { return leaf * kLeaf; }
  [[nodiscard]] std::size_t end_of(std::size_t leaf) const { return std::min(sites_.size(), (leaf + 1) * kLeaf); }

  /// Squared distances to the points of a leaf; infinite where it has none.
  [[nodiscard]] std::array<float, kLeaf> squared_distances(std::size_t leaf, const Eigen::Vector3f& p) const {
    const float* lanes = lanes_.data() + leaf * kLeaf * 3;
    std::array<float, kLeaf> squared{};
    for (std::size_t i = 0; i < kLeaf; ++i) {
      const float dx = lanes[i] - p.x();
      const float dy = lanes[kLeaf + i] - p.y();
      const float dz = lanes[2 * kLeaf + i] - p.z();
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
    return squared;
  }

 private:
  /// Sites of the left half before those of the right one along the longest side.
  void split(const Range& range) {
    const auto begin = sites_.begin() + static_cast<std::ptrdiff_t>(first_of(range.first));
    const auto end = sites_.begin() + static_cast<std::ptrdiff_t>(end_of(range.end - 1));
    Bounds bounds;
    for (auto site = begin; site != end; ++site) bounds.add(site->p);
    Eigen::Index axis{0};
    (bounds.high - bounds.low).maxCoeff(&axis);
    std::nth_element(begin, sites_.begin() + static_cast<std::ptrdiff_t>(first_of(range.middle())), end,
                     [axis](const Site& a, const Site& b) {
                       return a.p[axis] != b.p[axis] ? a.p[axis] < b.p[axis] : a.point < b.point;
                     });
  }
  void sort(const Range& range) {
    if (range.is_leaf()) return;
    split(range);
    sort(range.left());
    sort(range.right());
  }
  void fill_lanes(std::size_t leaf) {
    float* lanes = lanes_.data() + leaf * kLeaf * 3;
    for (std::size_t i = first_of(leaf); i < end_of(leaf); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes[axis * kLeaf + i % kLeaf] = sites_[i].p[static_cast<Eigen::Index>(axis)];
      }
    }
  }
  const Bounds& bound(const Range& range) {
    Bounds& bounds = bounds_[range.index];
    if (range.is_leaf()) {
      for (std::size_t i = first_of(range.first); i < end_of(range.first); ++i) bounds.add(sites_[i].p);
    } else {
      bounds = bound(range.left());
      bounds.add(bound(range.right()));
    }
    return bounds;
  }

  std::vector<Site> sites_;
  std::size_t count_;
  std::vector<Bounds> bounds_;
  std::vector<float> lanes_;  ///< per leaf eight x, eight y, eight z
};

/// The nearest so far of one point: squared distance (its bits, which sort as its value does) above the node, in a
/// number that sorts in the same way as a double. So a new one takes its place by least and greatest, without a branch.
class Nearest {
 public:
  void reset(std::size_t k) {
    k_ = k;
    farthest_ = kFar;
    std::fill_n(found_.begin(), k, std::bit_cast<double>(entry_of(kFar, 0)));
  }
  [[nodiscard]] float farthest() const { return farthest_; }
  void add(float squared_distance, std::uint32_t node) {
    const auto entry = std::bit_cast<double>(entry_of(squared_distance, node));
    double before = found_[k_ - 1];
    for (std::size_t i = k_ - 1; i > 0; --i) {
      const double here = before;
      before = found_[i - 1];
      const double kept = here < entry ? here : entry;
      found_[i] = before < kept ? kept : before;
    }
    found_[0] = before < entry ? before : entry;
    farthest_ = std::bit_cast<float>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(found_[k_ - 1]) >> 32U));
  }
  [[nodiscard]] std::uint32_t node(std::size_t i) const {
    return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(found_[i]));
  }

 private:
  static std::uint64_t entry_of(float squared_distance, std::uint32_t node) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(squared_distance)} << 32U | node;
  }
  std::size_t k_{0};
  float farthest_{kFar};
  std::array<double, kMostNeighbours> found_{};
};

class LeafSearch {
 public:
  LeafSearch(const Leaves& leaves, std::size_t k) : leaves_{leaves}, k_{k} {}

  void run(std::size_t leaf, std::uint32_t* rows) {
    first_ = leaves_.first_of(leaf);
    size_ = leaves_.end_of(leaf) - first_;
    leaf_ = leaf;
    own_ = Bounds{};
    for (std::size_t i = 0; i < size_; ++i) {
      nearest_[i].reset(k_);
      own_.add(leaves_.sites()[first_ + i].p);
    }
    farthest_ = kFar;
    visit(leaves_.root());
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t n = 0; n < k_; ++n) rows[(first_ + i) * k_ + n] = nearest_[i].node(n);
    }
  }

 private:
  void visit(const Range& range) {
    if (range.is_leaf()) return look_at(range);
    Range nearer = range.left();
    Range farther = range.right();
    float to_nearer = squared_distance(nearer);
    float to_farther = squared_distance(farther);
    if (to_farther < to_nearer) {
      std::swap(nearer, farther);
      std::swap(to_nearer, to_farther);
    }
    if (to_nearer < farthest_) visit(nearer);
    if (to_farther < farthest_) visit(farther);
  }

  /// Below 0: the leaf itself is there.
  [[nodiscard]] float squared_distance(const Range& range) const {
    if (range.first <= leaf_ && leaf_ < range.end) return -1.0F;
    return leaves_.bounds(range).squared_distance(own_);
  }

  void look_at(const Range& range) {
    const std::size_t first = leaves_.first_of(range.first);
    const Bounds& bounds = leaves_.bounds(range);
    farthest_ = 0.0F;
    for (std::size_t i = 0; i < size_; ++i) {
      Nearest& nearest = nearest_[i];
      const Eigen::Vector3f& p = leaves_.sites()[first_ + i].p;
      if (bounds.squared_distance(p) < nearest.farthest()) {
        const std::array<float, kLeaf> squared = leaves_.squared_distances(range.first, p);
        unsigned near{0};
        for (unsigned n = 0; n < kLeaf; ++n) near |= (squared[n] < nearest.farthest() ? 1U : 0U) << n;
        if (range.first == leaf_) near &= ~(1U << i);
        for (; near != 0; near &= near - 1) {
          const auto n = static_cast<std::size_t>(std::countr_zero(near));
          if (squared[n] < nearest.farthest()) nearest.add(squared[n], static_cast<std::uint32_t>(first + n));
        }
      }
      farthest_ = std::max(farthest_, nearest.farthest());
    }
  }

  const Leaves& leaves_;
  std::size_t k_;
  std::size_t leaf_{0};
  std::size_t first_{0};
  std::size_t size_{0};
  Bounds own_;
  float farthest_{kFar};  ///< of the neighbours that the leaf's points have so far
  std::array<Nearest, kLeaf> nearest_;
};

bool is_usable(const Eigen::Vector3f& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_m; }

}  // namespace

NearestNeighbours nearest_neighbours(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                     const Executor& executor) {
  SACCADE_EXPECTS(k >= 1 && k <= kMostNeighbours && positions_m.size() < std::numeric_limits<std::uint32_t>::max());
  std::vector<Site> sites;
  sites.reserve(positions_m.size());
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    if (is_usable(positions_m[i])) sites.push_back({positions_m[i], static_cast<std::uint32_t>(i)});
  }
  NearestNeighbours result;
  if (sites.empty()) return result;
  const Leaves leaves{std::move(sites), executor};
  const std::size_t size = leaves.sites().size();
  result.count = std::min(k, size - 1);
  result.order.resize(size);
  result.positions_m.resize(size);
  result.nodes.resize(size * result.count);
  executor.parallel_for(leaves.count(), kLeafGrain, [&](std::size_t begin, std::size_t end) {
    LeafSearch search{leaves, result.count};
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      for (std::size_t i = leaves.first_of(leaf); i < leaves.end_of(leaf); ++i) {
        result.order[i] = leaves.sites()[i].point;
        result.positions_m[i] = leaves.sites()[i].p;
      }
      if (result.count > 0) search.run(leaf, result.nodes.data());
    }
  });
  return result;
}

}  // namespace saccade
