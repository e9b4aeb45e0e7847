// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/simulated_annotator.hpp"

#include <algorithm>
#include <utility>

#include "saccade/annotate/click_start.hpp"
#include "saccade/core/clock.hpp"

namespace saccade {

Result<SimulatedAnnotator> SimulatedAnnotator::create(std::shared_ptr<const Neighbourhood> neighbourhood,
                                                      const PointCloud& cloud, std::vector<std::uint32_t> truth) {
  if (truth.size() != neighbourhood->size() || cloud.positions_m.size() != truth.size()) {
    return Error{Errc::size_mismatch, "the truth must have one label per point", "simulated annotator"};
  }
  for (std::uint32_t point = 0; point < truth.size(); ++point) {
    if (neighbourhood->edges(neighbourhood->node_of(point)).empty())
      truth[point] = 0;  // such as points that are not finite
  }
  if (std::all_of(truth.begin(), truth.end(), [](std::uint32_t label) { return label == 0; })) {
    return Error{Errc::invalid_argument, "there is no label but 0 on points that have neighbours to spread to", {}};
  }
  std::vector<std::uint8_t> ends = cloud_ends(*neighbourhood, cloud.positions_m, cloud.normals);
  return SimulatedAnnotator{std::move(neighbourhood), std::move(truth), std::move(ends)};
}

SimulatedAnnotator::SimulatedAnnotator(std::shared_ptr<const Neighbourhood> neighbourhood,
                                       std::vector<std::uint32_t> truth, std::vector<std::uint8_t> ends)
    : forest_{std::move(neighbourhood)}, truth_{std::move(truth)}, ends_{std::move(ends)}, labels_(truth_.size(), 0) {}

std::optional<SimulatedClick> SimulatedAnnotator::next() {
  const std::vector<ErrorRegion> regions = error_regions(forest_.neighbourhood(), labels_, truth_).value();
  if (regions.empty()) return std::nullopt;
  SimulatedClick click;
  click.point = region_centre(forest_.neighbourhood(), ends_, regions.front());
  click.label = regions.front().truth;
  if (forest_.is_root(click.point)) return std::nullopt;
  const bool is_guarded = forest_.neighbourhood().config().strong_borders &&
                          std::any_of(label_of_root_.begin(), label_of_root_.end(),
                                      [&](const auto& other) { return other.second == click.label; });
  const Stopwatch stopwatch;
  forest_.add({click.point, is_guarded ? click_start(forest_, click.point) : 0.0});
  click.add_ms = stopwatch.elapsed_ms();
  label_of_root_[click.point] = click.label;
  for (const std::uint32_t point : forest_.touched()) labels_[point] = label_of_root_.at(*forest_.root_of(point));
  click.score = score_annotation(labels_, truth_).value();
  return click;
}

}  // namespace saccade
