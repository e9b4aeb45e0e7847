// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExplorationPainter: draws the map, the saliency of its segments and the candidates while a simulated run goes on, as
// in thesis Figs. 3.16 and 3.18 to 3.22.

#include "experiments/explorations.hpp"
#include "saccade/explore/recorder.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade::reproduce {

class ExplorationPainter final : public Recorder {
 public:
  ExplorationPainter(const Box& workspace, const SimulatedRunConfig& config, const Executor& executor)
      : workspace_{workspace}, sensor_{config.camera}, executor_{executor} {}

  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;

  [[nodiscard]] ExplorationPictures pictures() && { return std::move(pictures_); }

 private:
  void draw_map(const TsdfSnapshot& map);
  void draw_saliency(const ViewRecord& view);
  void draw_candidates(const ViewRecord& view);

  Box workspace_;
  PinholeCamera sensor_;
  Executor executor_;
  TsdfSnapshot before_;  // the map as it was before the view that is being taken
  std::vector<Pose> T_world_earlier_;
  ExplorationPictures pictures_;
};

}  // namespace saccade::reproduce
