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
  SimulatedClick click;
  const auto is_open = [&](const ErrorRegion& region) {
    click.point = region_centre(forest_.neighbourhood(), ends_, region);
    click.label = region.truth;
    return segments_.empty() || !painted_.contains(segments_[click.point]);
  };
  if (std::none_of(regions.begin(), regions.end(), is_open)) return std::nullopt;
  const std::uint32_t segment = segments_.empty() ? kNoLabel : segments_[click.point];
  if (segment != kNoLabel && accepts(segment, click.label)) {
    click.segment = true;
    paint(segment, click.label);
  } else {
    if (forest_.is_root(click.point)) return std::nullopt;
    set(click);
  }
  click.score = score_annotation(labels_, truth_).value();
  return click;
}

void SimulatedAnnotator::set(SimulatedClick& click) {
  const bool is_guarded = forest_.neighbourhood().config().strong_borders &&
                          std::any_of(label_of_root_.begin(), label_of_root_.end(),
                                      [&](const auto& other) { return other.second == click.label; });
  const Stopwatch stopwatch;
  forest_.add({click.point, is_guarded ? click_start(forest_, click.point) : 0.0});
  click.add_ms = stopwatch.elapsed_ms();
  label_of_root_[click.point] = click.label;
  for (const std::uint32_t point : forest_.touched()) {
    const bool is_painted = !segments_.empty() && painted_.contains(segments_[point]);
    if (!is_painted) labels_[point] = label_of_root_.at(*forest_.root_of(point));
  }
}

void SimulatedAnnotator::offer_segments(std::vector<std::uint32_t> segments) {
  SACCADE_EXPECTS(segments.size() == truth_.size());
  segments_ = std::move(segments);
}

bool SimulatedAnnotator::accepts(std::uint32_t segment, std::uint32_t label) const {
  constexpr double kLeastShare{0.95};
  std::size_t known{0};
  std::size_t wanted{0};
  for (std::size_t point = 0; point < truth_.size(); ++point) {
    if (segments_[point] != segment || truth_[point] == kNoLabel) continue;
    ++known;
    wanted += truth_[point] == label ? 1 : 0;
  }
  return static_cast<double>(wanted) >= kLeastShare * static_cast<double>(known);
}

void SimulatedAnnotator::paint(std::uint32_t segment, std::uint32_t label) {
  painted_.insert(segment);
  for (std::uint32_t point = 0; point < labels_.size(); ++point) {
    if (segments_[point] == segment) labels_[point] = label;
  }
}

}  // namespace saccade
