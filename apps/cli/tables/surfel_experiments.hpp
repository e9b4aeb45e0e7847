// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelExperiments: the trials that Tables 4.1 and 4.3 and Figs. 4.5 to 4.11 share; each is carried out by the first
// that needs it.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "tables/thesis_table.hpp"
#include "thesis/surfel_trials.hpp"

namespace saccade::cli {

struct SurfelExperiments {
  std::array<std::shared_ptr<const thesis::SurfelTrial>, kSurfelScenes.size()> trials;
};

/// Of one of kSurfelScenes.
[[nodiscard]] Result<std::shared_ptr<const thesis::SurfelTrial>> surfel_trial(const ReproduceOptions& options,
                                                                              std::size_t scene,
                                                                              const Executor& executor,
                                                                              const Progress& progress);

/// What all of these differ in from the thesis; of SV-LCCP in how many places its grid lay, too.
void add_surfel_notes(const ReproduceOptions& options, bool is_of_sv_lccp, ReproducedTable& table);
/// Of a table that is interrupted, but not empty.
void mark_missing(const std::vector<std::string>& scenes, ReproducedTable& table);

}  // namespace saccade::cli
