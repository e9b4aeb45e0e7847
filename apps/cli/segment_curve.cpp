// SPDX-License-Identifier: Apache-2.0
// The curve of saccade segment: scores at many thresholds against true labels.
#include <iomanip>
#include <sstream>

#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "saccade/io/files/file_io.hpp"
#include "score_json.hpp"
#include "segment.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

Result<SegmentationTruth> read_truth(const SegmentOptions& options, const SegmentInput& input,
                                     const Executor& executor) {
  const std::filesystem::path& path = options.curve_truth;
  SACCADE_TRY(const CloudFile file, read_cloud(path));
  auto labels = labels_from_fields(file.fields());
  if (!labels) return in_file(labels.error(), path);
  if (labels->size() != input.cloud.positions_m.size()) {
    return Error{Errc::size_mismatch,
                 "has " + std::to_string(labels->size()) + " points, " + options.input.string() + " has " +
                     std::to_string(input.cloud.positions_m.size()) +
                     "; they must be the same points in the same order",
                 path.string()};
  }
  auto truth = surfel_truth(file.fields(), *labels, options.truth, executor);
  if (!truth) return in_file(truth.error(), path);
  if (truth->points() == 0) return Error{Errc::invalid_argument, "has no point with a label above 0", path.string()};
  return truth;
}

json point_json_of(const CurvePoint& point) {
  json made = score_json(point.score);
  made["threshold"] = point.threshold;
  made["segments"] = point.segments;
  return made;
}

json point_or_null(const std::optional<CurvePoint>& point) { return point ? point_json_of(*point) : json(nullptr); }

void write_row(const CurvePoint& point, std::ostream& text) {
  text << std::setw(9) << fixed(point.threshold, 4) << std::setw(10) << point.segments << std::setw(11)
       << fixed_or_dash(point.score.precision()) << std::setw(8) << fixed_or_dash(point.score.recall()) << std::setw(7)
       << fixed_or_dash(point.score.f()) << std::setw(7) << fixed(point.score.bce, 3) << '\n';
}

}  // namespace

Result<ScoreCurve> segment_curve(const SegmentOptions& options, const SegmentInput& input,
                                 const SegmentFindings& findings, const Executor& executor, ProgressBar& bar) {
  bar.update("truth", 0, 0);
  SACCADE_TRY(const SegmentationTruth truth, read_truth(options, input, executor));
  Progress progress{
      [&bar](std::string_view stage, std::size_t done, std::size_t total) { bar.update(stage, done, total); }};
  const CancelOnInterrupt cancel{progress};
  if (options.fills()) {
    return flood_fill_curve(input.cloud, truth, options.curve_thresholds, options.flood_fill, executor, progress);
  }
  return sv_lccp_curve(findings.supervoxels, truth, options.curve_thresholds, options.lccp, executor, progress);
}

json curve_json(const SegmentOptions& options, const ScoreCurve& curve) {
  json points = json::array();
  for (const CurvePoint& point : curve.points) points.push_back(point_json_of(point));
  return {{"truth", options.curve_truth.string()},
          {"tolerance_m", options.truth.config.matching.tolerance_m},
          {"split", options.truth.config.split},
          {"points", std::move(points)},
          {"area", curve.area()},
          {"best_f", point_or_null(curve.best_f())},
          {"least_bce", point_or_null(curve.least_bce())}};
}

std::string curve_text(const ScoreCurve& curve) {
  std::ostringstream text;
  text << "\nthreshold  segments  precision  recall      F    BCE\n";
  for (const CurvePoint& point : curve.points) write_row(point, text);
  const auto best = curve.best_f();
  const auto least = curve.least_bce();
  text << "area under precision over recall " << fixed(curve.area(), 3);
  if (best) text << ", greatest F " << fixed(*best->score.f(), 3) << " at " << fixed(best->threshold, 4);
  if (least) text << ", least BCE " << fixed(least->score.bce, 3) << " at " << fixed(least->threshold, 4);
  text << '\n';
  return text.str();
}

}  // namespace saccade::cli
