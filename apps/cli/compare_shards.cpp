// SPDX-License-Identifier: Apache-2.0
#include "compare_shards.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <sstream>

#include "compare_jobs.hpp"
#include "compare_mismatch.hpp"
#include "saccade/io/files/json_io.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// UTC, as 2024-06-30T12:00:00Z.
std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::string slice_text(const Slice& slice) {
  return std::to_string(slice.index) + " of " + std::to_string(slice.count);
}

/// "12_3"; empty outside Slurm.
std::string slurm_job() {
  const auto value = [](const char* name) -> std::string {
    const char* text = std::getenv(name);
    return text == nullptr ? "" : text;
  };
  const std::string array = value("SLURM_ARRAY_JOB_ID");
  return array.empty() ? value("SLURM_JOB_ID") : array + '_' + value("SLURM_ARRAY_TASK_ID");
}

std::size_t done_of(const std::vector<PlannedRun>& runs) {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const PlannedRun& run) { return run.found; }));
}

Result<std::size_t> run_recorded(Context& context, const Comparison& comparison, const fs::path& folder,
                                 ShardRecord& record) {
  CampaignIndex found;
  const fs::path campaign = comparison.options().out / kCampaignFile;
  std::error_code ignored;
  if (fs::exists(campaign, ignored)) {
    SACCADE_TRY(const Campaign merged, Campaign::open_to_read(campaign));
    SACCADE_CHECK(found.add(merged));
  }
  SACCADE_TRY(const Campaign shard, Campaign::open(folder / kCampaignFile));
  SACCADE_CHECK(found.add(shard));
  const std::vector<PlannedRun> runs = runs_of(record.slice, comparison.plan(found), comparison.options().equal_views);
  return run_missing(comparison, runs, found, shard, context.executor().threads(), context.bar());
}

}  // namespace

Result<Outcome> run_slice(Context& context, const Comparison& comparison) {
  const CompareOptions& options = comparison.options();
  const Slice slice = *options.machines.slice;
  const std::vector<std::string_view> own{kCampaignFile, kShardRecord};
  SACCADE_TRY(const RunFolder folder,
              RunFolder::open(shard_folder(options.out, slice), own, kShardRecord, context.force()));
  SACCADE_TRY(ShardRecord record, read_shard_record(folder.path(), slice));
  record = {.slice = slice,
            .state = ShardState::running,
            .tries = record.tries + 1,
            .machine = machine_name(),
            .job = slurm_job(),
            .began = utc_now(),
            .ended = {},
            .error = {}};
  SACCADE_CHECK(write_json(folder / kShardRecord, to_json(record)));
  for (const std::string& choice : comparison.arm_choices()) context.bar().note("arm: " + choice);
  const Result<std::size_t> now = run_recorded(context, comparison, folder.path(), record);
  record.ended = utc_now();
  record.state = !now ? ShardState::failed : interrupted() ? ShardState::interrupted : ShardState::done;
  if (!now) record.error = now.error().to_string();
  if (const Status written = write_json(folder / kShardRecord, to_json(record)); !written && now) {
    return written.error();
  }
  if (!now) return now.error();

  SACCADE_TRY(const CampaignIndex found, done_in(options.out, {folder / kCampaignFile}));
  const std::vector<PlannedRun> runs = runs_of(slice, comparison.plan(found), options.equal_views);
  const std::size_t done = done_of(runs);
  Outcome outcome;
  outcome.result = {{"slice", slice.index},
                    {"of", slice.count},
                    {"out", options.out.string()},
                    {"campaign", (folder / kCampaignFile).string()},
                    {"runs", {{"planned", runs.size()}, {"done", done}, {"done_now", *now}}},
                    {"interrupted", done < runs.size()}};
  outcome.text = "slice     " + slice_text(slice) + "\nruns      " + std::to_string(*now) + " done now, " +
                 std::to_string(done - *now) + " found\nshard     " + (folder / kCampaignFile).string() + '\n';
  if (done < runs.size()) {
    outcome.cut_short = "interrupted after " + std::to_string(done) + " of " + std::to_string(runs.size()) +
                        " runs of slice " + slice_text(slice) + "; they are in " + folder.path().string() +
                        "; the same command goes on from there";
  }
  return outcome;
}

