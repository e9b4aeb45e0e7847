// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kDiscsPerTask{4096};
constexpr int kBandRows{16};
constexpr float kEdgeOn{1e-3F};  ///< cosine between ray and disc below which a disc is invisible

/// Disc in the camera's frame, and the pixels that it may cover; none where it is behind or turned away.
struct ProjectedDisc {
  Eigen::Vector3f p_camera;
  Eigen::Vector3f n_camera;
  float radius_m{0.0F};
  int u0{0}, u1{-1}, v0{0}, v1{-1};
};

ProjectedDisc project_disc(const PinholeCamera& camera, const Eigen::Vector3f& p, const Eigen::Vector3f& n,
                           float radius_m) {
  ProjectedDisc disc{p, n, radius_m};
  if (!p.allFinite() || !(radius_m > 0.0F) || !(n.dot(p) < 0.0F) || !(p.z() > 2.0F * radius_m)) return disc;
  // Bounds of the ball around the disc, at its nearest depth, hence never too small.
  const auto cover = [&](double focal, double center, float offset, int size, int& first, int& last) {
    const double at = focal * static_cast<double>(offset / p.z()) + center;
    const double reach = focal * static_cast<double>(radius_m * (1.0F + std::abs(offset) / p.z()) / (p.z() - radius_m));
    first = static_cast<int>(std::clamp(std::ceil(at - reach), 0.0, static_cast<double>(size)));
    last = static_cast<int>(std::clamp(std::floor(at + reach), -1.0, static_cast<double>(size - 1)));
  };
  cover(camera.fx, camera.cx, p.x(), camera.width, disc.u0, disc.u1);
  cover(camera.fy, camera.cy, p.y(), camera.height, disc.v0, disc.v1);
  if (disc.u0 > disc.u1) disc.v1 = disc.v0 - 1;
  return disc;
}

/// Calls visit(u, v, depth, squared distance from the disc's centre) for the pixels of rows [begin, end) that see the
/// disc.
template <class Visit>
void for_each_pixel(const ProjectedDisc& disc, const PinholeCamera& camera, int begin, int end, const Visit& visit) {
  const float to_plane = disc.n_camera.dot(disc.p_camera);
  for (int v = std::max(begin, disc.v0); v <= std::min(end - 1, disc.v1); ++v) {
    for (int u = disc.u0; u <= disc.u1; ++u) {
      const Eigen::Vector3f ray = camera.ray(u, v).cast<float>();
      const float slope = disc.n_camera.dot(ray);
      if (slope > -kEdgeOn) continue;
      const float z = to_plane / slope;
      const float squared = (z * ray - disc.p_camera).squaredNorm();
      if (squared <= disc.radius_m * disc.radius_m) visit(u, v, z, squared);
    }
  }
}

}  // namespace

SurfelView view_surfels(const SurfelDiscs& discs, const PinholeCamera& camera, const Pose& T_world_camera,
                        const Executor& executor) {
  SACCADE_EXPECTS(discs.normals.size() == discs.positions_m.size() &&
                  discs.radii_m.size() == discs.positions_m.size() && discs.positions_m.size() < kNoSurfel);
  const Eigen::Isometry3f T_camera_world = T_world_camera.inverse(Eigen::Isometry).cast<float>();
  std::vector<ProjectedDisc> projected(discs.positions_m.size());
  executor.parallel_for(projected.size(), kDiscsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      projected[i] = project_disc(camera, T_camera_world * discs.positions_m[i],
                                  T_camera_world.linear() * discs.normals[i], discs.radii_m[i]);
    }
  });
  const int bands = (camera.height + kBandRows - 1) / kBandRows;
  std::vector<std::vector<SurfelId>> of_band(static_cast<std::size_t>(bands));
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const ProjectedDisc& disc = projected[i];
    if (disc.v0 > disc.v1) continue;
    for (int band = disc.v0 / kBandRows; band <= disc.v1 / kBandRows; ++band) {
      of_band[static_cast<std::size_t>(band)].push_back(static_cast<SurfelId>(i));
    }
  }
  constexpr float kNothing{std::numeric_limits<float>::infinity()};
  SurfelView view{Image<SurfelId>{camera.width, camera.height, kNoSurfel}, Image<float>{camera.width, camera.height}};
  executor.parallel_for(of_band.size(), 1, [&](std::size_t first, std::size_t last) {
    Image<float> nearest{camera.width, kBandRows};
    Image<float> least{camera.width, kBandRows};
    for (std::size_t band = first; band < last; ++band) {
      const int begin = static_cast<int>(band) * kBandRows;
      const int end = std::min(begin + kBandRows, camera.height);
      std::fill_n(nearest.data(), nearest.size(), kNothing);
      std::fill_n(least.data(), least.size(), kNothing);
      for (const SurfelId id : of_band[band]) {
        for_each_pixel(projected[id], camera, begin, end, [&](int u, int v, float z, float) {
          nearest(u, v - begin) = std::min(nearest(u, v - begin), z);
        });
      }
      for (const SurfelId id : of_band[band]) {
        const float behind_m = projected[id].radius_m;
        for_each_pixel(projected[id], camera, begin, end, [&](int u, int v, float z, float squared) {
          if (z > nearest(u, v - begin) + behind_m || !(squared < least(u, v - begin))) return;
          least(u, v - begin) = squared;
          view.seen(u, v) = id;
          view.depth(u, v) = z;
        });
      }
    }
  });
  return view;
}

}  // namespace saccade
