// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreRun: one exploration with its journal, its pictures and its figures.

#include <functional>

#include "explore_devices.hpp"
#include "explore_journal.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"

namespace saccade::cli {

class ExploreRun {
 public:
  /// A run that has not begun. The arguments outlive it. Errors: those of TsdfMap::create.
  [[nodiscard]] static Result<ExploreRun> create(const ExploreOptions& options, const ExploreCase& subject,
                                                 ExploreDevices& devices, const RunFolder& out,
                                                 const Executor& executor, ProgressBar& progress);
  /// Takes up what an earlier run left in the folder. invalid_argument when that ran with other settings.
  [[nodiscard]] Status resume(SavedExploration saved);

  /// Scans, unless that was done before, and explores. After the scan and after every view the journal is written, and
  /// then `recorded` is called.
  [[nodiscard]] Result<StopReason> run(const std::function<void()>& recorded = {});

  [[nodiscard]] const TsdfSnapshot& map() const { return map_.content(); }
  [[nodiscard]] const nlohmann::json& initial() const { return journal_.initial; }
  [[nodiscard]] const nlohmann::json& views() const { return journal_.views; }
  /// `result.refused_at_end` of the JSON.
  [[nodiscard]] const nlohmann::json& refused_at_end() const { return refused_at_end_; }
  /// `result.final` of the JSON.
  [[nodiscard]] nlohmann::json final() const;

 private:
  ExploreRun(const ExploreOptions& options, const ExploreCase& subject, ExploreDevices& devices, const RunFolder& out,
             const Executor& executor, ProgressBar& progress, TsdfMap map);
  [[nodiscard]] Consent ask(const Proposal& view);
  [[nodiscard]] Status record_scan(const ScanResult& scanned);
  [[nodiscard]] Status record_view(const ExploredView& view, const Proposals& proposals);
  /// What it was chosen from, for saccade show.
  [[nodiscard]] Status keep_choice(const ExploredView& view, const Proposals& proposals) const;
  [[nodiscard]] Status save_journal() const;
  [[nodiscard]] Region region_of(const ExploredView& view, const Proposals& proposals) const;
  [[nodiscard]] Status draw(const ExploredView& view, const Proposals& proposals,
                            const std::vector<Frame>& frames) const;
  [[nodiscard]] MeasuredMap measure_now() const;

  const ExploreOptions& options_;
  const ExploreCase& subject_;
  ExploreDevices& devices_;
  const RunFolder& out_;
  Executor executor_;
  ProgressBar& progress_;
  TsdfMap map_;
  TsdfSnapshot before_;  // the map as it was before the view that is being taken
  ExploreJournal journal_;
  std::function<void()> recorded_;
  nlohmann::json refused_at_end_ = nlohmann::json::object();
};

}  // namespace saccade::cli
