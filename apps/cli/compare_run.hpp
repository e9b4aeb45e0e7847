// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_comparison: runs on this machine what the campaign of the folder lacks of a comparison.

#include "comparison.hpp"
#include "context.hpp"

namespace saccade::cli {

/// A comparison as far as it is done.
struct ComparisonRun {
  Campaign campaign;
  CampaignIndex found;     ///< all runs of the campaign
  std::size_t now{0};      ///< runs done now
  std::size_t planned{0};  ///< runs of the comparison
};

/// Opens the folder of --out, and does and stores the runs that are missing, until the user interrupts. Errors: those
/// of Campaign::open and run_missing.
[[nodiscard]] Result<ComparisonRun> run_comparison(Context& context, const Comparison& comparison);

/// Says what an interruption left; empty where all runs are done.
[[nodiscard]] std::string cut_short(const Context& context, std::size_t done, std::size_t planned);

}  // namespace saccade::cli
