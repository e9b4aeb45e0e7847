// SPDX-License-Identifier: Apache-2.0
#include "compare_run.hpp"

#include "compare_jobs.hpp"
#include "compare_slices.hpp"

namespace saccade::cli {

Result<ComparisonRun> run_comparison(Context& context, const Comparison& comparison) {
  SACCADE_CHECK(context.open_folder());
  SACCADE_TRY(Campaign campaign, Campaign::open(*context.folder() / kCampaignFile));
  for (const std::string& choice : comparison.arm_choices()) context.bar().note("arm: " + choice);
  if (const std::string mixed = mixed_camera(comparison.options().run); !mixed.empty()) context.bar().note(mixed);
  CampaignIndex found;
  SACCADE_CHECK(found.add(campaign));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const std::size_t now,
              run_missing(comparison, plan, found, campaign, context.executor().threads(), context.bar()));
  return ComparisonRun{std::move(campaign), std::move(found), now, plan.size()};
}

std::string cut_short(const Context& context, std::size_t done, std::size_t planned) {
  if (done >= planned) return {};
  return "interrupted after " + std::to_string(done) + " of " + std::to_string(planned) + " runs; they are in " +
         context.out().string() + "; the same command goes on from there";
}

}  // namespace saccade::cli
