// SPDX-License-Identifier: Apache-2.0
#pragma once
// PathBuckets: nodes in approximate order of their path lengths. For thesis Algorithm 8.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

/// Prefetches the edges of a node: half of the time of a search is spent waiting for them. Inlined immediately, because
/// g++ drops calls of a function that only prefetches.
[[gnu::always_inline]] inline void fetch_edges(const Neighbourhood& neighbourhood, std::uint32_t node) {
  constexpr std::size_t kEdgesPerLine{8};  // edges per cache line
  const std::span<const Neighbourhood::Edge> edges = neighbourhood.edges(node);
  __builtin_prefetch(edges.data());
  if (edges.size() > kEdgesPerLine) __builtin_prefetch(edges.data() + kEdgesPerLine);
}

/// Queue by path length. Paths of nearly equal length share one unordered bucket; a node that is later found to be
/// nearer is visited again. Empty between searches; for one search at a time.
class PathBuckets {
 public:
  struct Reached {
    std::uint32_t path;  ///< in path units
    std::uint32_t node;
  };

  /// Creates the queue. The neighbourhood must not move.
  explicit PathBuckets(const Neighbourhood& neighbourhood)
      : neighbourhood_{&neighbourhood},
        shift_{bucket_shift(neighbourhood)},
        buckets_((kPathUnits >> shift_) + 1),
        first_{buckets_.size()} {}

  /// Adds a node. Expects path < Ω_max, in path units.
  void push(std::uint32_t path, std::uint32_t node) {
    const std::size_t bucket = path >> shift_;
    buckets_[bucket].push_back({path, node});
    first_ = std::min(first_, bucket);
    last_ = std::max(last_, bucket);
    fetch_edges(*neighbourhood_, node);
  }

  /// Calls visit(path, node), shorter paths first, until the queue is empty or goes_on(), called before each bucket,
  /// returns false; visit may push paths that are not shorter.
  template <class Visit, class GoesOn>
  void drain(const Visit& visit, const GoesOn& goes_on) {
    while (std::vector<Reached>* bucket = nearest()) {
      if (!goes_on()) return;
      for (std::size_t i = 0; i < bucket->size(); ++i) {
        if (i + kAhead < bucket->size()) fetch_edges(*neighbourhood_, (*bucket)[i + kAhead].node);
        const Reached reached = (*bucket)[i];
        visit(reached.path, reached.node);
      }
      bucket->clear();
    }
  }

  template <class Visit>
  void drain(const Visit& visit) {
    drain(visit, [] { return true; });
  }

  /// Returns the number of the bucket with the shortest paths.
  [[nodiscard]] std::optional<std::size_t> nearest_length() {
    if (nearest() == nullptr) return std::nullopt;
    return first_;
  }
  [[nodiscard]] std::size_t count() const {
    std::size_t count{0};
    for (std::size_t b = first_; b <= last_; ++b) count += buckets_[b].size();
    return count;
  }
  /// Moves up to `most` of the nodes with about the shortest paths, oldest first, to the end of `taken`; or half of
  /// them.
  void take(std::size_t most, std::vector<Reached>& taken) {
    if (std::vector<Reached>* bucket = nearest()) move_first(*bucket, std::min(most, bucket->size()), taken);
  }
  void take_half(std::vector<Reached>& taken) {
    if (std::vector<Reached>* bucket = nearest()) move_first(*bucket, (bucket->size() + 1) / 2, taken);
  }

 private:
  static constexpr int kMostBucketsLog2{14};
  static constexpr std::size_t kAhead{6};  ///< nodes of a bucket

  /// Returns the first bucket that is not empty; nullptr where all are empty.
  [[nodiscard]] std::vector<Reached>* nearest() {
    for (; first_ <= last_; ++first_) {
      if (!buckets_[first_].empty()) return &buckets_[first_];
    }
    first_ = buckets_.size();
    last_ = 0;
    return nullptr;
  }

  static void move_first(std::vector<Reached>& bucket, std::size_t count, std::vector<Reached>& taken) {
    const auto end = bucket.begin() + static_cast<std::ptrdiff_t>(count);
    taken.insert(taken.end(), bucket.begin(), end);
    bucket.erase(bucket.begin(), end);
  }

  /// Returns the shift. With equal bucket widths, half of the edges are not shorter: few nodes are visited twice.
  static unsigned bucket_shift(const Neighbourhood& neighbourhood) {
    const int length = static_cast<int>(std::bit_width(neighbourhood.median_cost())) - 1;
    const int least = static_cast<int>(std::bit_width(kPathUnits)) - 1 - kMostBucketsLog2;
    return static_cast<unsigned>(std::max(length, least));
  }

  const Neighbourhood* neighbourhood_;
  unsigned shift_;
  std::vector<std::vector<Reached>> buckets_;
  std::size_t first_;  ///< first bucket that is not empty; the number of buckets where all are empty
  std::size_t last_{0};
};

}  // namespace saccade
