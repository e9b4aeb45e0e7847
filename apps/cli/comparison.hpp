// SPDX-License-Identifier: Apache-2.0
#pragma once
// Comparison: the runs of `saccade compare`, those that a campaign file has already and those still to be done.

#include <optional>
#include <string>
#include <vector>

#include "compare_options.hpp"
#include "progress_bar.hpp"
#include "saccade/io/campaign.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade::cli {

struct ComparedScene {
  std::string name;
  std::string hash;
  RayScene rays;
};

/// One run of the comparison.
struct PlannedRun {
  std::size_t scene{0};  ///< index into Comparison::scenes()
  StrategyKind strategy{StrategyKind::sphere};
  std::uint64_t seed{1};
  std::optional<int> max_views;  ///< nullopt: as many as a run that is still to be done will take
  bool found{false};             ///< the campaign has it
};

/// Runs scene by scene, seed by seed, strategy by strategy, the same for every thread count.
class Comparison {
 public:
  /// Builds the scenes. Errors: those of find_scene and RayScene::build; invalid_argument for two different scenes
  /// with one name.
  [[nodiscard]] static Result<Comparison> create(const CompareOptions& options);

  [[nodiscard]] const CompareOptions& options() const { return options_; }
  [[nodiscard]] const std::vector<ComparedScene>& scenes() const { return scenes_; }
  /// All runs in their order. campaign: nullptr for one that is not there yet.
  [[nodiscard]] Result<std::vector<PlannedRun>> plan(const Campaign* campaign) const;

  /// Does what the campaign lacks and stores it there, run by run, until everything is done or the user interrupts.
  /// @return how many runs were done now.
  [[nodiscard]] Result<std::size_t> run(const Campaign& campaign, const Executor& executor,
                                        ProgressBar& progress) const;

  /// The runs of this comparison that the campaign has, in their order.
  [[nodiscard]] Result<std::vector<CampaignRun>> finished(const Campaign& campaign) const;

 private:
  explicit Comparison(const CompareOptions& options) : options_{options} {}
  [[nodiscard]] Result<PlannedRun> planned(const Campaign* campaign, std::size_t scene, std::uint64_t seed,
                                           StrategyKind strategy) const;
  [[nodiscard]] SimulatedRunConfig config_of(const PlannedRun& run) const;
  [[nodiscard]] CampaignKey key_of(const PlannedRun& run) const;

  CompareOptions options_;
  std::vector<ComparedScene> scenes_;
};

}  // namespace saccade::cli