Result<CampaignIndex> done_in(const fs::path& out, const std::vector<fs::path>& shards, std::vector<Error>* broken) {
  CampaignIndex found;
  const auto add = [&found](const fs::path& file) -> Status {
    SACCADE_TRY(const Campaign campaign, Campaign::open_to_read(file));
    return found.add(campaign);
  };
  std::error_code ignored;
  if (fs::exists(out / kCampaignFile, ignored)) SACCADE_CHECK(add(out / kCampaignFile));
  for (const fs::path& file : shards) {
    const Status added = add(file);
    if (!added && broken == nullptr) return added.error();
    if (!added) broken->push_back(added.error());
  }
  return found;
}

Result<Outcome> slice_status(const Comparison& comparison) {
  const fs::path& out = comparison.options().out;
  SACCADE_TRY(const CampaignIndex merged, done_in(out, {}));
  std::vector<Error> broken;
  SACCADE_TRY(const CampaignIndex found, done_in(out, shard_files(out), &broken));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  const std::size_t done = done_of(plan);
  const std::size_t in_campaign = done_of(comparison.plan(merged));
  SACCADE_TRY(const std::vector<SliceProgress> slices, progress_of(comparison, plan));
  std::ostringstream text;
  text << std::left << plan.size() << " runs: " << in_campaign << " in the campaign, " << done - in_campaign
       << " in shards, " << plan.size() - done << " to be done\n";
  if (!slices.empty()) {
    text << std::setw(16) << "slice" << std::setw(14) << "state" << std::setw(16) << "runs" << std::setw(8) << "tries"
         << std::setw(22) << "began"
         << "machine\n";
  }
  for (const SliceProgress& slice : slices) {
    const ShardRecord& record = slice.record;
    text << std::setw(16) << slice_text(record.slice) << std::setw(14) << kShardStateNames.of(record.state)
         << std::setw(16) << std::to_string(slice.done) + " of " + std::to_string(slice.planned) << std::setw(8)
         << record.tries << std::setw(22) << record.began << record.machine
         << (record.job.empty() ? "" : ", job " + record.job) << '\n';
  }
  for (const SliceProgress& slice : slices) {
    if (!slice.record.error.empty()) {
      text << "slice " << slice_text(slice.record.slice) << " failed: " << slice.record.error << '\n';
    }
  }
  json unreadable = json::array();
  for (const Error& error : broken) {
    text << "unreadable: " << error.to_string() << '\n';
    unreadable.push_back(error.to_string());
  }
  return Outcome{.result = {{"out", out.string()},
                            {"runs", {{"planned", plan.size()}, {"done", done}, {"merged", in_campaign}}},
                            {"slices", slices_json(slices)},
                            {"unreadable", std::move(unreadable)}},
                 .text = text.str()};
}

Result<std::vector<fs::path>> shards_to_merge(const CompareOptions& options) {
  std::vector<fs::path> files;
  if (options.machines.merged.empty()) {
    files = shard_files(options.out);
    if (files.empty()) {
      return Error{Errc::not_found, "there are no shards to merge; --shard makes them, --merge FOLDER takes others",
                   (options.out / kShardsFolder).string()};
    }
  }
  for (const fs::path& folder : options.machines.merged) {
    SACCADE_TRY(const std::vector<fs::path> found, campaign_files(folder));
    files.insert(files.end(), found.begin(), found.end());
  }
  std::error_code ignored;
  const fs::path campaign = options.out / kCampaignFile;
  std::erase_if(files, [&](const fs::path& file) {
    return fs::exists(campaign, ignored) && fs::equivalent(file, campaign, ignored);
  });
  return files;
}

Result<CampaignMerge> merge_shards(const Comparison& comparison, const std::vector<fs::path>& shards,
                                   const std::function<Result<const Campaign*>()>& open) {
  SACCADE_TRY(const CampaignIndex merged, done_in(comparison.options().out, {}));
  SACCADE_TRY(const CampaignIndex found, done_in(comparison.options().out, shards));
  const PlannedKeys planned{comparison, comparison.plan(found)};
  const AcceptRun accept = [&planned](const StoredRun& run) { return planned.accept(run); };
  for (const fs::path& file : shards) {
    SACCADE_TRY(const Campaign shard, Campaign::open_to_read(file));
    SACCADE_CHECK(shard.check_whole());
    const Status fits =
        shard.for_each_stored([&](const StoredRun& run) { return merged.find(run.key) ? Status{} : accept(run); });
    if (!fits) {
      Error error = fits.error();
      if (error.context.empty()) error.context = file.string();
      return error;
    }
  }
  SACCADE_TRY(const Campaign* campaign, open());
  return campaign->merge(shards, accept);
}

}  // namespace saccade::cli
