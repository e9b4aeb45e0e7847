// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelExperiments: the trials that Tables 4.1 and 4.3 and Figs. 4.1 and 4.4 to 4.11 share, one for each scene.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reproduced_table.hpp"
#include "table_options.hpp"
#include "thesis/surfel_trials.hpp"

namespace saccade::reproduce {

/// One for each of kSurfelScenes, as far as they were carried out.
using SurfelExperiments = std::array<std::optional<thesis::SurfelTrial>, kSurfelScenes.size()>;

/// Returns the configuration for the options: ours, or the printed one with --as-printed (decision 41).
[[nodiscard]] thesis::SurfelTrialConfig surfel_trial_config(const TableOptions& options);

/// Carries one trial out unless it is there. Errors of carry_out_surfel_trial.
/// @param scene  of kSurfelScenes
/// @return the trial, which lives as long as `all`
[[nodiscard]] Result<const thesis::SurfelTrial*> surfel_trial(const TableOptions& options, std::size_t scene,
                                                              const Executor& executor, const Progress& progress,
                                                              SurfelExperiments& all);

struct DoneTrial {
  std::size_t scene{0};  ///< index into kSurfelScenes
  const thesis::SurfelTrial* trial{nullptr};
};

/// The trials of the chosen scenes; after an interruption those that were done, if any, and what is missing.
struct DoneTrials {
  std::vector<DoneTrial> done;
  std::vector<std::string> missing;
};
/// Errors of surfel_trial; cancelled only where no trial was done.
[[nodiscard]] Result<DoneTrials> surfel_trials(const TableOptions& options, const Executor& executor,
                                               const Progress& progress, SurfelExperiments& all);

/// Adds what all of these differ in from the thesis; with SV-LCCP in how many places its grid lay, too.
void add_surfel_notes(const TableOptions& options, bool is_of_sv_lccp, ReproducedTable& table);
/// Marks a table that is interrupted, but not empty.
void mark_missing(const std::vector<std::string>& scenes, ReproducedTable& table);
[[nodiscard]] nlohmann::json json_of(const ScoreCurve& curve);

}  // namespace saccade::reproduce
