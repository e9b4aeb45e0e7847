// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/voxel_cloud.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "saccade/segment/cell_index.hpp"

namespace saccade {

namespace {

constexpr std::size_t kPointGrain{8192};
constexpr std::size_t kVoxelGrain{1024};

/// Sums over points, of which plane and mean come.
struct Moments {
  Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
  std::array<double, 6> squares{};  ///< xx xy xz yy yz zz
  double count{0.0};

  void add(const Eigen::Vector3d& p) {
    sum += p;
    squares[0] += p.x() * p.x();
    squares[1] += p.x() * p.y();
    squares[2] += p.x() * p.z();
    squares[3] += p.y() * p.y();
    squares[4] += p.y() * p.z();
    squares[5] += p.z() * p.z();
    count += 1.0;
  }
  void operator+=(const Moments& other) {
    sum += other.sum;
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += other.squares[i];
    count += other.count;
  }
};

/// Of the plane through the points, towards the viewpoint.
Eigen::Vector3f plane_normal(const Moments& moments, const Eigen::Vector3d& to_viewpoint) {
  const Eigen::Vector3d mean = moments.sum / moments.count;
  const std::array<double, 6>& s = moments.squares;
  Eigen::Matrix3d covariance;
  covariance << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  covariance = covariance / moments.count - mean * mean.transpose();
  const double spread = covariance.trace();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  const bool one_place = !(spread > 1e-12 * mean.squaredNorm());  // what is left is rounding
  if (!one_place) solver.computeDirect(covariance / spread);
  constexpr double kThinnest{1e-6};  // of the spread, squared: thinner is a line
  if (one_place || solver.eigenvalues()[1] < kThinnest) {
    const double distance_m = to_viewpoint.norm();
    return distance_m > 0.0 ? Eigen::Vector3f{(to_viewpoint / distance_m).cast<float>()} : Eigen::Vector3f::UnitZ();
  }
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  return (normal.dot(to_viewpoint) < 0.0 ? Eigen::Vector3d{-normal} : normal).cast<float>();
}

/// The sums over each voxel and those next to it.
std::vector<Moments> with_neighbours(const VoxelCloud& cloud, const std::vector<Moments>& moments,
                                     const Executor& executor) {
  std::vector<Moments> sums(moments.size());
  executor.parallel_for(moments.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel) {
      sums[voxel] = moments[voxel];
      for (const std::uint32_t other : cloud.neighbours(static_cast<std::uint32_t>(voxel)))
        sums[voxel] += moments[other];
    }
  });
  return sums;
}

void find_neighbours(VoxelCloud& cloud, const CellIndex& index, const Executor& executor) {
  const std::size_t count = index.cells().size();
  std::vector<std::vector<std::uint32_t>> chunks((count + kVoxelGrain - 1) / kVoxelGrain);
  cloud.starts.assign(count + 1, 0);
  executor.parallel_for(count, kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& chunk = chunks[begin / kVoxelGrain];
    chunk.reserve(16 * (end - begin));
    for (std::size_t voxel = begin; voxel < end; ++voxel) {
      const std::size_t before = chunk.size();
      for (const std::uint64_t offset : neighbour_offsets()) {
        const std::uint32_t other = index.find(index.cells()[voxel] + offset);
        if (other != kUnlabelled) chunk.push_back(other);
      }
      cloud.starts[voxel + 1] = static_cast<std::uint32_t>(chunk.size() - before);
    }
  });
  for (std::size_t voxel = 0; voxel < count; ++voxel) cloud.starts[voxel + 1] += cloud.starts[voxel];
  cloud.ids.reserve(cloud.starts.back());
  for (const std::vector<std::uint32_t>& chunk : chunks) cloud.ids.insert(cloud.ids.end(), chunk.begin(), chunk.end());
}

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

  // Places, and the cells that they lie in.
  std::vector<Eigen::Vector3f> places(points);
  std::vector<std::uint64_t> cells(points);
  executor.parallel_for(points, kPointGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = cloud.positions_m[i];
      cells[i] = kNoCell;
      if (!p.allFinite() || (config.single_camera && !(p.z() > 0.0F))) continue;
      places[i] = config.single_camera ? Eigen::Vector3f{p.x() / p.z(), p.y() / p.z(), std::log(p.z())} : p;
      cells[i] = cell_at(places[i], config.voxel_size_m);
    }
  });

  // Voxels in the order of their first points.
  VoxelCloud made;
  made.voxel_of.assign(points, kUnlabelled);
  CellIndex index;
  std::vector<Moments> moments;
  std::vector<Eigen::Vector3d> place_sums, normal_sums, color_sums;
  std::uint32_t voxel{kUnlabelled};
  for (std::size_t i = 0; i < points; ++i) {
    if (cells[i] == kNoCell) continue;
    if (cells[i] == kFarCell) {
      return Error{Errc::invalid_argument, "a point farther than a million voxels; leave it out or take larger voxels",
                   "point " + std::to_string(i)};
    }
    if (voxel == kUnlabelled || index.cells()[voxel] != cells[i]) voxel = index.insert(cells[i]);
    if (voxel == moments.size()) {
      moments.emplace_back();
      place_sums.emplace_back(Eigen::Vector3d::Zero());
      normal_sums.emplace_back(Eigen::Vector3d::Zero());
      color_sums.emplace_back(Eigen::Vector3d::Zero());
    }
    made.voxel_of[i] = voxel;
    moments[voxel].add(cloud.positions_m[i].cast<double>());
    place_sums[voxel] += places[i].cast<double>();
    if (!cloud.normals.empty() && is_direction(cloud.normals[i])) {
      normal_sums[voxel] += cloud.normals[i].cast<double>().normalized();
    }
    if (!cloud.colors.empty()) color_sums[voxel] += cloud.colors[i].cast<double>();
  }
  find_neighbours(made, index, executor);

  const std::vector<Moments> near = with_neighbours(made, with_neighbours(made, moments, executor), executor);
  made.voxels.resize(moments.size());
  executor.parallel_for(moments.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double count = moments[v].count;
      const Eigen::Vector3d position_m = moments[v].sum / count;
      CloudVoxel& to = made.voxels[v];
      to.place = (place_sums[v] / count).cast<float>();
      to.position_m = position_m.cast<float>();
      to.color = (color_sums[v] / count).cast<float>();
      to.points = static_cast<std::uint32_t>(count);
      const Eigen::Vector3f given = normal_sums[v].cast<float>();
      to.normal = given.squaredNorm() > 1e-12F ? Eigen::Vector3f{given.normalized()}
                                               : plane_normal(near[v], config.viewpoint_m - position_m);
    }
  });
  return made;
}

}  // namespace saccade
