// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_places.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <tuple>

namespace saccade {
namespace {

constexpr std::size_t kNodeGrain{4096};

/// Tells whether half of a node's neighbours lie where it does, elsewhere than at the origin.
bool is_crowded(const NearestNeighbours& neighbours, std::size_t node) {
  const std::uint32_t middle = neighbours.of(node)[(neighbours.count - 1) / 2];
  const Eigen::Vector3f& p_m = neighbours.positions_m[node];
  return neighbours.positions_m[middle] == p_m && !p_m.isZero(0.0F);
}

std::vector<PointCopy> crowded_copies(const NearestNeighbours& neighbours, const Executor& executor) {
  std::vector<PointCopy> copies;
  if (neighbours.count == 0) return copies;
  const std::size_t size = neighbours.order.size();
  std::atomic<bool> any{false};
  executor.parallel_for(size, kNodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      if (is_crowded(neighbours, node)) any.store(true, std::memory_order_relaxed);
    }
  });
  if (!any) return copies;
  std::vector<std::uint32_t> crowded;
  for (std::uint32_t node = 0; node < size; ++node) {
    if (is_crowded(neighbours, node)) crowded.push_back(node);
  }
  const auto place = [&](std::uint32_t node) {
    const Eigen::Vector3f& p = neighbours.positions_m[node];
    return std::tuple{p.x(), p.y(), p.z()};
  };
  std::sort(crowded.begin(), crowded.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple{place(a), neighbours.order[a]} < std::tuple{place(b), neighbours.order[b]};
  });
  std::size_t first{0};
  for (std::size_t i = 1; i < crowded.size(); ++i) {
    if (place(crowded[i]) != place(crowded[first])) {
      first = i;
    } else {
      copies.push_back({neighbours.order[crowded[i]], neighbours.order[crowded[first]]});
    }
  }
  std::sort(copies.begin(), copies.end(), [](const PointCopy& a, const PointCopy& b) { return a.point < b.point; });
  return copies;
}

}  // namespace

NearestPlaces nearest_places(std::span<const Eigen::Vector3f> positions_m, std::size_t k, const Executor& executor,
                             const std::shared_ptr<const DiskMemory>& disk) {
  NearestPlaces found{nearest_neighbours(positions_m, k, executor, disk), {}};
  found.copies = crowded_copies(found.neighbours, executor);
  if (found.copies.empty()) return found;
  std::vector<Eigen::Vector3f> places_m{positions_m.begin(), positions_m.end()};
  for (const PointCopy& copy : found.copies) {
    places_m[copy.point].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  found.neighbours = {};
  found.neighbours = nearest_neighbours(places_m, k, executor, disk);
  return found;
}

}  // namespace saccade
