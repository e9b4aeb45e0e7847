// SPDX-License-Identifier: Apache-2.0
#pragma once
// PathBuckets: nodes in about the order in which paths reach them. For thesis Algorithm 8.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "saccade/annotate/neighbourhood.hpp"

namespace saccade {

/// A queue by path length. Paths of nearly equal length are in one bucket, in no order: a node that is found to be
/// nearer after all is looked at again. Empty between searches; one per search at a time.
class PathBuckets {
 public:
  explicit PathBuckets(const Neighbourhood& neighbourhood)
      : shift_{bucket_shift(neighbourhood)}, buckets_((kPathUnits >> shift_) + 1) {}

  /// Expects path < Ω_max, in path units.
  void push(std::uint32_t path, std::uint32_t node) {
    const std::size_t bucket = path >> shift_;
    buckets_[bucket].push_back({path, node});
    last_ = std::max(last_, bucket);
  }

  /// Calls visit(path, node), the shorter paths first, until there is none; visit may push what is not shorter.
  template <class Visit>
  void drain(const Visit& visit) {
    for (std::size_t b = 0; b <= last_; ++b) {
      std::vector<Reached>& bucket = buckets_[b];
      for (std::size_t i = 0; i < bucket.size(); ++i) {
        const Reached reached = bucket[i];
        visit(reached.path, reached.node);
      }
      bucket.clear();
    }
    last_ = 0;
  }

 private:
  struct Reached {
    std::uint32_t path;  ///< in path units
    std::uint32_t node;
  };

  static constexpr int kMostBucketsLog2{13};

  /// Of equal length, half of the edges are not shorter: few nodes are looked at twice.
  static unsigned bucket_shift(const Neighbourhood& neighbourhood) {
    const int length = std::bit_width(neighbourhood.median_cost()) - 1;
    const int least = std::bit_width(kPathUnits) - 1 - kMostBucketsLog2;
    return static_cast<unsigned>(std::max(length, least));
  }

  unsigned shift_;
  std::vector<std::vector<Reached>> buckets_;
  std::size_t last_{0};
};

/// Half of the time of a search goes into waiting for edges. Inlined at once: g++ takes calls of a function that does
/// nothing but fetch for superfluous.
[[gnu::always_inline]] inline void fetch_edges_soon(const Neighbourhood& neighbourhood, std::uint32_t node) {
  constexpr std::size_t kEdgesPerLine{8};  // of the cache
  const auto edges = neighbourhood.edges(node);
  if (!edges.empty()) __builtin_prefetch(edges.data());
  if (edges.size() > kEdgesPerLine) __builtin_prefetch(edges.data() + kEdgesPerLine);
}

}  // namespace saccade
