// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/voxel_cloud.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "saccade/cloud/internal/cell_blocks.hpp"

namespace saccade {

namespace {

constexpr std::size_t kVoxelPointGrain{8192};
constexpr std::size_t kVoxelGrain{1024};

/// Sums over points that give their plane and mean: x y z, xx xy xz yy yz zz, and their number.
struct VoxelMoments {
  Eigen::Array<double, 10, 1> sums{Eigen::Array<double, 10, 1>::Zero()};

  void add(const Eigen::Vector3d& p) {
    sums.head<3>() += p.array();
    sums.segment<3>(3) += p.x() * p.array();
    sums[6] += p.y() * p.y();
    sums[7] += p.y() * p.z();
    sums[8] += p.z() * p.z();
    sums[9] += 1.0;
  }
  [[nodiscard]] double count() const { return sums[9]; }
  [[nodiscard]] Eigen::Vector3d mean() const { return (sums.head<3>() / count()).matrix(); }
};

/// Returns the eigenvector of the smallest eigenvalue of a symmetric matrix without negative eigenvalues and with trace
/// 1. Zero where two eigenvalues are close to zero, or all are alike.
Eigen::Vector3d least_eigenvector(const Eigen::Matrix3d& m) {
  constexpr double kThinnest{1e-6};  // share of the squared spread; anything thinner is a line
  const double minors = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1) + m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2) +
                        m(1, 1) * m(2, 2) - m(1, 2) * m(1, 2);
  const double determinant = m.determinant();
  // Newton's method from below converges to the smallest root of λ³ − λ² + minors · λ − determinant.
  double least{0.0};
  for (int step = 0; step < 30; ++step) {
    const double slope = (3.0 * least - 2.0) * least + minors;
    const double value = ((least - 1.0) * least + minors) * least - determinant;
    if (!(slope > 0.0) || value >= 0.0) break;
    const double next = least - value / slope;
    if (!(next - least > 1e-12)) break;
    least = next;
  }
  const double others = 1.0 - least;
  const double product = minors - least * others;
  const double middle = 0.5 * (others - std::sqrt(std::max(0.0, others * others - 4.0 * product)));
  if (middle < kThinnest) return Eigen::Vector3d::Zero();
  const Eigen::Matrix3d rows = m - least * Eigen::Matrix3d::Identity();
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (const int i : {0, 1, 2}) {
    const Eigen::Vector3d across = rows.col(i).cross(rows.col((i + 1) % 3));
    if (across.squaredNorm() > longest.squaredNorm()) longest = across;
  }
  return longest.squaredNorm() > 1e-24 ? Eigen::Vector3d{longest.normalized()}
                                       : Eigen::Vector3d{Eigen::Vector3d::Zero()};
}

/// Returns the normal of the plane through the points, towards the viewpoint; the direction to the viewpoint where they
/// span no plane.
Eigen::Vector3f plane_normal(const VoxelMoments& moments, const Eigen::Vector3d& to_viewpoint) {
  const Eigen::Vector3d mean = moments.mean();
  const auto& s = moments.sums;
  Eigen::Matrix3d covariance;
  covariance << s[3], s[4], s[5], s[4], s[6], s[7], s[5], s[7], s[8];
  covariance = covariance / moments.count() - mean * mean.transpose();
  const double spread = covariance.trace();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  if (spread > 1e-12 * mean.squaredNorm())
    normal = least_eigenvector(covariance / spread);  // otherwise only rounding is left
  if (normal.isZero(0.0)) {
    const double distance_m = to_viewpoint.norm();
    return distance_m > 0.0 ? Eigen::Vector3f{(to_viewpoint / distance_m).cast<float>()} : Eigen::Vector3f::UnitZ();
  }
  return (normal.dot(to_viewpoint) < 0.0 ? Eigen::Vector3d{-normal} : normal).cast<float>();
}

/// Returns the sums over each voxel and its neighbours.
std::vector<VoxelMoments> with_neighbours(const VoxelCloud& cloud, const std::vector<VoxelMoments>& moments,
                                          const Executor& executor) {
  std::vector<VoxelMoments> sums(moments.size());
  executor.parallel_for(moments.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel) {
      Eigen::Array<double, 10, 1> sum = moments[voxel].sums;
      for (const std::uint32_t other : cloud.neighbours(static_cast<std::uint32_t>(voxel))) sum += moments[other].sums;
      sums[voxel].sums = sum;
    }
  });
  return sums;
}

