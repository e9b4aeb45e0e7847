// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExplorationExperiments: object-driven attention, the standard method and Saccade's, five views each in four scenes
// with the arm (thesis §3.2.2), for Tables 3.1 to 3.3 and Figs. 3.16 to 3.22.

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "reproduced_table.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/explore/run_record.hpp"
#include "table_options.hpp"

namespace saccade::reproduce {

constexpr std::array<const char*, 4> kTabletops{"tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4"};
constexpr int kExplorationViews{5};

/// Pictures of one run.
struct ExplorationPictures {
  std::vector<ColorImage> maps;        ///< after the scan and after each view
  std::vector<ColorImage> saliencies;  ///< before each view that a segment drew the attention to
  std::vector<ColorImage> candidates;  ///< before each view
};

struct Exploration {
  RunRecord run;
  ExplorationPictures pictures;  ///< empty unless TableOptions::draws
};

/// The runs of one strategy, as far as they were carried out.
struct Explorations {
  const char* strategy{""};
  std::array<std::optional<Exploration>, kTabletops.size()> in_scene{};

  /// Lists all of them. Expects that all were carried out.
  [[nodiscard]] std::vector<RunRecord> runs() const;
};

struct ExplorationExperiments {
  Explorations attention{"attention"};
  Explorations standard{"standard"};
  Explorations surface{"surface"};  ///< by Saccade's strategy
};

/// Carries one run out unless it is there. cancelled; errors of run_simulated.
/// @param scene  of kTabletops
/// @return the run, which lives as long as `all`
[[nodiscard]] Result<const Exploration*> exploration(const TableOptions& options, const Executor& executor,
                                                     const Progress& progress, Explorations& all, std::size_t scene);
/// Carries all runs of all strategies out. Errors as above.
[[nodiscard]] Status carry_out_explorations(const TableOptions& options, const Executor& executor,
                                            const Progress& progress, ExplorationExperiments& all);

/// Seconds in which the view was computed.
[[nodiscard]] double next_best_view_s(const ViewRecord& view);
[[nodiscard]] double phase_seconds(const ViewRecord& view, std::initializer_list<Phase> phases);

void add_exploration_notes(const TableOptions& options, ReproducedTable& table);
/// Every view of every run.
[[nodiscard]] nlohmann::json experiments_json(const ExplorationExperiments& all);

}  // namespace saccade::reproduce
