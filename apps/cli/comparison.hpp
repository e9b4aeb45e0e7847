// SPDX-License-Identifier: Apache-2.0
#pragma once
// Comparison: the runs of `saccade compare`, those that a campaign file has already and those still to be done.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "compare_options.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/trial/campaign_index.hpp"

namespace saccade::cli {

struct ComparedScene {
  std::string name;
  std::string hash;
  RayScene rays;
};

/// One run of the comparison.
struct PlannedRun {
  std::size_t scene{0};  ///< index into Comparison::scenes()
  NamedPlanner strategy;
  std::string noise;  ///< noise_key
  std::uint64_t seed{1};
  std::optional<int> max_views;  ///< nullopt: as many as a run that is still to be done will take
  bool found{false};             ///< the campaign has it
};
/// Returns how many of these runs the campaign has.
[[nodiscard]] std::size_t done_of(const std::vector<PlannedRun>& runs);

/// Scene by scene, noise by noise, seed by seed, strategy by strategy.
class Comparison {
 public:
  /// Reads and builds the scenes and the arm. Errors: those of find_scene, mesh_scene, find_robot and RayScene::build;
  /// invalid_argument for two different scenes with one name, and for one in which there is nothing but supports.
  [[nodiscard]] static Result<Comparison> create(const CompareOptions& options);
  /// As create(), with these scenes instead of those that the options name.
  [[nodiscard]] static Result<Comparison> create(const CompareOptions& options, std::vector<Scene> scenes);

  [[nodiscard]] const CompareOptions& options() const { return options_; }
  [[nodiscard]] const std::vector<ComparedScene>& scenes() const { return scenes_; }
  /// Views that every run might take, but for those with as many as sphere took.
  [[nodiscard]] std::size_t budget() const { return static_cast<std::size_t>(options_.run.run.exploration.max_views); }
  /// "free", or the arm's name.
  [[nodiscard]] std::string robot_name() const { return arm_ ? arm_->name() : "free"; }
  /// Choices that were made when the arm was read.
  [[nodiscard]] const std::vector<std::string>& arm_choices() const { return arm_choices_; }
  /// Tells whether no seed changes the runs of a strategy: there is no noise, no arm that plans by chance, and no
  /// chance in the choice of views.
  [[nodiscard]] bool is_same_for_all_seeds(const NamedPlanner& strategy, const std::string& noise) const;
  /// All runs in their order. found: those that are done.
  [[nodiscard]] std::vector<PlannedRun> plan(const CampaignIndex& found) const;
  /// One of them as things are now.
  [[nodiscard]] PlannedRun plan_again(const CampaignIndex& found, const PlannedRun& run) const;

  /// Expects that max_views is known.
  [[nodiscard]] SimulatedRunConfig config_of(const PlannedRun& run) const;
  [[nodiscard]] CampaignKey key_of(const PlannedRun& run) const;
  /// Settings of runs that were asked for before, by what they depend on: strategy, noise, most views.
  using SettingsTexts = std::map<std::tuple<std::string, std::string, int>, std::string>;
  /// As key_of(), for many runs.
  [[nodiscard]] CampaignKey key_of(const PlannedRun& run, SettingsTexts& texts) const;

  /// The runs of this comparison that the campaign has, in their order.
  /// @param found  all runs of the campaign
  [[nodiscard]] Result<std::vector<CampaignEntry>> finished(const Campaign& campaign, const CampaignIndex& found) const;

 private:
  explicit Comparison(const CompareOptions& options) : options_{options} {}
  [[nodiscard]] Status read_arm();
  [[nodiscard]] Status add_scene(Scene scene, const std::string& given_as);
  [[nodiscard]] PlannedRun plan_again(const CampaignIndex& found, const PlannedRun& run, SettingsTexts& texts) const;

  CompareOptions options_;
  std::vector<ComparedScene> scenes_;
  std::shared_ptr<const ArmModel> arm_;  ///< null: the camera flies
  std::string arm_hash_;
  std::vector<std::string> arm_choices_;
};

}  // namespace saccade::cli
