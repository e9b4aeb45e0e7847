// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pictures of an update, and the page that shows them. Thesis Figs. 2.16 to 2.20.

#include <nlohmann/json.hpp>

#include "run_folder.hpp"
#include "update_run.hpp"

namespace saccade::cli {

/// Draws into the folder of a run: view-NN-choice.png, view-NN-seen.png and view-NN-map.png after each view. The
/// references outlive it.
class UpdatePictures final : public Recorder {
 public:
  UpdatePictures(const UpdateOptions& options, const Box& workspace, const WatchedTask& task,
                 const ExploreDevices& devices, const RunFolder& out, const Executor& executor)
      : options_{options}, workspace_{workspace}, task_{task}, devices_{devices}, out_{out}, executor_{executor} {}

  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;
  /// before.png, hand.png, regions.png and after.png. io_failure.
  [[nodiscard]] Status draw_maps(const UpdateFigures& figures) const;

 private:
  const UpdateOptions& options_;
  const Box& workspace_;
  const WatchedTask& task_;
  const ExploreDevices& devices_;
  const RunFolder& out_;
  Executor executor_;
  TsdfSnapshot before_;  // the map as it was before the view that is being taken
  std::vector<Pose> T_world_earlier_;
};

/// Removes the pictures of an earlier run. Answers io_failure.
[[nodiscard]] Status remove_update_pictures(const RunFolder& out);

/// Returns what the page of a task shows beyond its record: the speed of the hand.
[[nodiscard]] nlohmann::json task_details(const WatchedTask& task);

/// Writes report.html for the document that goes to update.json. io_failure.
[[nodiscard]] Status write_update_report(const WatchedTask& task, const RunFolder& out, const nlohmann::json& document);

}  // namespace saccade::cli
