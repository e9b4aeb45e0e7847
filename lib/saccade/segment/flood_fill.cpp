// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/flood_fill.hpp"

#include <cmath>

#include "saccade/segment/internal/surfel_graph.hpp"

namespace saccade {

namespace {

bool is_known(const Eigen::Vector3f& normal) { return normal.allFinite() && !normal.isZero(0.0F); }

/// Values that eq. (4.14) compares, by node.
struct Look {
  Eigen::Vector3f color{Eigen::Vector3f::Zero()};
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
  float has_normal{0.0F};  ///< 1 or 0
};

/// As surfel_difference, with known validity of the normals.
double difference_of(const Look& a, const Look& b, const FloodFillConfig& config) {
  const double of_colors = (a.color.cast<double>() - b.color.cast<double>()).norm();
  const double of_normals = 1.0 - a.normal.cast<double>().dot(b.normal.cast<double>());
  const double both = config.unknown_is_alike ? static_cast<double>(a.has_normal * b.has_normal) : 1.0;
  return config.color_weight * of_colors + config.normal_weight * (both * of_normals);
}

Look look_at(const Eigen::Vector3f& color, const Eigen::Vector3f& normal) {
  if (!is_known(normal)) return {color, Eigen::Vector3f::Zero(), 0.0F};
  return {color, normal, 1.0F};
}

std::vector<Look> looks_of(const SurfelGraph& graph, const PointCloud& cloud) {
  const std::span<const std::uint32_t> surfels = graph.surfels();
  std::vector<Look> looks(surfels.size());
  for (std::size_t n = 0; n < looks.size(); ++n) {
    const Eigen::Vector3f none = Eigen::Vector3f::Zero();
    looks[n] = look_at(cloud.colors.empty() ? none : cloud.colors[surfels[n]],
                       cloud.normals.empty() ? none : cloud.normals[surfels[n]]);
  }
  return looks;
}

}  // namespace

Status FloodFillConfig::validate() const {
  for (const double number : {color_weight, normal_weight, threshold}) {
    if (!(std::isfinite(number) && number >= 0.0)) {
      return Error{Errc::invalid_argument, "a number is not finite, or negative", "flood fill"};
    }
  }
  return {};
}

double surfel_difference(const Eigen::Vector3f& color_a, const Eigen::Vector3f& normal_a,
                         const Eigen::Vector3f& color_b, const Eigen::Vector3f& normal_b,
                         const FloodFillConfig& config) {
  return difference_of(look_at(color_a, normal_a), look_at(color_b, normal_b), config);
}

Result<SurfelComponents> flood_fill(const SurfelGraph& graph, const PointCloud& cloud, const FloodFillConfig& config,
                                    const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(cloud.validate());
  if (graph.points() != cloud.positions_m.size()) {
    return Error{Errc::size_mismatch, "the graph is of another cloud", "flood fill"};
  }
  const std::vector<Look> looks = looks_of(graph, cloud);
  FloodFillConfig filling = config;
  filling.unknown_is_alike = config.unknown_is_alike || cloud.normals.empty();
  return connected_surfels(graph, executor, [&](std::uint32_t a, std::uint32_t b) {
    return difference_of(looks[a], looks[b], filling) < filling.threshold;
  });
}

Result<SurfelComponents> flood_fill(const PointCloud& cloud, const FloodFillConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const SurfelGraph graph, SurfelGraph::create(cloud));
  return flood_fill(graph, cloud, config, executor);
}

}  // namespace saccade
