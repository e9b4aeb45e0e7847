// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/segmentation_truth.hpp"

#include <algorithm>
#include <utility>

#include "saccade/segment/internal/boundary.hpp"
#include "saccade/segment/internal/boundary_matching.hpp"
#include "saccade/segment/internal/surfel_graph.hpp"
#include "saccade/segment/overlap.hpp"

namespace saccade {

namespace {

std::optional<double> share(double part, std::size_t all) {
  return all == 0 ? std::nullopt : std::optional<double>{part / static_cast<double>(all)};
}

std::size_t count_labels(std::vector<std::uint32_t> labels) {
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  return labels.size() - (!labels.empty() && labels.back() == kUnlabelled ? 1 : 0);
}

}  // namespace

std::optional<double> SegmentationScore::precision() const { return share(static_cast<double>(matched), boundary); }

std::optional<double> SegmentationScore::recall() const { return share(static_cast<double>(matched), true_boundary); }

std::optional<double> SegmentationScore::f() const {
  return share(2.0 * static_cast<double>(matched), boundary + true_boundary);
}

SegmentationTruth::SegmentationTruth(BoundaryFinder finder) : finder_{std::move(finder)} {}

Result<SegmentationTruth> SegmentationTruth::create(const PointCloud& cloud, std::span<const std::uint32_t> labels,
                                                    const SegmentationTruthConfig& config, const Executor& executor) {
  SACCADE_CHECK(cloud.validate());
  SACCADE_CHECK(config.matching.validate());
  if (labels.size() != cloud.positions_m.size()) {
    return Error{Errc::size_mismatch, "one true label per point is needed", "truth"};
  }
  std::vector<std::uint32_t> points = finite_points(cloud.positions_m);
  std::erase_if(points, [&](std::uint32_t point) { return labels[point] == kUnlabelled; });
  SACCADE_TRY(BoundaryFinder finder,
              BoundaryFinder::create(cloud.positions_m, points, config.matching.tolerance_m, executor));
  SegmentationTruth truth{std::move(finder)};
  truth.config_ = config;
  truth.positions_m_ = cloud.positions_m;
  truth.points_ = points.size();
  truth.labels_.assign(labels.size(), kUnlabelled);
  for (const std::uint32_t point : points) truth.labels_[point] = labels[point];
  if (config.split) {
    SACCADE_TRY(const SurfelGraph graph, SurfelGraph::create(cloud));
    SACCADE_TRY(SurfelComponents parts, split_unconnected(graph, truth.labels_, executor));
    truth.labels_ = std::move(parts.labels);
  }
  truth.segments_ = count_labels(truth.labels_);
  truth.boundary_ = truth.finder_->boundary(truth.labels_, executor);
  return truth;
}

Result<SegmentationScore> SegmentationTruth::score(std::span<const std::uint32_t> labels,
                                                   const Executor& executor) const {
  if (labels.size() != labels_.size()) {
    return Error{Errc::size_mismatch, "as many labels as true labels are needed", "score"};
  }
  const std::vector<std::uint32_t> boundary = finder_->boundary(labels, executor);
  SACCADE_TRY(const BoundaryMatching matching, match_boundaries(positions_m_, boundary, boundary_, config_.matching));
  SACCADE_TRY(const ConsistencyError error, consistency_error(labels, labels_));
  SegmentationScore score;
  score.boundary = boundary.size();
  score.true_boundary = boundary_.size();
  score.matched = matching.pairs.size();
  if (score.matched > 0) score.distance_m = matching.distance_m / static_cast<double>(score.matched);
  score.bce = error.bidirectional;
  return score;
}

}  // namespace saccade
