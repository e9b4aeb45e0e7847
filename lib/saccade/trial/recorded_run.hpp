// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_recorded: run_simulated with a recorder that is told of the run as it goes on.

#include "saccade/explore/recorder.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade {

/// @param recorder  gets each view with its measures
/// @return as run_simulated; errors of the recorder.
[[nodiscard]] Result<RunRecord> run_recorded(const GroundTruth& truth, const SimulatedRunConfig& config,
                                             ViewPlanner& planner, Recorder& recorder, const Executor& executor,
                                             const Progress& progress = {});
/// Runs the planner that config names.
[[nodiscard]] Result<RunRecord> run_recorded(const GroundTruth& truth, const SimulatedRunConfig& config,
                                             Recorder& recorder, const Executor& executor,
                                             const Progress& progress = {});

}  // namespace saccade
