// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "saccade/core/statistics.hpp"
#include "saccade/tracking/internal/mount_refinement.hpp"

namespace saccade {
namespace {

/// Calls meet(p_model, u, v) for every measured point for which the model's camera has a depth at pixel (u, v). Returns
/// the number of measured points.
template <class Meet>
std::size_t project(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                    const Pose& T_model_camera, int stride, Meet&& meet) {
  std::size_t points{0};
  for (int row = 0; row < measured.z.height(); row += stride) {
    for (int column = 0; column < measured.z.width(); column += stride) {
      const double z = static_cast<double>(measured.z(column, row));
      if (!(z > 0.0)) continue;
      ++points;
      const Eigen::Vector3d p_model = T_model_camera * (camera.ray(column, row) * z);
      if (p_model.z() < static_cast<double>(kMinModelDepth_m)) continue;
      const Eigen::Vector2d image = camera.project(p_model) + Eigen::Vector2d{0.5, 0.5};
      if (!(image.x() >= 0.0 && image.y() >= 0.0 && image.x() < camera.width && image.y() < camera.height)) continue;
      const int u = static_cast<int>(image.x());
      const int v = static_cast<int>(image.y());
      if (model.z(u, v) > 0.0F) meet(p_model, u, v);
    }
  }
  return points;
}

struct PairDistances {
  std::size_t points{0};
  std::vector<float> depth_m;
  std::vector<float> plane_m;
};

PairDistances distances_of(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                           const Pose& T_model_camera) {
  constexpr int kStride{4};
  PairDistances distances;
  project(measured, model, camera, T_model_camera, kStride, [&](const Eigen::Vector3d& p_model, int u, int v) {
    ++distances.points;
    const double z = static_cast<double>(model.z(u, v));
    const double difference_m = std::abs(p_model.z() - z);
    if (difference_m > ViewAgreement::kSameSurface_m) return;
    distances.depth_m.push_back(static_cast<float>(difference_m));
    const Eigen::Vector3d normal = Eigen::Vector3f{model.nx(u, v), model.ny(u, v), model.nz(u, v)}.cast<double>();
    if (normal.squaredNorm() < 0.5) return;  // unknown
    distances.plane_m.push_back(static_cast<float>(std::abs(normal.dot(p_model - camera.ray(u, v) * z))));
  });
  return distances;
}

void append(const std::vector<float>& from, std::vector<float>& to) { to.insert(to.end(), from.begin(), from.end()); }

}  // namespace

std::vector<ViewPair> overlapping_pairs(std::span<const PointImage* const> views, const PinholeCamera& camera,
                                        std::span<const Pose> T_world_camera, double min_overlap, std::size_t max_pairs,
                                        const Executor& executor) {
  const int stride = std::max(1, camera.width / 40);
  std::vector<std::vector<std::size_t>> models(views.size());
  executor.parallel_for(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < views.size(); ++j) {
        if (i == j) continue;
        std::size_t met{0};
        const std::size_t points =
            project(*views[i], *views[j], camera, T_world_camera[j].inverse() * T_world_camera[i], stride,
                    [&](const Eigen::Vector3d& p_model, int u, int v) {
                      const double z = static_cast<double>(views[j]->z(u, v));
                      if (std::abs(p_model.z() - z) < 0.1 + 0.05 * z) ++met;  // with a rough mount, too
                    });
        if (points > 0 && static_cast<double>(met) >= min_overlap * static_cast<double>(points)) models[i].push_back(j);
      }
    }
  });
  std::vector<ViewPair> all;
  for (std::size_t i = 0; i < models.size(); ++i) {
    for (const std::size_t j : models[i]) all.emplace_back(i, j);
  }
  if (all.size() <= max_pairs) return all;
  std::vector<ViewPair> chosen;
  for (std::size_t k = 0; k < max_pairs; ++k) chosen.push_back(all[k * all.size() / max_pairs]);
  return chosen;
}

ViewAgreement agreement_of(std::span<const PointImage* const> views, const PinholeCamera& camera,
                           std::span<const Pose> T_world_camera, std::span<const ViewPair> pairs,
                           const Executor& executor) {
  std::vector<PairDistances> by_pair(pairs.size());
  executor.parallel_for(pairs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [i, j] = pairs[k];
      by_pair[k] = distances_of(*views[i], *views[j], camera, T_world_camera[j].inverse() * T_world_camera[i]);
    }
  });
  ViewAgreement agreement;
  agreement.pairs = pairs.size();
  PairDistances all;
  for (const PairDistances& distances : by_pair) {
    all.points += distances.points;
    append(distances.depth_m, all.depth_m);
    append(distances.plane_m, all.plane_m);
  }
  agreement.points = all.points;
  if (all.depth_m.empty() || all.plane_m.empty()) return agreement;
  agreement.agreeing = static_cast<double>(all.depth_m.size()) / static_cast<double>(all.points);
  agreement.median_depth_m = static_cast<double>(upper_median(all.depth_m));
  agreement.median_plane_m = static_cast<double>(upper_median(all.plane_m));
  return agreement;
}

Eigen::Matrix3d normals_of(std::span<const PointImage* const> views, std::span<const Pose> T_world_camera) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PointImage& view = *views[i];
    const int edge = std::max(4, view.z.width() / 40);
    for (int row = 0; row + edge <= view.z.height(); row += edge) {
      for (int column = 0; column + edge <= view.z.width(); column += edge) {
        Eigen::Vector3d sum_camera = Eigen::Vector3d::Zero();
        int known{0};
        for (int v = row; v < row + edge; ++v) {
          for (int u = column; u < column + edge; ++u) {
            const Eigen::Vector3d normal = Eigen::Vector3f{view.nx(u, v), view.ny(u, v), view.nz(u, v)}.cast<double>();
            sum_camera += normal;
            known += normal.squaredNorm() > 0.5 ? 1 : 0;
          }
        }
        if (4 * known < edge * edge || sum_camera.norm() < 0.8 * known) continue;  // little was measured, or an edge
        const Eigen::Vector3d n_world = T_world_camera[i].linear() * sum_camera.normalized();
        sum += n_world * n_world.transpose();
      }
    }
  }
  return sum.trace() > 0.0 ? Eigen::Matrix3d{sum / sum.trace()} : sum;
}

}  // namespace saccade
