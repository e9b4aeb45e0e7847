// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/estimated_normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace saccade {
namespace {

constexpr std::size_t kGrain{1024};

/// Of points relative to one of them, so that single precision is enough: number, sum, and sum of products.
struct Moments {
  float count{0.0F};
  Eigen::Vector3f sum{Eigen::Vector3f::Zero()};
  Eigen::Matrix<float, 6, 1> products{Eigen::Matrix<float, 6, 1>::Zero()};  ///< xx, xy, xz, yy, yz, zz

  /// Those of another point's surroundings, `offset` from here.
  void add(const Moments& other, const Eigen::Vector3f& offset) {
    const Eigen::Vector3f& s = other.sum;
    const Eigen::Vector3f& o = offset;
    count += other.count;
    products[0] += other.products[0] + 2.0F * s.x() * o.x() + other.count * o.x() * o.x();
    products[1] += other.products[1] + s.x() * o.y() + s.y() * o.x() + other.count * o.x() * o.y();
    products[2] += other.products[2] + s.x() * o.z() + s.z() * o.x() + other.count * o.x() * o.z();
    products[3] += other.products[3] + 2.0F * s.y() * o.y() + other.count * o.y() * o.y();
    products[4] += other.products[4] + s.y() * o.z() + s.z() * o.y() + other.count * o.y() * o.z();
    products[5] += other.products[5] + 2.0F * s.z() * o.z() + other.count * o.z() * o.z();
    sum += s + other.count * o;
  }
};

Eigen::Vector3f least_direction(const Moments& moments) {
  const Eigen::Vector3f mean = moments.sum / moments.count;
  const Eigen::Matrix<float, 6, 1>& p = moments.products;
  Eigen::Matrix3f covariance;
  covariance << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
  covariance = covariance / moments.count - mean * mean.transpose();
  const float scale = covariance.diagonal().sum();
  if (!(scale > 0.0F)) return Eigen::Vector3f::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance / scale);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0);
  return normal.allFinite() ? normal : Eigen::Vector3f::Zero();
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(const NearestNeighbours& neighbours, int rounds,
                                              const Executor& executor) {
  const std::size_t size = neighbours.order.size();
  std::vector<Eigen::Vector3f> normals(size, Eigen::Vector3f::Zero());
  if (neighbours.count < 2) return normals;
  std::vector<Moments> around(size);
  for (Moments& moments : around) moments.count = 1.0F;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Moments> wider(round + 1 < rounds ? size : 0);
    executor.parallel_for(size, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Moments moments = around[i];
        for (const std::uint32_t node : neighbours.of(i)) {
          moments.add(around[node], neighbours.positions_m[node] - neighbours.positions_m[i]);
        }
        if (round + 1 < rounds) {
          wider[i] = moments;
        } else {
          normals[i] = least_direction(moments);
        }
      }
    });
    around = std::move(wider);
  }
  return normals;
}

}  // namespace saccade
