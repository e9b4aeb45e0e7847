// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/internal/leaf_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/cloud/internal/leaf_search.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWidth{LeafTree::kWidth};
constexpr std::size_t kBatch{4};  // neighbours offered at once

// A neighbour is one number: its squared distance (the bits of a float, which sort as its value does) above its site.
// As a double it sorts likewise, so minimum and maximum insert a new neighbour. One lane is one point.
using KeyTag = hn::CappedTag<double, kWidth>;
using KeyBits = hn::RebindToUnsigned<KeyTag>;
using FloatTag = hn::Rebind<float, KeyTag>;
using FloatBits = hn::RebindToUnsigned<FloatTag>;
using BoxTag = hn::CappedTag<float, kWidth>;
using BoxBits = hn::RebindToUnsigned<BoxTag>;
using Key = hn::Vec<KeyTag>;
using V = hn::Vec<FloatTag>;

struct Search {
  const LeafTree& tree;
  std::size_t k;
  std::size_t leaf{0};
  std::uint32_t farthest{0};  ///< farthest neighbour found so far by any point of the leaf: bits of its squared
                              ///< distance
  /// Eight points per neighbour. They follow kBatch rows that are nearer than any neighbour.
  alignas(64) std::array<std::array<double, kWidth>, kBatch + kMostNeighbours> found{};
};

double key_of(float squared_m2, std::uint32_t site) {
  return std::bit_cast<double>(std::uint64_t{std::bit_cast<std::uint32_t>(squared_m2)} << 32U | site);
}

HWY_INLINE Key keys_of(V squared, std::uint32_t site) {
  const auto bits = hn::PromoteTo(KeyBits{}, hn::BitCast(FloatBits{}, squared));
  return hn::BitCast(KeyTag{}, hn::Or(hn::ShiftLeft<32>(bits), hn::Set(KeyBits{}, site)));
}

template <class T>
HWY_INLINE T squared_length(T x, T y, T z) {
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

/// Returns the gap between two intervals.
template <class D, class T = hn::Vec<D>>
HWY_INLINE T gap(D d, T low, T high, T other_low, T other_high) {
  return hn::Max(hn::Max(hn::Sub(low, other_high), hn::Sub(other_low, high)), hn::Zero(d));
}

HWY_INLINE void sort_two(Key& a, Key& b) {
  const Key less = hn::Min(a, b);
  b = hn::Max(a, b);
  a = less;
}

HWY_INLINE void sort_batch(std::array<Key, kBatch>& keys) {
  sort_two(keys[0], keys[1]);
  sort_two(keys[2], keys[3]);
  sort_two(keys[0], keys[2]);
  sort_two(keys[1], keys[3]);
  sort_two(keys[1], keys[2]);
}

/// Offers keys in ascending order to each of a block of points. Element i of two merged sorted lists is the minimum
/// over j of the greater of element i − j of one and element j of the other, the i-th of one list included.
HWY_INLINE void merge(double* found, std::size_t k, const std::array<Key, kBatch>& keys) {
  const KeyTag d;
  double* at = found + (k - 1) * kWidth;
  Key here = hn::Load(d, at);
  Key before = hn::Load(d, at - kWidth);
  Key before2 = hn::Load(d, at - 2 * kWidth);
  Key before3 = hn::Load(d, at - 3 * kWidth);
  for (; at >= found; at -= kWidth) {
    const Key before4 = hn::Load(d, at - 4 * kWidth);
    const Key least = hn::Min(hn::Min(here, hn::Max(before, keys[0])), hn::Max(before2, keys[1]));
    hn::Store(hn::Min(least, hn::Min(hn::Max(before3, keys[2]), hn::Max(before4, keys[3]))), d, at);
    here = before;
    before = before2;
    before2 = before3;
    before3 = before4;
  }
}

template <bool kOwn>
HWY_INLINE void look_at(Search& search, std::size_t leaf) {
  const KeyTag d;
  const FloatTag df;
  const auto& own = search.tree.leaves()[search.leaf].p_m;
  const auto& theirs = search.tree.leaves()[leaf].p_m;
  const LeafTree::Boxes& boxes = search.tree.levels()[0][leaf / kWidth];
  const std::size_t child = leaf % kWidth;
  const auto first = static_cast<std::uint32_t>(search.tree.first_of(leaf));
  double* last = search.found[kBatch + search.k - 1].data();
  Key farthest = hn::Zero(d);
  for (std::size_t block = 0; block < kWidth; block += hn::Lanes(d)) {
    const V x = hn::Load(df, own[0].data() + block);
    const V y = hn::Load(df, own[1].data() + block);
    const V z = hn::Load(df, own[2].data() + block);
    const auto side = [&](std::size_t axis, V p) HWY_ATTR {
      return gap(df, hn::Set(df, boxes.low_m[axis][child]), hn::Set(df, boxes.high_m[axis][child]), p, p);
    };
    Key kth = hn::Load(d, last + block);
    if (kOwn || !hn::AllFalse(d, hn::Lt(keys_of(squared_length(side(0, x), side(1, y), side(2, z)), 0), kth))) {
      for (std::uint32_t batch = 0; batch < kWidth; batch += kBatch) {
        std::array<Key, kBatch> keys;
        for (std::uint32_t i = 0; i < kBatch; ++i) {
          const std::uint32_t n = batch + i;
          const V squared = squared_length(hn::Sub(hn::Set(df, theirs[0][n]), x), hn::Sub(hn::Set(df, theirs[1][n]), y),
                                           hn::Sub(hn::Set(df, theirs[2][n]), z));
          keys[i] = keys_of(squared, first + n);
          if (kOwn) {
            const auto itself = hn::Eq(hn::Iota(d, static_cast<double>(block)), hn::Set(d, static_cast<double>(n)));
            keys[i] = hn::IfThenElse(itself, hn::Set(d, key_of(std::numeric_limits<float>::infinity(), 0)), keys[i]);
          }
        }
        sort_batch(keys);
        if (hn::AllFalse(d, hn::Lt(keys[0], kth))) continue;
        merge(search.found[kBatch].data() + block, search.k, keys);
        kth = hn::Load(d, last + block);
      }
    }
    farthest = hn::Max(farthest, kth);
  }
  const double most = hn::GetLane(hn::MaxOfLanes(d, farthest));
  search.farthest = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(most) >> 32U);
}

