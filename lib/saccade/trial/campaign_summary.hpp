// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the runs of a campaign say together: means with confidence intervals, curves over views, paired differences.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/statistics.hpp"
#include "saccade/trial/campaign_figures.hpp"

namespace saccade {

/// Runs that differ in their seed alone; or, without a scene, the same in all scenes: then each scene counts once, with
/// the mean of its runs, since seeds of one scene are no independent samples of scenes.
struct CampaignGroup {
  std::optional<std::string> scene;
  std::string strategy;
  std::string noise;

  [[nodiscard]] bool operator==(const CampaignGroup&) const = default;
};

struct CampaignSummary {
  CampaignGroup group;
  std::size_t runs{0};
  std::vector<MeanEstimate> figures;           ///< as run_figures(), each over the runs that have it
  std::map<std::string, std::size_t> stopped;  ///< runs by why they stopped

  /// Expects the name of a figure.
  [[nodiscard]] const MeanEstimate& of(std::string_view name) const { return figures[run_figure_index(name)]; }
};

/// One summary per group, in the order in which they first occur; those over all scenes follow where there are several.
/// Runs with other settings are not told apart: give it the runs of one comparison.
/// @param budget views that every run might have taken
[[nodiscard]] std::vector<CampaignSummary> summarize(std::span<const CampaignEntry> runs, std::size_t budget);

/// A figure of the map.
using MapFigure = double (*)(const Measures& map);

/// The mean of it after 0, 1, …, `budget` views. A run that ended earlier counts on with its last map, which stays as
/// it is. Empty without runs.
[[nodiscard]] std::vector<MeanEstimate> over_views(std::span<const CampaignEntry> runs, const CampaignGroup& group,
                                                   std::size_t budget, MapFigure figure);

/// Views k = 1, …, kFirstViews: share of the group's runs whose k-th view points at an object, of those that took it.
[[nodiscard]] std::vector<MeanEstimate> object_view_shares(std::span<const CampaignEntry> runs,
                                                           const CampaignGroup& group);

/// run_figures() of `a` minus those of `b` in each seed of a scene that both have, as means. What a seed does to both
/// cancels out, so that this tells more than two intervals side by side. Expects groups of one scene, or of all.
[[nodiscard]] std::vector<MeanEstimate> paired_gaps(std::span<const CampaignEntry> runs, const CampaignGroup& a,
                                                    const CampaignGroup& b, std::size_t budget);

}  // namespace saccade
