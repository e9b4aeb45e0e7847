// SPDX-License-Identifier: Apache-2.0
#pragma once
// Comparisons on small images and large voxels, and what is in their campaigns.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/trial/campaign_summary.hpp"

namespace saccade::test {

inline const Arguments kCoarse{"--image-size", "96,72", "--voxel-size", "0.03"};

/// Sphere and random, one view at most, and one that gains little will do, unless told otherwise.
inline Arguments compare_scenes(const fs::path& out, const std::string& scenes, const Arguments& more = {}) {
  const auto unless_given = [&](const std::string& option, const std::string& value) {
    return std::count(more.begin(), more.end(), option) > 0 ? Arguments{} : Arguments{option, value};
  };
  return Arguments{"compare", "--scenes", scenes, "--out", out.string()} + kCoarse + more +
         unless_given("--max-views", "1") + unless_given("--min-gain", "1") +
         unless_given("--strategies", "sphere,random");
}

inline Arguments compare(const fs::path& out, const Arguments& more) {
  return compare_scenes(out, tiny_cell_file(), more);
}

/// One run of each scene.
inline Arguments once(const fs::path& out, const std::string& scenes, const Arguments& more = {}) {
  return compare_scenes(out, scenes, Arguments{"--seeds", "1", "--strategies", "sphere", "--quiet"} + more);
}

inline std::vector<CampaignEntry> runs_in(const fs::path& out) {
  const auto campaign = Campaign::open(out / "campaign.sqlite");
  EXPECT_TRUE(campaign);
  const auto runs = campaign ? campaign->runs() : Result<std::vector<CampaignEntry>>{campaign.error()};
  EXPECT_TRUE(runs);
  return runs ? *runs : std::vector<CampaignEntry>{};
}

/// The runs' figures, without times, in the order of their keys.
inline std::vector<std::string> figures_in(const fs::path& out) {
  std::vector<std::string> all;
  for (CampaignEntry run : runs_in(out)) {
    std::string text = run.key.scene + run.key.strategy + run.key.noise + std::to_string(run.key.seed) + ' ' +
                       run.key.settings + ' ' + std::string{to_string(run.run.stopped_because)};
    run.seconds = 0.0;
    for (ViewRecord& view : run.run.views) view.times = {};
    for (const RunFigure& figure : run_figures()) text += ' ' + std::to_string(figure.of(run, 2).value_or(-1.0));
    all.push_back(std::move(text));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace saccade::test
