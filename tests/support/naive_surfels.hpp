// SPDX-License-Identifier: Apache-2.0
#pragma once
// Surfels by the thesis' definitions, implemented literally and slowly: eq. (4.13), (4.14) and (4.16).

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"

namespace saccade::test {

inline bool naive_touch(const PointCloud& cloud, std::size_t i, std::size_t k) {
  if (!cloud.positions_m[i].allFinite() || !cloud.positions_m[k].allFinite()) return false;
  const Eigen::Vector3d between_m = cloud.positions_m[i].cast<double>() - cloud.positions_m[k].cast<double>();
  return between_m.squaredNorm() < std::pow(double{cloud.radii_m[i]} + double{cloud.radii_m[k]}, 2.0);
}

/// Returns labels of the components connected by edges (i, k), from 0 in the order of first points, which are those
/// that are finite.
template <class Edge>
std::vector<std::uint32_t> naive_components(const PointCloud& cloud, const Edge& edge) {
  std::vector<std::uint32_t> labels(cloud.positions_m.size(), kUnlabelled);
  std::uint32_t next{0};
  for (std::size_t first = 0; first < labels.size(); ++first) {
    if (labels[first] != kUnlabelled || !cloud.positions_m[first].allFinite()) continue;
    labels[first] = next++;
    std::vector<std::size_t> front{first};
    while (!front.empty()) {
      const std::size_t i = front.back();
      front.pop_back();
      for (std::size_t k = 0; k < labels.size(); ++k) {
        if (k == i || labels[k] != kUnlabelled || !edge(i, k)) continue;
        labels[k] = labels[i];
        front.push_back(k);
      }
    }
  }
  return labels;
}

/// Eq. (4.16): of the points that count, the nearest one with another label of each that has one closer than T_eval; of
/// equally near ones the first.
inline std::set<std::uint32_t> naive_boundary(const std::vector<Eigen::Vector3f>& positions_m,
                                              const std::vector<std::uint32_t>& points,
                                              const std::vector<std::uint32_t>& labels, double t_eval_m) {
  std::set<std::uint32_t> boundary;
  for (const std::uint32_t i : points) {
    double least_m2 = t_eval_m * t_eval_m;
    std::uint32_t nearest{kUnlabelled};
    for (const std::uint32_t k : points) {
      const double distance_m2 = (positions_m[i].cast<double>() - positions_m[k].cast<double>()).squaredNorm();
      if (labels[i] == labels[k] || !(distance_m2 < least_m2)) continue;
      least_m2 = distance_m2;
      nearest = k;
    }
    if (nearest != kUnlabelled) boundary.insert(nearest);
  }
  return boundary;
}

}  // namespace saccade::test
