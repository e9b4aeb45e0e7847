// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/estimated_normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace saccade {
namespace {

constexpr std::size_t kNormalGrain{1024};

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

/// The least eigenvalue of a covariance of trace 1: the least root of its characteristic polynomial. Newton's method
/// comes from 0 upwards to it and not beyond, as the polynomial rises and is concave there.
double least_eigenvalue(const Eigen::Matrix3d& c) {
  constexpr int kSteps{20};
  constexpr double kClose{1e-12};
  const double determinant = c.determinant();
  const double minors = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1) + c(0, 0) * c(2, 2) - c(0, 2) * c(0, 2) +
                        c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2);
  double root{0.0};
  for (int i = 0; i < kSteps; ++i) {
    const double slope = (3.0 * root - 2.0) * root + minors;
    const double value = ((root - 1.0) * root + minors) * root - determinant;
    if (!(slope > 0.0) || value > -kClose * slope) break;
    root -= value / slope;
  }
  return root;
}

/// What is perpendicular to the rows of a symmetric matrix of rank 2, or, of rank 1, to its largest.
Eigen::Vector3d perpendicular_to_rows(const Eigen::Matrix3d& m) {
  constexpr double kParallel{1e-10};
  Eigen::Vector3d best = m.col(0).cross(m.col(1));
  for (const Eigen::Vector3d& other :
       {Eigen::Vector3d{m.col(1).cross(m.col(2))}, Eigen::Vector3d{m.col(2).cross(m.col(0))}}) {
    if (other.squaredNorm() > best.squaredNorm()) best = other;
  }
  if (best.norm() > kParallel) return best.normalized();
  Eigen::Index largest{0};
  m.colwise().squaredNorm().maxCoeff(&largest);
  if (m.col(largest).norm() < kParallel) return Eigen::Vector3d::Zero();  // the same in all directions
  return m.col(largest).unitOrthogonal();
}

Eigen::Vector3f least_direction(const Moments& moments) {
  const Eigen::Vector3f mean = moments.sum / moments.count;
  const Eigen::Matrix<float, 6, 1>& p = moments.products;
  Eigen::Matrix3f covariance;
  covariance << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
  covariance = covariance / moments.count - mean * mean.transpose();
  const float trace = covariance.diagonal().sum();
  if (!(trace > 0.0F) || !covariance.allFinite()) return Eigen::Vector3f::Zero();
  Eigen::Matrix3d scaled = (covariance / trace).cast<double>();
  scaled.diagonal().array() -= least_eigenvalue(scaled);
  return perpendicular_to_rows(scaled).cast<float>();
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
    executor.parallel_for(size, kNormalGrain, [&](std::size_t begin, std::size_t end) {
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
