// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/surfel_estimates.hpp"

#include "saccade/cloud/nearest_neighbours.hpp"

namespace saccade {
namespace {

constexpr std::size_t kSurfelNeighbours{10};

}  // namespace

std::vector<float> surfel_radii(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) {
  const NearestNeighbours near = nearest_neighbours(positions_m, kSurfelNeighbours, executor);
  const std::vector<float> of_nodes = estimate_radii(near);
  std::vector<float> radii_m(positions_m.size(), 0.0F);
  for (std::size_t n = 0; n < of_nodes.size(); ++n) radii_m[near.order[n]] = of_nodes[n];
  return radii_m;
}

std::vector<Eigen::Vector3f> surfel_normals(std::span<const Eigen::Vector3f> positions_m,
                                            const Eigen::Vector3d& viewpoint_m, const Executor& executor) {
  constexpr int kRounds{2};
  const NearestNeighbours near = nearest_neighbours(positions_m, kSurfelNeighbours, executor);
  const std::vector<Eigen::Vector3f> of_nodes = estimate_normals(near, kRounds, executor);
  std::vector<Eigen::Vector3f> normals(positions_m.size(), Eigen::Vector3f::Zero());
  const Eigen::Vector3f towards_m = viewpoint_m.cast<float>();
  for (std::size_t n = 0; n < of_nodes.size(); ++n) {
    const bool is_away = of_nodes[n].dot(towards_m - near.positions_m[n]) < 0.0F;
    normals[near.order[n]] = is_away ? Eigen::Vector3f{-of_nodes[n]} : of_nodes[n];
  }
  return normals;
}

}  // namespace saccade