constexpr std::size_t kNone{kWidth};

/// Visits the children of a group that are near enough, nearest first.
void descend(Search& search, std::size_t level, std::size_t group, std::size_t except) {
  const BoxTag d;
  const BoxBits du;
  const LeafTree::Boxes& own = search.tree.levels()[0][search.leaf / kWidth];
  const std::size_t child = search.leaf % kWidth;
  const LeafTree::Boxes& boxes = search.tree.levels()[level][group];
  // Each key holds the child's number in its low bits and its distance, rounded down, above.
  alignas(64) std::array<std::uint32_t, kWidth> near;
  constexpr auto kChild = static_cast<std::uint32_t>(kWidth - 1);
  for (std::size_t block = 0; block < kWidth; block += hn::Lanes(d)) {
    const auto side = [&](std::size_t axis) HWY_ATTR {
      return gap(d, hn::Load(d, boxes.low_m[axis].data() + block), hn::Load(d, boxes.high_m[axis].data() + block),
                 hn::Set(d, own.low_m[axis][child]), hn::Set(d, own.high_m[axis][child]));
    };
    const auto bits = hn::BitCast(du, squared_length(side(0), side(1), side(2)));
    hn::Store(hn::Or(hn::AndNot(hn::Set(du, kChild), bits), hn::Iota(du, static_cast<std::uint32_t>(block))), du,
              near.data() + block);
  }
  constexpr std::uint32_t kDone{~0U};
  if (except != kNone) near[except] = kDone;
  while (true) {
    std::uint32_t nearest{kDone};
    for (const std::uint32_t n : near) nearest = std::min(nearest, n);
    if ((nearest & ~kChild) >= search.farthest) return;
    const std::size_t next = group * kWidth + (nearest & kChild);
    near[nearest & kChild] = kDone;
    if (level == 0) {
      look_at<false>(search, next);
    } else {
      descend(search, level - 1, next, kNone);
    }
  }
}

void search_kernel(const LeafTree& tree, std::size_t k, std::size_t begin, std::size_t end, std::uint32_t* rows) {
  Search search{tree, k};
  for (std::size_t leaf = begin; leaf < end; ++leaf) {
    const std::size_t first = tree.first_of(leaf);
    const std::size_t size = tree.end_of(leaf) - first;
    search.leaf = leaf;
    for (std::size_t n = 0; n < k; ++n) {  // unused places search for nothing
      search.found[kBatch + n].fill(0.0);
      std::fill_n(search.found[kBatch + n].begin(), size, key_of(std::numeric_limits<float>::infinity(), 0));
    }
    look_at<true>(search, leaf);
    std::size_t from{leaf};
    for (std::size_t level = 0; level < tree.levels().size(); ++level, from /= kWidth) {
      descend(search, level, from / kWidth, from % kWidth);
    }
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t n = 0; n < k; ++n) {
        rows[(first + i) * k + n] =
            static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(search.found[kBatch + n][i]));
      }
    }
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(search_kernel);

}  // namespace

void search_leaves(const LeafTree& tree, std::size_t k, std::size_t begin, std::size_t end, std::uint32_t* rows) {
  HWY_DYNAMIC_DISPATCH(search_kernel)(tree, k, begin, end, rows);
}

}  // namespace saccade
#endif  // HWY_ONCE
