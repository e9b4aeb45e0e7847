// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "saccade/cloud/internal/leaf_search.hpp"
#include "saccade/cloud/internal/leaf_tree.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr std::size_t kPointGrain{4096};
constexpr std::size_t kLeafGrain{64};
constexpr float kFarthest_m{1e18F};  // squares of larger numbers are infinite

bool is_usable(const Eigen::Vector3f& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_m; }

/// Returns the usable points in their original order.
UninitializedVector<LeafTree::IndexedPoint> usable_sites(std::span<const Eigen::Vector3f> positions_m,
                                                         const Executor& executor) {
  std::vector<std::size_t> first((positions_m.size() + kPointGrain - 1) / kPointGrain +
                                 1);  // first usable point of each chunk
  executor.parallel_for(positions_m.size(), kPointGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) first[begin / kPointGrain + 1] += is_usable(positions_m[i]) ? 1 : 0;
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  UninitializedVector<LeafTree::IndexedPoint> sites(first.back());
  executor.parallel_for(positions_m.size(), kPointGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t next = first[begin / kPointGrain];
    for (std::size_t i = begin; i < end; ++i) {
      if (is_usable(positions_m[i])) sites[next++] = {positions_m[i], static_cast<std::uint32_t>(i)};
    }
  });
  return sites;
}

}  // namespace

NearestNeighbours nearest_neighbours(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                     const Executor& executor, std::shared_ptr<const DiskMemory> disk) {
  SACCADE_EXPECTS(k >= 1 && k <= kMostNeighbours && positions_m.size() < std::numeric_limits<std::uint32_t>::max());
  UninitializedVector<LeafTree::IndexedPoint> sites = usable_sites(positions_m, executor);
  NearestNeighbours result{{}, {}, 0, DiskVector<std::uint32_t>(DiskAllocator<std::uint32_t>{std::move(disk)})};
  if (sites.empty()) return result;
  const LeafTree tree{std::move(sites), executor};
  const std::size_t size = tree.sites().size();
  result.count = std::min(k, size - 1);
  result.order.resize(size);
  result.positions_m.resize(size);
  result.nodes.resize(size * result.count);
  executor.parallel_for(tree.leaves().size(), kLeafGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = tree.first_of(begin); i < tree.end_of(end - 1); ++i) {
      result.order[i] = tree.sites()[i].point();
      result.positions_m[i] = tree.sites()[i].p_m();
    }
    if (result.count > 0) search_leaves(tree, result.count, begin, end, result.nodes.data());
  });
  return result;
}

}  // namespace saccade
