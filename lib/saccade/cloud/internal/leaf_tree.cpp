// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/internal/leaf_tree.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace saccade {
namespace {

constexpr std::size_t kSplitAlone{1024};  // leaves of a range that one thread splits completely
constexpr std::size_t kGroupGrain{16};
constexpr std::size_t kFew{32};  // sites
constexpr std::size_t kSample{16};
constexpr float kFar{std::numeric_limits<float>::infinity()};
constexpr float kNoPoint_m{8e18F};  // its squared distance to a point is finite, and greater than that between any two
                                    // points

using IndexedPoint = LeafTree::IndexedPoint;

/// Moves sites whose coordinate satisfies `is_left` to the front; returns where the others begin. Free of branches.
template <class IsLeft>
IndexedPoint* partition(IndexedPoint* begin, IndexedPoint* end, Eigen::Index axis, const IsLeft& is_left) {
  IndexedPoint* next = begin;
  for (IndexedPoint* site = begin; site != end; ++site) {
    const bool left = is_left(site->lanes[axis]);
    std::swap(*site, *next);
    next += left ? 1 : 0;
  }
  return next;
}

struct Ranked {
  float value;
  int less;  ///< number of smaller values
};

/// Returns the greatest of the values that have fewer than `rank` smaller ones. Expects rank ≥ 1.
template <std::size_t kCount>
Ranked ranked(const std::array<float, kCount>& values, int rank) {
  Ranked found{-kFar, 0};
  for (const float value : values) {
    int less{0};
    for (const float other : values) less += other < value ? 1 : 0;
    const bool is_in_front = (less < rank) & (value >= found.value);
    found = {is_in_front ? value : found.value, is_in_front ? less : found.less};
  }
  return found;
}

/// Moves the `left` smallest of at most kMost sites to the front.
template <std::size_t kMost>
void select_of_few(IndexedPoint* begin, IndexedPoint* end, int left, Eigen::Index axis) {
  std::array<IndexedPoint, kMost> sites;
  const auto size = static_cast<std::size_t>(end - begin);
  std::copy(begin, end, sites.begin());
  std::array<float, kMost> x;
  x.fill(kFar);
  for (std::size_t i = 0; i < size; ++i) x[i] = sites[i].lanes[axis];
  const Ranked last = ranked(x, left);
  int equal = left - last.less;  // sites equal to the last one that belong to the left
  std::array<IndexedPoint*, 2> next{begin + left, begin};
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_equal = x[i] == last.value;
    const bool is_left = (x[i] < last.value) | (is_equal & (equal > 0));
    equal -= is_equal ? 1 : 0;
    *next[is_left ? 1 : 0]++ = sites[i];
  }
}

/// Works as std::nth_element, with far fewer unpredictable branches.
void select(IndexedPoint* begin, IndexedPoint* middle, IndexedPoint* end, Eigen::Index axis) {
  while (begin < middle && end - begin > std::ptrdiff_t{kFew}) {
    // Takes from a sample the value just beyond the expected middle, on the side that holds more sites.
    constexpr int kMiddle{kSample / 2};
    constexpr int kBeyond{1};
    constexpr std::uint32_t kGoldenRatio{0x9E3779B9U};  // golden ratio of 2³²: its multiples spread evenly and
                                                        // irregularly
    const auto size = static_cast<std::uint64_t>(end - begin);
    std::array<float, kSample> sample;
    for (std::uint32_t i = 0; i < kSample; ++i) sample[i] = begin[(i * kGoldenRatio * size) >> 32U].lanes[axis];
    const auto rank = static_cast<int>(static_cast<std::uint64_t>(middle - begin) * kSample / size);
    const float pivot = ranked(sample, 1 + rank + (rank < kMiddle ? kBeyond : rank > kMiddle ? -kBeyond : 0)).value;
    IndexedPoint* cut = partition(begin, end, axis, [pivot](float x) { return x < pivot; });
    if (cut == begin) {  // no site is smaller
      cut = partition(begin, end, axis, [pivot](float x) { return x <= pivot; });
      if (middle < cut) return;
    }
    (cut <= middle ? begin : end) = cut;
  }
  if (begin == middle) return;
  const auto left = static_cast<int>(middle - begin);
  end - begin <= std::ptrdiff_t{kFew / 2} ? select_of_few<kFew / 2>(begin, end, left, axis)
                                          : select_of_few<kFew>(begin, end, left, axis);
}