void find_neighbours(VoxelCloud& cloud, const CellBlocks& index, const Executor& executor) {
  const std::size_t count = index.size();
  std::vector<std::vector<std::uint32_t>> chunks((count + kVoxelGrain - 1) / kVoxelGrain);
  cloud.starts.assign(count + 1, 0);
  executor.parallel_for(count, kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& chunk = chunks[begin / kVoxelGrain];
    chunk.resize(CellBlocks::kAround * (end - begin));
    std::uint32_t* next = chunk.data();
    for (std::size_t voxel = begin; voxel < end; ++voxel) {
      std::uint32_t* const first = next;
      next = index.around(static_cast<std::uint32_t>(voxel), next);
      cloud.starts[voxel + 1] = static_cast<std::uint32_t>(next - first);
    }
    chunk.resize(static_cast<std::size_t>(next - chunk.data()));
  });
  for (std::size_t voxel = 0; voxel < count; ++voxel) cloud.starts[voxel + 1] += cloud.starts[voxel];
  cloud.ids.reserve(cloud.starts.back());
  for (const std::vector<std::uint32_t>& chunk : chunks) cloud.ids.insert(cloud.ids.end(), chunk.begin(), chunk.end());
}

/// Sums over the points of one voxel.
struct VoxelSums {
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};
  Eigen::Vector3d color{Eigen::Vector3d::Zero()};
};

bool is_direction(const Eigen::Vector3f& v) { return v.allFinite() && v.squaredNorm() > 0.0F; }

}  // namespace

Status VoxelCloudConfig::validate() const {
  if (!(std::isfinite(voxel_size_m) && voxel_size_m > 0.0)) {
    return Error{Errc::invalid_argument, "voxel_size_m must be positive", "voxel cloud"};
  }
  if (!viewpoint_m.allFinite()) return Error{Errc::invalid_argument, "viewpoint_m must be finite", "voxel cloud"};
  return {};
}

Result<VoxelCloud> voxelise(const PointCloud& cloud, const VoxelCloudConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(cloud.validate());
  const std::size_t points = cloud.positions_m.size();
  const auto place_of = [&](const Eigen::Vector3f& p) {
    return config.single_camera ? Eigen::Vector3f{p.x() / p.z(), p.y() / p.z(), std::log(p.z())} : p;
  };
  std::vector<std::uint64_t> cells(points);
  executor.parallel_for(points, kVoxelPointGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = cloud.positions_m[i];
      const bool is_point = p.allFinite() && !(config.single_camera && !(p.z() > 0.0F));
      cells[i] = is_point ? cell_at(place_of(p), config.voxel_size_m) : kNoCell;
    }
  });

  // Voxels in the order of their first points.
  VoxelCloud made;
  made.voxel_of.assign(points, kUnlabelled);
  CellBlocks index;
  std::vector<VoxelMoments> moments;
  std::vector<VoxelSums> sums;  // only where the cloud has normals or colours
  const bool has_sums = !cloud.normals.empty() || !cloud.colors.empty();
  for (std::size_t i = 0; i < points;) {
    if (cells[i] == kNoCell) {
      ++i;
      continue;
    }
    if (cells[i] == kFarCell) {
      return Error{Errc::invalid_argument, "a point farther than a million voxels; leave it out or take larger voxels",
                   "point " + std::to_string(i)};
    }
    const std::uint32_t voxel = index.insert(cells[i]);
    if (voxel == moments.size()) {
      moments.emplace_back();
      if (has_sums) sums.emplace_back();
    }
    VoxelMoments here = moments[voxel];
    for (const std::uint64_t cell = cells[i]; i < points && cells[i] == cell; ++i) {
      made.voxel_of[i] = voxel;
      here.add(cloud.positions_m[i].cast<double>());
      if (!cloud.normals.empty() && is_direction(cloud.normals[i])) {
        sums[voxel].normal += cloud.normals[i].cast<double>().normalized();
      }
      if (!cloud.colors.empty()) sums[voxel].color += cloud.colors[i].cast<double>();
    }
    moments[voxel] = here;
  }
  find_neighbours(made, index, executor);

  const std::vector<VoxelMoments> near = with_neighbours(made, with_neighbours(made, moments, executor), executor);
  made.voxels.resize(moments.size());
  executor.parallel_for(moments.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double count = moments[v].count();
      const Eigen::Vector3d position_m = moments[v].mean();
      CloudVoxel& to = made.voxels[v];
      to.position_m = position_m.cast<float>();
      to.place = place_of(to.position_m);
      to.color.setZero();
      to.points = static_cast<std::uint32_t>(count);
      if (has_sums) to.color = (sums[v].color / count).cast<float>();
      const Eigen::Vector3f given =
          has_sums ? Eigen::Vector3f{sums[v].normal.cast<float>()} : Eigen::Vector3f{Eigen::Vector3f::Zero()};
      to.normal = given.squaredNorm() > 1e-12F ? Eigen::Vector3f{given.normalized()}
                                               : plane_normal(near[v], config.viewpoint_m - position_m);
    }
  });
  return made;
}

}  // namespace saccade
