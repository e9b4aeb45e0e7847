// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/ellipsoids.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "saccade/map/voxel_index.hpp"

namespace saccade {
namespace {

constexpr int kRounds{5};

/// Points by cells of a lattice.
class ClusterCells {
 public:
  ClusterCells(std::span<const Eigen::Vector3d> points, double cell_m) {
    for (const Eigen::Vector3d& p : points) box_ = box_.hull(IndexBox::cube(voxel_at(p, cell_m), 1));
    members_.resize(box_.empty() ? 0 : static_cast<std::size_t>(box_.count()));
    for (std::size_t i = 0; i < points.size(); ++i) members_[index(voxel_at(points[i], cell_m))].push_back(i);
  }
  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] const std::vector<std::size_t>& members(const Index3& cell) const { return members_[index(cell)]; }

 private:
  [[nodiscard]] std::size_t index(const Index3& cell) const {
    const Index3 at = cell - box_.lo;
    const Index3 size = box_.size();
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(at.x);
  }
  IndexBox box_{};
  std::vector<std::vector<std::size_t>> members_;
};

/// Returns the means of the points in each cell, as initial centres of clusters.
std::vector<Eigen::Vector3d> first_centers(std::span<const Eigen::Vector3d> points, double cell_m) {
  const ClusterCells cells{points, cell_m};
  std::vector<Eigen::Vector3d> centers;
  cells.box().for_each([&](const Index3& cell) {
    const std::vector<std::size_t>& members = cells.members(cell);
    if (members.empty()) return;
    Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
    for (const std::size_t i : members) sum += points[i];
    centers.emplace_back(sum / static_cast<double>(members.size()));
  });
  return centers;
}

/// Returns the index of the centre nearest to each point, among cells up to two away; initially its cell held one.
std::vector<std::size_t> nearest_centers(std::span<const Eigen::Vector3d> points,
                                         std::span<const Eigen::Vector3d> centers, double cell_m) {
  const ClusterCells cells{centers, cell_m};
  std::vector<std::size_t> nearest(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best{std::numeric_limits<double>::infinity()};
    IndexBox::cube(voxel_at(points[i], cell_m), 1).grown(2).intersection(cells.box()).for_each([&](const Index3& cell) {
      for (const std::size_t c : cells.members(cell)) {
        const double distance = (centers[c] - points[i]).squaredNorm();
        if (distance < best) std::tie(best, nearest[i]) = std::pair{distance, c};
      }
    });
  }
  return nearest;
}

/// Returns the pixels i with begin ≤ i < end whose centres lie in [low, high].
std::pair<int, int> pixels_between(double low, double high, int size) {
  return {static_cast<int>(std::ceil(std::clamp(low, 0.0, static_cast<double>(size)))),
          static_cast<int>(std::floor(std::clamp(high, -1.0, static_cast<double>(size - 1)))) + 1};
}

}  // namespace

std::vector<Ellipsoid> fitted_ellipsoids(std::span<const Eigen::Vector3d> points, double cell_m, double point_m) {
  std::vector<Eigen::Vector3d> centers = first_centers(points, cell_m);
  std::vector<double> counts;
  std::vector<std::size_t> owner;
  for (int round = 0; round < kRounds; ++round) {
    owner = nearest_centers(points, centers, cell_m);
    std::vector<Eigen::Vector3d> sums(centers.size(), Eigen::Vector3d::Zero());
    counts.assign(centers.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      sums[owner[i]] += points[i];
      counts[owner[i]] += 1.0;
    }
    for (std::size_t c = 0; c < centers.size(); ++c) {
      if (counts[c] > 0.0) centers[c] = sums[c] / counts[c];
    }
  }
  std::vector<Eigen::Matrix3d> moments(centers.size(), Eigen::Matrix3d::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d d = points[i] - centers[owner[i]];
    moments[owner[i]] += d * d.transpose();
  }
  std::vector<Ellipsoid> ellipsoids;
  for (std::size_t c = 0; c < centers.size(); ++c) {
    if (counts[c] == 0.0) continue;
    const Eigen::Matrix3d covariance = moments[c] / counts[c] + point_m * point_m / 12.0 * Eigen::Matrix3d::Identity();
    ellipsoids.push_back({centers[c], kSpread * kSpread * covariance});
  }
  return ellipsoids;
}

std::optional<Ellipse> projected(const Ellipsoid& ellipsoid, const Pose& T_camera_world, const PinholeCamera& camera) {
  const Eigen::Vector3d c = T_camera_world * ellipsoid.center;
  if (c.z() < camera.min_range_m || c.z() > camera.max_range_m) return std::nullopt;
  const Eigen::Matrix3d shape = T_camera_world.linear() * ellipsoid.shape * T_camera_world.linear().transpose();
  if (c.z() * c.z() <= shape(2, 2)) return std::nullopt;
  Eigen::Matrix3d intrinsics;
  intrinsics << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0;
  // Dual of the outline: planes through the camera's centre that touch the ellipsoid.
  const Eigen::Matrix3d dual = intrinsics * (shape - c * c.transpose()) * intrinsics.transpose();
  Ellipse ellipse;
  ellipse.depth_m = c.z();
  const auto range = [&](Eigen::Index axis, int size) {
    const double middle = dual(axis, 2) / dual(2, 2);
    const double half = std::sqrt(std::max(0.0, middle * middle - dual(axis, axis) / dual(2, 2)));
    return pixels_between(middle - half, middle + half, size);
  };
  std::tie(ellipse.u_begin, ellipse.u_end) = range(0, camera.width);
  std::tie(ellipse.v_begin, ellipse.v_end) = range(1, camera.height);
  if (ellipse.u_begin >= ellipse.u_end || ellipse.v_begin >= ellipse.v_end) return std::nullopt;
  ellipse.conic = dual.inverse();
  const Eigen::Vector3d middle{dual(0, 2) / dual(2, 2), dual(1, 2) / dual(2, 2), 1.0};
  if (middle.dot(ellipse.conic * middle) > 0.0) ellipse.conic = -ellipse.conic;
  return ellipse;
}

}  // namespace saccade
