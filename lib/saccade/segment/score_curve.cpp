// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/score_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saccade/segment/internal/surfel_graph.hpp"

namespace saccade {

namespace {

struct Labelling {
  std::vector<std::uint32_t> labels;
  std::size_t segments{0};
};

/// Computes a curve; `segment(threshold)` returns a Result<Labelling>.
template <class Segment>
Result<ScoreCurve> curve_over(std::span<const double> thresholds, const SegmentationTruth& truth,
                              const Executor& executor, const Progress& progress, const Segment& segment) {
  ScoreCurve curve;
  for (const double threshold : thresholds) {
    if (progress.cancelled()) return Error{Errc::cancelled, "interrupted", {}};
    progress.report("curve", curve.points.size(), thresholds.size());
    SACCADE_TRY(const Labelling found, segment(threshold));
    SACCADE_TRY(const SegmentationScore score, truth.score(found.labels, executor));
    curve.points.push_back({threshold, found.segments, score});
  }
  return curve;
}

}  // namespace

double ScoreCurve::area() const {
  std::vector<std::pair<double, double>> reached;  // recall, precision
  for (const CurvePoint& point : points) {
    const auto recall = point.score.recall();
    const auto precision = point.score.precision();
    if (recall && precision) reached.emplace_back(*recall, *precision);
  }
  std::sort(reached.begin(), reached.end(), std::greater<>{});
  double area{0.0}, best{0.0};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    best = std::max(best, reached[i].second);
    const double before = i + 1 < reached.size() ? reached[i + 1].first : 0.0;
    area += (reached[i].first - before) * best;
  }
  return area;
}

std::optional<CurvePoint> ScoreCurve::best_f() const {
  std::optional<CurvePoint> best;
  for (const CurvePoint& point : points) {
    if (point.score.f() && (!best || *point.score.f() > *best->score.f())) best = point;
  }
  return best;
}

std::optional<CurvePoint> ScoreCurve::least_bce() const {
  const auto least = std::min_element(
      points.begin(), points.end(), [](const CurvePoint& a, const CurvePoint& b) { return a.score.bce < b.score.bce; });
  return least == points.end() ? std::nullopt : std::optional<CurvePoint>{*least};
}

Result<ScoreCurve> flood_fill_curve(const PointCloud& cloud, const SegmentationTruth& truth,
                                    std::span<const double> thresholds, const FloodFillConfig& config,
                                    const Executor& executor, const Progress& progress) {
  SACCADE_TRY(const SurfelGraph graph, SurfelGraph::create(cloud));
  return curve_over(thresholds, truth, executor, progress, [&](double threshold) -> Result<Labelling> {
    FloodFillConfig at = config;
    at.threshold = threshold;
    SACCADE_TRY(SurfelComponents found, flood_fill(graph, cloud, at, executor));
    return Labelling{std::move(found.labels), found.count};
  });
}

Result<ScoreCurve> sv_lccp_curve(const SupervoxelResult& supervoxels, const SegmentationTruth& truth,
                                 std::span<const double> thresholds, const LccpConfig& config, const Executor& executor,
                                 const Progress& progress) {
  return curve_over(thresholds, truth, executor, progress, [&](double threshold) -> Result<Labelling> {
    if (!(threshold >= 0.0)) return Error{Errc::invalid_argument, "a threshold is negative or not a number", "curve"};
    SupervoxelResult pruned = supervoxels;
    prune_by_color(pruned, threshold);
    SACCADE_TRY(LccpResult found, segment_by_convexity(pruned, config));
    return Labelling{std::move(found.labels), found.segments};
  });
}

}  // namespace saccade
