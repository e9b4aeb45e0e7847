// SPDX-License-Identifier: Apache-2.0
#include "compare_page.hpp"

#include "compare_report.hpp"
#include "compare_shards.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// The runs of the comparison that are in DIR/campaign.sqlite.
Result<std::vector<CampaignEntry>> merged_runs(const Comparison& comparison) {
  const std::filesystem::path file = comparison.options().out / kCampaignFile;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::vector<CampaignEntry>{};
  SACCADE_TRY(const Campaign campaign, Campaign::open_to_read(file));
  CampaignIndex found;
  SACCADE_CHECK(found.add(campaign));
  return comparison.finished(campaign, found);
}

}  // namespace

json campaign_json(const Comparison& comparison, const ComparedRuns& compared, std::size_t planned) {
  const CompareOptions& options = comparison.options();
  json result = comparison_json(compared);
  result["out"] = options.out.string();
  result["campaign"] = (options.out / kCampaignFile).string();
  result["robot"] = comparison.robot_name();
  result["max_views"] = compared.budget;
  result["equal_views"] = options.equal_views;
  result["seeds"] = options.seeds;
  result["runs"] = {{"planned", planned}, {"done", compared.runs.size()}};
  result["interrupted"] = compared.runs.size() < planned;
  return result;
}

Status write_page_of_slices(const Context& context, const Comparison& comparison, std::size_t slices) {
  const std::filesystem::path& out = comparison.options().out;
  std::vector<Error> broken;
  SACCADE_TRY(const CampaignIndex found, done_in(out, shard_files(out), &broken));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const std::vector<SliceProgress> progress, progress_of(comparison, plan, slices));
  SACCADE_TRY(std::vector<CampaignEntry> runs, merged_runs(comparison));
  const ComparedRuns results = compared(std::move(runs), comparison.budget());
  json result = campaign_json(comparison, results, plan.size());
  result["runs"]["in_shards"] = done_of(plan) - results.runs.size();
  result["slices"] = slices_json(progress);
  for (const Error& error : broken) result["unreadable"].push_back(error.to_string());
  return server::write_report(out / kPageFile, context.document_so_far(std::move(result)),
                              comparison_details(comparison, results));
}

}  // namespace saccade::cli
