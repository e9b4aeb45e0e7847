// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloseUp: surfels from close by, not enhanced beside enhanced, for Figs. 4.5 to 4.9.

#include <Eigen/Core>

#include "experiments/surfel_trials.hpp"

namespace saccade::reproduce {

/// Part of the scene that a figure shows; chosen once to match the thesis' description.
struct CloseUp {
  const char* number;
  std::string_view file;
  const char* shows;
  std::size_t scene;  ///< index into kSurfelScenes
  bool by_flood_fill;
  Eigen::Vector3d eye;
  Eigen::Vector3d target;
  double field_of_view_rad;  ///< across the picture's height
};

/// Draws both clouds in their colours and in segments. Errors of surfel_trial and best_segments.
[[nodiscard]] Result<ReproducedTable> reproduce_segments(const CloseUp& close_up, const TableOptions& options,
                                                         const Executor& executor, const Progress& progress,
                                                         SurfelExperiments& all);
/// Draws the surfels where they are and where their modes are. Errors of surfel_trial.
[[nodiscard]] Result<ReproducedTable> reproduce_positions(const CloseUp& close_up, const TableOptions& options,
                                                          const Executor& executor, const Progress& progress,
                                                          SurfelExperiments& all);

}  // namespace saccade::reproduce
