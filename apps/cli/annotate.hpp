// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `saccade annotate` is made of.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "command.hpp"
#include "progress_bar.hpp"
#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/annotate/rectangle_annotator.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "saccade/io/cloud_io.hpp"

namespace saccade::cli {

enum class AnnotationMethod { control_points, rectangle };

/// Whether true labels of one ten are parts of one object.
enum class Tens { detect, merge, keep };

struct AnnotateOptions {
  std::filesystem::path cloud;
  std::filesystem::path truth;  ///< labels of the simulated annotator
  Tens tens{Tens::detect};
  int clicks{4};  ///< per label
  AnnotationMethod method{AnnotationMethod::control_points};
  std::filesystem::path out;  ///< labels
  NeighbourhoodConfig graph;
};

/// Where a simulated annotation is after one action.
struct AnnotationStep {
  std::uint32_t label{0};
  double iou_mean{0.0};
  std::size_t errors{0};
};

struct SimulatedAnnotation {
  std::size_t points{0};   ///< that have a label in truth
  std::size_t objects{0};  ///< labels
  std::vector<AnnotationStep> clicks;
  std::vector<std::uint32_t> labels;  ///< per point; 0: none
  double graph_ms{0.0};
  double full_ms{0.0};
  std::vector<double> add_ms;
  std::vector<double> delete_ms;

  /// Clicks until the mean IoU was at least this; none: never.
  [[nodiscard]] std::optional<std::size_t> clicks_to(double iou_mean) const;
};

[[nodiscard]] Result<SimulatedAnnotation> simulate_annotation(const AnnotateOptions& options, const CloudFile& file,
                                                              const Executor& executor, ProgressBar& bar);

[[nodiscard]] nlohmann::json annotation_json(const AnnotateOptions& options, const SimulatedAnnotation& annotation);
void print_annotation(const AnnotateOptions& options, const SimulatedAnnotation& annotation);

}  // namespace saccade::cli
