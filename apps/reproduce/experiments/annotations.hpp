// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationExperiments: simulated annotators on labelled clouds, for Tables 4.5 and 4.6 and Figs. 4.20 and 4.21.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "annotate.hpp"
#include "experiments/labelled_clouds.hpp"
#include "reproduced_table.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::reproduce {

struct Annotator {
  const char* method;
  const char* weights;
  cli::AnnotationMethod by;
  NeighbourhoodConfig graph;
};

inline const std::array<Annotator, 5> kAnnotators{
    {{"control points", "ours", cli::AnnotationMethod::control_points, {.strong_borders = true}},
     {"control points", "ours, as printed", cli::AnnotationMethod::control_points, {}},
     {"control points", "Table 4.4", cli::AnnotationMethod::control_points, thesis::kTable4_4},
     {"rectangles", "–", cli::AnnotationMethod::rectangle, {}},
     {"best rectangles", "–", cli::AnnotationMethod::best_rectangle, {}}}};

/// One cloud, annotated by each of kAnnotators.
struct AnnotationExperiment {
  LabelledCloud cloud;
  std::array<cli::SimulatedAnnotation, kAnnotators.size()> annotations;

  [[nodiscard]] std::string name() const { return cloud.job.cloud.filename().string(); }
};

struct AnnotationExperiments {
  std::string about;
  std::vector<AnnotationExperiment> clouds;
};

/// Carries the annotations out unless they are there. Errors of LabelledClouds and simulate_annotation; cancelled.
[[nodiscard]] Status carry_out_annotations(const TableOptions& options, const Executor& executor,
                                           const Progress& progress, std::optional<AnnotationExperiments>& all);

/// Makes Table 4.5 or 4.6. Errors as above.
[[nodiscard]] Result<ReproducedTable> user_study(const thesis::Scenario& scenario, const std::string& number,
                                                 const TableOptions& options, const Executor& executor,
                                                 const Progress& progress, std::optional<AnnotationExperiments>& all);

}  // namespace saccade::reproduce
