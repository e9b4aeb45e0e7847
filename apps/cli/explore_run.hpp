// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreRun: one exploration with its journal, its pictures and its measures.

#include <functional>

#include "explore_devices.hpp"
#include "explore_journal.hpp"
#include "progress_bar.hpp"
#include "run_folder.hpp"
#include "saccade/report/drawn_surfels.hpp"

namespace saccade::cli {

class ExploreRun final : private Recorder {
 public:
  /// A run that has not begun. The arguments outlive it. Errors: those of TsdfMap::create.
  [[nodiscard]] static Result<std::unique_ptr<ExploreRun>> create(const ExploreOptions& options,
                                                                  const ExploreSetup& subject, ExploreDevices& devices,
                                                                  const RunFolder& out, const Executor& executor,
                                                                  ProgressBar& progress);
  /// Takes up what an earlier run left in the folder. invalid_argument when that ran with other settings.
  [[nodiscard]] Status resume(SavedExploration saved);

  /// Scans, unless that was done before, and explores. After the scan and after every view the journal is written, and
  /// then `recorded` is called.
  /// @param look_on  takes the run's messages, besides what the options name; null: none.
  [[nodiscard]] Status run(const std::function<void()>& recorded, std::unique_ptr<messages::MessageSink> look_on);

  [[nodiscard]] const TsdfSnapshot& map() const { return map_.content(); }
  [[nodiscard]] bool scanned() const { return journal_.scanned; }
  [[nodiscard]] const RunRecord& record() const { return journal_.run; }
  /// Returns {wanted, used, problem} of run.json: who was to compute gains and the expected surface, who did (cpu,
  /// cuda, or mixed), and the last error of the GPU, else null.
  [[nodiscard]] nlohmann::json compute_to_json() const;
  /// Measures of the map as it is now.
  [[nodiscard]] Measures measure_now() const;

 private:
  ExploreRun(const ExploreOptions& options, const ExploreSetup& subject, ExploreDevices& devices, const RunFolder& out,
             const Executor& executor, ProgressBar& progress, TsdfMap map);
  [[nodiscard]] Status run_to_end();
  /// Says the first error of the GPU, after which the CPU went on, and keeps the last.
  void note_gpu_problem();
  [[nodiscard]] Approval ask(const RankedView& view);
  [[nodiscard]] Status scanning(const ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;
  [[nodiscard]] Status save_journal();
  [[nodiscard]] Status draw(const ViewRecord& view, std::span<const Frame> frames);
  /// The surfels as they are; nullopt where the map is a volume.
  [[nodiscard]] Result<std::optional<DrawnSurfels>> draw_surfels_now() const;

  const ExploreOptions& options_;
  const ExploreSetup& subject_;
  ExploreDevices& devices_;
  const RunFolder& out_;
  Executor executor_;
  ProgressBar& progress_;
  TsdfMap map_;
  TsdfSnapshot before_;  // the map as it was before the view that is being taken
  std::optional<DrawnSurfels> surfels_before_;
  ExploreJournal journal_;
  std::optional<TruthMeter> truth_meter_;  // where the scene has a truth
  std::function<void()> recorded_;
  std::unique_ptr<RunMessages> messages_;
  std::unique_ptr<GpuMap> gpu_;  // computes gains and expected surface; null: the CPU does
  bool gpu_worked_{false};
  std::optional<Error> gpu_problem_;
};

}  // namespace saccade::cli
