// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pictures of an update, and the page that shows them. Thesis Figs. 2.16 to 2.20.

#include <nlohmann/json.hpp>

#include "run_folder.hpp"
#include "saccade/report/update_report.hpp"
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

/// A picture in the folder for a page; none where it was not drawn.
[[nodiscard]] std::vector<ReportPicture> picture_of(const RunFolder& out, const char* name, const char* caption,
                                                    const char* alt, const char* kind);

/// What an earlier run drew. io_failure.
[[nodiscard]] Status remove_update_pictures(const RunFolder& out);

/// A task of a cell: report.html in the task's own folder, from its record in update.json and the pictures there.
/// io_failure.
[[nodiscard]] Status write_task_report(const UpdateReport& about, const WatchedTask& task, const UpdateFigures& figures,
                                       const RunFolder& out, const nlohmann::json& record);

/// report.html from the document that goes to update.json and the pictures in the folder. io_failure.
[[nodiscard]] Status write_update_report(const UpdateOptions& options, const WatchedTask& task,
                                         const UpdateFigures& figures, const RunFolder& out,
                                         const nlohmann::json& document);

}  // namespace saccade::cli
