// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "annotate.hpp"
#include "json_output.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<int, 3> kGoals_percent{80, 85, 90};

std::string_view name_of(AnnotationMethod method) {
  return method == AnnotationMethod::rectangle ? "rectangle" : "control-points";
}

std::string text_of(const AnnotationStep& step, std::size_t points) {
  return "mean IoU " + fixed(step.iou_mean, 3) + ", wrong " + std::to_string(step.errors) + " (" +
         percent(static_cast<double>(step.errors) / static_cast<double>(points)) + ")";
}

}  // namespace

json annotation_json(const AnnotateOptions& options, const SimulatedAnnotation& annotation) {
  json clicks = json::array();
  for (const AnnotationStep& step : annotation.clicks) {
    clicks.push_back({{"label", step.label}, {"iou_mean", step.iou_mean}, {"errors", step.errors}});
  }
  json noc = json::object();
  for (const int goal : kGoals_percent) {
    const std::optional<std::size_t> needed = annotation.clicks_to(0.01 * goal);
    noc[std::to_string(goal)] = needed ? json(*needed) : json(nullptr);
  }
  json result{{"method", name_of(options.method)},
              {"points", annotation.points},
              {"objects", annotation.objects},
              {"clicks", std::move(clicks)},
              {"noc", std::move(noc)}};
  if (options.method == AnnotationMethod::control_points) {
    result["ms"] = {{"graph", annotation.graph_ms},
                    {"full", annotation.full_ms},
                    {"add", {{"median", median_of(annotation.add_ms)}}},
                    {"delete", {{"median", median_of(annotation.delete_ms)}}}};
  }
  return result;
}

void print_annotation(const AnnotateOptions& options, const SimulatedAnnotation& annotation) {
  const Summary summary{std::cout};
  const std::string action = options.method == AnnotationMethod::rectangle ? "rectangles" : "clicks";
  summary.line("points", std::to_string(annotation.points) + " in " + std::to_string(annotation.objects) + " labels");
  for (std::size_t n = annotation.objects; n <= annotation.clicks.size(); n += annotation.objects) {
    summary.line(std::to_string(n) + " " + action, text_of(annotation.clicks[n - 1], annotation.points));
  }
  if (!annotation.clicks.empty() && annotation.clicks.size() % annotation.objects != 0) {
    summary.line(std::to_string(annotation.clicks.size()) + " " + action,
                 text_of(annotation.clicks.back(), annotation.points));
  }
  if (options.method == AnnotationMethod::rectangle) return;
  summary.line("graph", fixed(annotation.graph_ms, 1) + " ms");
  summary.line("add, delete", fixed(median_of(annotation.add_ms), 2) + " ms, " +
                                  fixed(median_of(annotation.delete_ms), 2) + " ms (median)");
}

}  // namespace saccade::cli