void join_child(LeafTree::Boxes& boxes, std::size_t child, std::size_t axis, float low, float high) {
  boxes.low_m[axis][child] = std::min(boxes.low_m[axis][child], low);
  boxes.high_m[axis][child] = std::max(boxes.high_m[axis][child], high);
}

LeafTree::Boxes no_boxes() {
  LeafTree::Boxes boxes{};
  for (LeafTree::Lanes& low : boxes.low_m) low.fill(kFar);
  for (LeafTree::Lanes& high : boxes.high_m) high.fill(-kFar);
  return boxes;
}

std::size_t groups_of(std::size_t children) { return (children + LeafTree::kWidth - 1) / LeafTree::kWidth; }

}  // namespace

/// Range of leaves [first, end), cut where the largest groups inside end.
struct LeafTree::Range {
  std::size_t first;
  std::size_t end;

  [[nodiscard]] std::size_t size() const { return end - first; }
  [[nodiscard]] std::size_t middle() const {
    const auto levels = static_cast<std::size_t>(std::bit_width(size() - 1) - 1) / kWidthLog2;
    const std::size_t group = std::size_t{1} << levels * kWidthLog2;
    const std::size_t groups = (size() + group - 1) / group;
    return first + (groups + 1) / 2 * group;
  }
  [[nodiscard]] Range left() const { return {first, middle()}; }
  [[nodiscard]] Range right() const { return {middle(), end}; }
};

LeafTree::LeafTree(UninitializedVector<IndexedPoint> sites, const Executor& executor)
    : sites_{std::move(sites)}, leaves_(groups_of(sites_.size())) {
  std::vector<Range> open{{0, leaves_.size()}};
  while (!open.empty()) {  // widest ranges first; each range runs on its own thread
    std::vector<Range> next;
    executor.parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) open[i].size() > kSplitAlone ? split(open[i]) : sort(open[i]);
    });
    for (const Range& range : open) {
      if (range.size() <= kSplitAlone) continue;
      next.push_back(range.left());
      next.push_back(range.right());
    }
    open = std::move(next);
  }
  levels_.emplace_back(groups_of(leaves_.size()), no_boxes());
  executor.parallel_for(levels_[0].size(), kGroupGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t group = begin; group < end; ++group) fill(group);
  });
  while (levels_.back().size() > 1) {
    const std::vector<Boxes>& below = levels_.back();
    std::vector<Boxes> boxes(groups_of(below.size()), no_boxes());
    for (std::size_t i = 0; i < below.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        join_child(boxes[i / kWidth], i % kWidth, axis,
                   *std::min_element(below[i].low_m[axis].begin(), below[i].low_m[axis].end()),
                   *std::max_element(below[i].high_m[axis].begin(), below[i].high_m[axis].end()));
      }
    }
    levels_.push_back(std::move(boxes));
  }
}

/// Moves the sites of the left half to the front along the longest side.
void LeafTree::split(const Range& range) {
  IndexedPoint* begin = sites_.data() + first_of(range.first);
  IndexedPoint* end = sites_.data() + end_of(range.end - 1);
  Eigen::Array4f low = begin->lanes;
  Eigen::Array4f high = low;
  for (const IndexedPoint* site = begin; site != end; ++site) {
    low = low.min(site->lanes.array());
    high = high.max(site->lanes.array());
  }
  Eigen::Index axis{0};
  (high - low).head<3>().maxCoeff(&axis);
  select(begin, sites_.data() + first_of(range.middle()), end, axis);
}

void LeafTree::sort(const Range& range) {
  if (range.size() == 1) return;
  split(range);
  sort(range.left());
  sort(range.right());
}

void LeafTree::fill(std::size_t group) {
  for (std::size_t leaf = group * kWidth; leaf < std::min(leaves_.size(), (group + 1) * kWidth); ++leaf) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Lanes& lanes = leaves_[leaf].p_m[axis];
      lanes.fill(kNoPoint_m);
      for (std::size_t i = first_of(leaf); i < end_of(leaf); ++i) {
        const float x = sites_[i].lanes[static_cast<Eigen::Index>(axis)];
        lanes[i % kWidth] = x;
        join_child(levels_[0][group], leaf % kWidth, axis, x, x);
      }
    }
  }
}

}  // namespace saccade
