// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlannedKeys: which runs are of a comparison, and what is different about one that is not.

#include "comparison.hpp"

namespace saccade::cli {

class PlannedKeys {
 public:
  /// @param plan  all runs, with what is done
  PlannedKeys(const Comparison& comparison, const std::vector<PlannedRun>& plan);

  /// Tells whether a run is of the plan and made by this version of the program. invalid_argument names what is
  /// different, the value of the run first; unsupported names the versions.
  [[nodiscard]] Status accept(const StoredRun& run) const;

 private:
  [[nodiscard]] std::string difference_of(const CampaignKey& key) const;

  CampaignIndex planned_;
  std::vector<CampaignKey> examples_;  ///< one for each scene, strategy, noise and settings
};

}  // namespace saccade::cli
