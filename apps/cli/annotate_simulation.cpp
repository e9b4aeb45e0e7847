// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "annotate.hpp"
#include "interrupt.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::cli {
namespace {

constexpr std::uint32_t kLabelsPerObject{10};
constexpr std::uint32_t kFirstObjectPart{20};

/// mOSD's: 1 to 9 are parts of the table, ten labels from 20 on are parts of one object each.
bool are_parts_in_tens(const std::vector<std::uint32_t>& labels) {
  bool table{false};
  bool objects{false};
  for (const std::uint32_t label : labels) {
    if (label >= kLabelsPerObject && label < kFirstObjectPart) return false;
    table |= label > 0 && label < kLabelsPerObject;
    objects |= label >= kFirstObjectPart;
  }
  return table && objects;
}

std::size_t most_actions(const AnnotateOptions& options, const SimulatedAnnotation& annotation) {
  return options.actions.value_or(static_cast<std::size_t>(options.clicks) * annotation.objects);
}

/// Returns the label that the score takes for no label.
std::optional<std::uint32_t> background_of(const AnnotateOptions& options, const std::vector<std::uint32_t>& truth) {
  if (!options.background_is_none) return std::nullopt;
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : truth) counts[label] += label == 0 ? 0 : 1;
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Error interrupted_error() { return Error{Errc::cancelled, "interrupted", {}}; }

Status click(const AnnotateOptions& options, const CloudJob& job, std::shared_ptr<const Neighbourhood> graph,
             const PointCloud& cloud, const std::vector<std::uint32_t>& truth, SimulatedAnnotation& annotation,
             AnnotateProgress& progress) {
  SACCADE_TRY(SimulatedAnnotator annotator,
              in_file(SimulatedAnnotator::create(std::move(graph), cloud, truth), job.truth));
  if (!job.segments.empty()) {
    SACCADE_TRY(std::vector<std::uint32_t> segments, read_labels(job.segments, cloud.positions_m.size()));
    annotator.offer_segments(std::move(segments));
  }
  const std::size_t clicks = most_actions(options, annotation);
  const std::optional<std::uint32_t> background = background_of(options, truth);
  while (annotation.clicks.size() < clicks) {
    if (interrupted()) return interrupted_error();
    progress.stage("clicks", annotation.clicks.size(), clicks);
    const std::optional<SimulatedClick> next = annotator.next();
    if (!next) break;
    if (!next->segment) annotation.add_ms.push_back(next->add_ms);
    SACCADE_TRY(const AnnotationScore score, score_annotation(annotator.labels(), truth, background));
    annotation.clicks.push_back({next->label, score.mean_iou, score.wrong});
  }
  annotation.labels = annotator.labels();
  ShortestPathForest& forest = annotator.forest();
  const std::vector<Root> roots = forest.roots();
  for (const Root& root : roots) {
    annotation.control_points.push_back(root.point);
    Stopwatch stopwatch;
    forest.remove(root.point);
    annotation.delete_ms.push_back(stopwatch.elapsed_ms());
    forest.add(root);
  }
  const Stopwatch stopwatch;
  forest.rebuild(roots);
  annotation.full_ms = stopwatch.elapsed_ms();
  return {};
}

Status drag_rectangles(const AnnotateOptions& options, const Neighbourhood& graph, const PointCloud& cloud,
                       const std::vector<std::uint32_t>& truth, const Executor& executor,
                       SimulatedAnnotation& annotation, AnnotateProgress& progress) {
  SACCADE_TRY(RectangleAnnotator annotator, RectangleAnnotator::create(cloud.positions_m, truth, {}, executor));
  const auto drag = [&]() -> std::optional<RectangleAction> {
    if (options.method == AnnotationMethod::best_rectangle) return annotator.next(executor);
    const std::vector<ErrorRegion> wrong = error_regions(graph, annotator.labels(), truth).value();
    return wrong.empty() ? std::nullopt : annotator.next_around(wrong.front(), executor);
  };
  const std::size_t actions = most_actions(options, annotation);
  const std::optional<std::uint32_t> background = background_of(options, truth);
  while (annotation.clicks.size() < actions) {
    if (interrupted()) return interrupted_error();
    progress.stage("rectangles", annotation.clicks.size(), actions);
    const std::optional<RectangleAction> next = drag();
    if (!next) break;
    SACCADE_TRY(const AnnotationScore score, score_annotation(annotator.labels(), truth, background));
    annotation.clicks.push_back({next->label, score.mean_iou, score.wrong});
  }
  annotation.labels = annotator.labels();
  return {};
}

}  // namespace

std::optional<std::size_t> SimulatedAnnotation::clicks_to(double iou_mean) const {
  const auto reached = std::find_if(clicks.begin(), clicks.end(),
                                    [iou_mean](const AnnotationStep& step) { return step.iou_mean >= iou_mean; });
  if (reached == clicks.end()) return std::nullopt;
  return static_cast<std::size_t>(reached - clicks.begin()) + 1;
}

AnnotationStep SimulatedAnnotation::after(std::size_t clicks_per_label) const {
  if (clicks.empty()) return {};
  return clicks[std::min(clicks_per_label * objects, clicks.size()) - 1];
}

Result<std::vector<std::uint32_t>> read_truth(const AnnotateOptions& options, const CloudJob& job,
                                              const PointCloud& cloud, AnnotateProgress& progress) {
  SACCADE_TRY(std::vector<std::uint32_t> truth, read_labels(job.truth, cloud.positions_m.size()));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!cloud.positions_m[i].allFinite()) truth[i] = 0;
  }
  if (options.tens == Tens::keep || (options.tens == Tens::detect && !are_parts_in_tens(truth))) return truth;
  if (options.tens == Tens::detect) {
    progress.note(
        "labels are 1 to 9 and from 20 on, as parts of objects in tens (mOSD): each ten is one; --tens keep: not");
  }
  for (std::uint32_t& label : truth) label = label == 0 ? 0 : std::max(1U, label / kLabelsPerObject);
  return truth;
}

Result<SimulatedAnnotation> simulate_annotation(const AnnotateOptions& options, const CloudJob& job,
                                                const PointCloud& cloud, const std::vector<std::uint32_t>& truth,
                                                const Executor& executor, AnnotateProgress& progress) {
  SACCADE_TRY(const AnnotationScore none, score_annotation(std::vector<std::uint32_t>(truth.size(), 0), truth));
  if (none.points == 0) {
    return Error{Errc::invalid_argument, "no point of the cloud has a label but 0 in it", job.truth.string()};
  }
  SimulatedAnnotation annotation;
  annotation.points = none.points;
  annotation.objects = none.objects.size();
  progress.stage("graph");
  const Stopwatch stopwatch;
  SACCADE_TRY(Neighbourhood built, in_file(build_graph(cloud, options.graph, options.room, executor), job.cloud));
  annotation.graph_ms = stopwatch.elapsed_ms();
  const auto graph = std::make_shared<const Neighbourhood>(std::move(built));
  if (options.method == AnnotationMethod::control_points) {
    SACCADE_CHECK(click(options, job, graph, cloud, truth, annotation, progress));
  } else {
    SACCADE_CHECK(drag_rectangles(options, *graph, cloud, truth, executor, annotation, progress));
  }
  return annotation;
}

}  // namespace saccade::cli
