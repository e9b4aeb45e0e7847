// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreJournal: what an exploration has done so far, kept in its folder so that it can go on after an interruption.

#include <nlohmann/json.hpp>
#include <optional>

#include "run_folder.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/explore/run_record.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade::cli {

struct ExploreJournal {
  nlohmann::json settings;           ///< all that decides how the run goes on; another run's are not its own
  bool scanned{false};               ///< the initial scan is done
  RunRecord run;                     ///< so far
  std::optional<Configuration> q{};  ///< the arm as it stands; nullopt where there is none

  /// Frames that the camera has taken.
  [[nodiscard]] std::size_t frames() const;

  /// Writes the map, the surfels unless they are null, and then the journal that names them, and removes those of the
  /// last time: whatever happens in between, one complete set is there. With `keep_as` the map stays under that name,
  /// too. io_failure.
  [[nodiscard]] Status save(const std::filesystem::path& folder, const TsdfSnapshot& map, const SurfelMap* surfels,
                            const Executor& executor, const std::string& keep_as = {}) const;
};

struct SavedExploration {
  ExploreJournal journal;
  TsdfSnapshot map;
  std::optional<SurfelMap> surfels{};  ///< set where the run has --map surfels
};

/// Whether the folder holds an unfinished run.
[[nodiscard]] bool has_journal(const std::filesystem::path& folder);
/// not_found without one; corrupt_data for one that is damaged; errors of load_map.
[[nodiscard]] Result<SavedExploration> load_journal(const std::filesystem::path& folder, const Executor& executor);
/// The run is complete, or to be forgotten. io_failure.
[[nodiscard]] Status remove_journal(const std::filesystem::path& folder);

}  // namespace saccade::cli
