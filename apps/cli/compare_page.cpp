// SPDX-License-Identifier: Apache-2.0
#include "compare_page.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "compare_report.hpp"
#include "compare_set_aside.hpp"
#include "compare_shards.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// How many runs each version of the program made; empty where this one made all.
json versions_json(const std::vector<CampaignEntry>& runs) {
  std::map<std::string, std::size_t> versions;
  for (const CampaignEntry& run : runs) ++versions[run.program_version];
  versions.erase(SACCADE_VERSION);
  if (versions.empty()) return {};
  json all = versions;
  const auto own = std::count_if(runs.begin(), runs.end(),
                                 [](const CampaignEntry& run) { return run.program_version == SACCADE_VERSION; });
  if (own > 0) all[SACCADE_VERSION] = own;
  return all;
}

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
  if (json versions = versions_json(compared.runs); !versions.empty()) result["versions"] = std::move(versions);
  return result;
}

Status add_slices(json& result, const Comparison& comparison, std::size_t merged, std::size_t slices) {
  const std::filesystem::path& out = comparison.options().out;
  std::vector<Error> broken;
  SACCADE_TRY(const CampaignIndex found, done_in(out, shard_files(out), &broken));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  SACCADE_TRY(const std::vector<SliceProgress> progress, progress_of(comparison, plan, slices));
  if (const std::size_t done = done_of(plan); done > merged) result["runs"]["in_shards"] = done - merged;
  result["slices"] = slices_json(progress);
  result["slices_at"] = utc_now();
  for (const std::string& name : set_aside_shards(out)) result["set_aside"].push_back(name);
  for (const Error& error : broken) result["unreadable"].push_back(error.to_string());
  return {};
}

Status write_page_of_slices(const Context& context, const Comparison& comparison, std::size_t slices) {
  const std::filesystem::path& out = comparison.options().out;
  SACCADE_TRY(std::vector<CampaignEntry> runs, merged_runs(comparison));
  const std::size_t planned = comparison.plan({}).size();
  std::error_code ignored;
  if (runs.size() == planned && std::filesystem::exists(out / kPageFile, ignored)) return {};  // the merge wrote it
  const ComparedRuns results = compared(std::move(runs), comparison.budget());
  json result = campaign_json(comparison, results, planned);
  SACCADE_CHECK(add_slices(result, comparison, results.runs.size(), slices));
  return server::write_report(out / kPageFile, context.document_so_far(std::move(result)),
                              comparison_details(comparison, results));
}

Status write_page_of_failed_start(const Context& context, const std::filesystem::path& out) {
  json slices = json::array();
  for (const ShardRecord& record : shard_records(out)) slices.push_back(to_json(record));
  json result{{"out", out.string()}, {"slices", std::move(slices)}, {"slices_at", utc_now()}};
  return server::write_report(out / kPageFile, context.document_so_far(std::move(result)));
}

void refresh_page(Context& context, const Comparison& comparison, std::size_t slices) {
  if (const Status page = write_page_of_slices(context, comparison, slices); !page) {
    context.bar().warn("the page was not written: " + page.error().to_string());
  }
}

}  // namespace saccade::cli
