// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/nearest_neighbours.hpp"

#include <algorithm>
#include <limits>

#include "saccade/annotate/leaf_search.hpp"
#include "saccade/annotate/leaf_tree.hpp"
#include "saccade/core/result.hpp"

namespace saccade {
namespace {

constexpr std::size_t kLeafGrain{64};
constexpr float kFarthest_m{1e18F};  // beyond it squares are infinite

bool is_usable(const Eigen::Vector3f& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_m; }

}  // namespace

NearestNeighbours nearest_neighbours(std::span<const Eigen::Vector3f> positions_m, std::size_t k,
                                     const Executor& executor) {
  SACCADE_EXPECTS(k >= 1 && k <= kMostNeighbours && positions_m.size() < std::numeric_limits<std::uint32_t>::max());
  std::vector<LeafTree::Site> sites;
  sites.reserve(positions_m.size());
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    if (is_usable(positions_m[i])) sites.emplace_back(positions_m[i], static_cast<std::uint32_t>(i));
  }
  NearestNeighbours result;
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
