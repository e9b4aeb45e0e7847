// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/flood_fill.hpp"

#include <cmath>

namespace saccade {

namespace {

bool is_known(const Eigen::Vector3f& normal) { return normal.allFinite() && !normal.isZero(0.0F); }

/// What eq. (4.14) compares, by node.
struct Look {
  Eigen::Vector3f color{Eigen::Vector3f::Zero()};
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
};

std::vector<Look> looks_of(const SurfelGraph& graph, const PointCloud& cloud) {
  const std::span<const std::uint32_t> surfels = graph.surfels();
  std::vector<Look> looks(surfels.size());
  for (std::size_t n = 0; n < looks.size(); ++n) {
    if (!cloud.colors.empty()) looks[n].color = cloud.colors[surfels[n]];
    if (!cloud.normals.empty() && is_known(cloud.normals[surfels[n]])) looks[n].normal = cloud.normals[surfels[n]];
  }
  return looks;
}

}  // namespace

Status FloodFillConfig::validate() const {
  for (const double number : {color_weight, normal_weight, threshold}) {
    if (!(std::isfinite(number) && number >= 0.0)) {
      return Error{Errc::invalid_argument, "a number that is not finite, or negative", "flood fill"};
    }
  }
  return {};
}

double surfel_difference(const Eigen::Vector3f& color_a, const Eigen::Vector3f& normal_a,
                         const Eigen::Vector3f& color_b, const Eigen::Vector3f& normal_b,
                         const FloodFillConfig& config) {
  const double of_colors = (color_a.cast<double>() - color_b.cast<double>()).norm();
  double difference = config.color_weight * of_colors;
  if (is_known(normal_a) && is_known(normal_b)) {
    difference += config.normal_weight * (1.0 - normal_a.cast<double>().dot(normal_b.cast<double>()));
  }
  return difference;
}

Result<SurfelComponents> flood_fill(const SurfelGraph& graph, const PointCloud& cloud, const FloodFillConfig& config,
                                    const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(cloud.validate());
  if (graph.points() != cloud.positions_m.size()) {
    return Error{Errc::size_mismatch, "the graph is of another cloud", "flood fill"};
  }
  const std::vector<Look> looks = looks_of(graph, cloud);
  return connected_surfels(graph, executor, [&](std::uint32_t a, std::uint32_t b) {
    return surfel_difference(looks[a].color, looks[a].normal, looks[b].color, looks[b].normal, config) <
           config.threshold;
  });
}

Result<SurfelComponents> flood_fill(const PointCloud& cloud, const FloodFillConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const SurfelGraph graph, SurfelGraph::create(cloud));
  return flood_fill(graph, cloud, config, executor);
}

}  // namespace saccade
