// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/carried_labels.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/cloud/nearest_places.hpp"
#include "saccade/cloud/nearest_points.hpp"

namespace saccade {
namespace {

constexpr std::size_t kMostNeighboursToCarry{64};

Error bad_carry(const char* what) { return {Errc::invalid_argument, what, "carry"}; }

/// Returns how far the label of each point reaches, 0 for points alone and points that are none.
std::vector<float> reaches_of(std::span<const Eigen::Vector3f> positions_m, const CarryConfig& config,
                              const Executor& executor) {
  std::vector<float> reaches_m(positions_m.size(), 0.0F);
  const NearestPlaces places = nearest_places(positions_m, config.neighbours, executor);
  const NearestNeighbours& near = places.neighbours;
  if (near.count == 0) return reaches_m;
  for (std::size_t node = 0; node < near.order.size(); ++node) {
    const float last_m = (near.positions_m[near.of(node).back()] - near.positions_m[node]).norm();
    reaches_m[near.order[node]] = static_cast<float>(config.spacings * static_cast<double>(last_m));
  }
  for (const PointCopy& copy : places.copies) reaches_m[copy.point] = reaches_m[copy.original];
  return reaches_m;
}

}  // namespace

Status CarryConfig::validate() const {
  if (!(spacings > 0.0 && std::isfinite(spacings))) return bad_carry("spacings must be positive");
  if (neighbours < 1 || neighbours > kMostNeighboursToCarry) return bad_carry("neighbours must be 1 to 64");
  return {};
}

Result<CarriedLabels> carry_labels(const CarrySource& source, std::span<const Eigen::Vector3f> positions_m,
                                   const Annotation& annotation, const CarryConfig& config, const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_EXPECTS(positions_m.size() == annotation.labels().size());
  if (source.labels.size() != source.positions_m.size()) return bad_carry("there must be one label per point");
  const std::vector<float> reaches_m = reaches_of(source.positions_m, config, executor);
  std::vector<Eigen::Vector3f> carried_m;
  carried_m.reserve(source.positions_m.size());
  for (const Eigen::Vector3f& p : source.positions_m) {
    carried_m.emplace_back((source.T_to_from * p.cast<double>()).cast<float>());
  }
  const float most_m = reaches_m.empty() ? 0.0F : *std::max_element(reaches_m.begin(), reaches_m.end());
  const std::vector<std::uint32_t> nearest = nearest_points(positions_m, carried_m, most_m, executor);
  const Neighbourhood& graph = annotation.forest().neighbourhood();
  CarriedLabels carried;
  for (std::uint32_t point = 0; point < nearest.size(); ++point) {
    if (nearest[point] == kNoNearPoint) continue;
    const std::uint32_t label = source.labels[nearest[point]];
    const float away_m = (carried_m[nearest[point]] - positions_m[point]).norm();
    if (label == kNoLabel || away_m > reaches_m[nearest[point]]) continue;
    if (annotation.label_of(point) != kNoLabel) {
      ++carried.kept;
    } else if (annotation.is_locked(label)) {
      ++carried.locked;
    } else if (!graph.edges(graph.node_of(point)).empty()) {
      carried.paint.points.push_back(point);
      carried.paint.labels.push_back(label);
    }
  }
  return carried;
}

}  // namespace saccade
