// SPDX-License-Identifier: Apache-2.0
#include "compare_shards.hpp"

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "compare_jobs.hpp"
#include "compare_mismatch.hpp"
#include "compare_page.hpp"
#include "compare_run.hpp"
#include "compare_set_aside.hpp"
#include "interrupt.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/leftovers.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

/// The rule of campaign_folder() for a DIR that other slices write into as well, so that it cannot be locked.
Status check_campaign_folder(const fs::path& out, bool force) {
  const FolderOption rule = campaign_folder();
  std::error_code ignored;
  if (force || campaign_marker(out)) return {};
  for (const fs::directory_entry& entry : fs::directory_iterator{out, ignored}) {
    const std::string name = entry.path().filename().string();
    const bool own =
        std::any_of(rule.files.begin(), rule.files.end(), [&name](const auto& file) { return file == name; });
    if (own || parse_temporary_name(name)) continue;
    return Error{Errc::invalid_argument,
                 "the folder holds other files (" + name +
                     "), and no campaign; choose another one, or pass --force to write among them",
                 out.string()};
  }
  return {};
}

Error made_by(const std::string& version, const fs::path& shard) {
  return {
      Errc::unsupported,
      "was made by Saccade " + version + ", and this is " + SACCADE_VERSION +
          "; merge it with that one, or move the folder of the shard away and do its runs again; nothing was merged",
      shard.string()};
}

/// Adds the runs of a shard that were made by this version. Returns another version that made some; empty: none did.
Result<std::string> add_shard(const fs::path& file, CampaignIndex& found) {
  SACCADE_CHECK(check_not_emptied(file));
  SACCADE_TRY(const Campaign shard, Campaign::open_to_read(file));
  std::string other;
  SACCADE_CHECK(shard.for_each_stored([&](const StoredRun& run) -> Status {
    if (run.program_version == SACCADE_VERSION) {
      found.add(run.key, run.views);
    } else {
      other = run.program_version;
    }
    return {};
  }));
  return other;
}

/// Refuses a shard that has a run of the slice by another version: it would stay in the way of the one to be done.
Status check_versions(const Comparison& comparison, const std::vector<PlannedRun>& runs, const Campaign& shard) {
  CampaignIndex others;
  std::string version;
  SACCADE_CHECK(shard.for_each_stored([&](const StoredRun& run) -> Status {
    if (run.program_version == SACCADE_VERSION) return {};
    others.add(run.key, run.views);
    version = run.program_version;
    return {};
  }));
  if (others.size() == 0) return {};
  Comparison::SettingsTexts texts;
  for (const PlannedRun& run : runs) {
    if (!run.found && run.max_views && others.find(comparison.key_of(run, texts))) {
      return made_by(version, shard.path());
    }
  }
  return {};
}

/// Which runs of shards belong to a plan.
class ShardFilter {
 public:
  ShardFilter(const Comparison& comparison, const std::vector<PlannedRun>& plan) : planned_{comparison, plan} {
    Comparison::SettingsTexts texts;
    for (const PlannedRun& run : plan) {
      if (run.max_views) alike_.add(without_settings(comparison.key_of(run, texts)), 0);
    }
  }

  /// Ends a merge that the user interrupts, and at a run that another version made.
  /// @param other_settings  counts runs that differ from one of the plan in their settings alone
  [[nodiscard]] Result<MergeChoice> choose(const StoredRun& run, std::size_t& other_settings) const {
    if (interrupted()) return Error{Errc::cancelled, "interrupted", {}};
    const Status fits = planned_.accept(run);
    if (fits) return MergeChoice{};
    if (fits.error().code == Errc::unsupported) return made_by(run.program_version, {});
    if (alike_.find(without_settings(run.key))) ++other_settings;
    return MergeChoice{false, fits.error().message};
  }

 private:
  static CampaignKey without_settings(CampaignKey key) {
    key.settings.clear();
    return key;
  }

  PlannedKeys planned_;
  CampaignIndex alike_;  ///< keys without their settings
};

/// Brings a file back to what it was before a transaction that could not be written: SQLite leaves that to the next
/// reader.
void roll_back(const fs::path& file) {
  CampaignIndex unused;
  if (const Result<Campaign> campaign = Campaign::open_to_read(file)) static_cast<void>(unused.add(*campaign));
}

/// Merges into a campaign, which keeps every byte where that fails, or into one that `open` makes, and removes that
/// again.
Result<CampaignMerge> merge_into(const fs::path& file, const std::vector<fs::path>& shards, const AcceptRun& accept,
                                 const std::function<Result<const Campaign*>()>& open) {
  std::error_code code;
  const bool was_there = fs::exists(file, code);
  if (was_there && fs::file_size(file, code) > 0) {
    const auto merge = [&]() -> Result<CampaignMerge> {
      SACCADE_TRY(const Campaign campaign,
                  Campaign::open_to_read(file));  // opening it to write would change its header
      return campaign.merge(shards, accept);
    };
    const Result<CampaignMerge> merged = merge();
    if (!merged) {
      roll_back(file);
      return merged;
    }
    SACCADE_CHECK(open());
    return merged;
  }
  SACCADE_TRY(const Campaign* campaign, open());
  Result<CampaignMerge> merged = campaign->merge(shards, accept);
  if (!merged && !was_there) fs::remove(file, code);
  return merged;
}

Error no_shards(const fs::path& out) {
  std::size_t failed = 0;
  std::string first;
  for (const ShardRecord& record : shard_records(out)) {
    if (!record.error.empty() && ++failed == 1) first = "slice " + slice_text(record.slice) + ": " + record.error;
  }
  const std::string what{"there are no shards to merge"};
  return {Errc::not_found,
          failed == 0
              ? what + "; --shard makes them, --merge FOLDER takes others"
              : what + ", since slices failed before their first run (" + std::to_string(failed) + "), first " + first,
          (out / kShardsFolder).string()};
}

Result<RunFolder> open_shard(const fs::path& out, const Slice& slice, bool force) {
  const std::vector<std::string_view> own{kCampaignFile, kShardRecord};
  return RunFolder::open(shard_folder(out, slice), own, kShardRecord, force);
}

/// The record of a slice that begins now.
ShardRecord next_try(const RunFolder& folder, const Slice& slice) {
  return {.slice = slice,
          .state = ShardState::running,
          .tries = read_shard_record(folder.path(), slice).tries + 1,
          .machine = machine_name(),
          .job = slurm_job(),
          .began = utc_now(),
          .ended = {},
          .error = {}};
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
  SACCADE_CHECK(add_shard(shard.path(), found));
  const std::vector<PlannedRun> runs = runs_of(record.slice, comparison.plan(found), comparison.options().equal_views);
  SACCADE_CHECK(check_versions(comparison, runs, shard));
  SACCADE_TRY(const std::size_t now,
              run_missing(comparison, runs, found, shard, context.executor().threads(), context.bar()));
  if (now == 0 && done_of(runs) < runs.size() && time_is_up()) {  // it would come back for ever
    return Error{Errc::invalid_argument, "the time limit came before a run was done; give tasks more time", {}};
  }
  return now;
}

}  // namespace

Result<Outcome> run_slice(Context& context, const Comparison& comparison) {
  const CompareOptions& options = comparison.options();
  const Slice slice = *options.machines.slice;
  SACCADE_CHECK(check_campaign_folder(options.out, context.force()));
  SACCADE_TRY(const RunFolder folder, open_shard(options.out, slice, context.force()));
  ShardRecord record = next_try(folder, slice);
  SACCADE_CHECK(write_json(folder / kShardRecord, to_json(record)));
  for (const std::string& choice : comparison.arm_choices()) context.bar().note("arm: " + choice);
  const Result<std::size_t> now = [&] {
    const RecordRenewal renewal{folder.path()};
    return run_recorded(context, comparison, folder.path(), record);
  }();
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

Status check_not_emptied(const fs::path& shard) {
  std::error_code code;
  const std::uintmax_t bytes = fs::file_size(shard, code);
  if (code || bytes > 0 || read_shard_record(shard.parent_path(), {}).state != ShardState::done) return {};
  return Error{Errc::corrupt_data,
               std::string{"is empty, although "} + kShardRecord + " says that its slice is done; do its runs again",
               shard.string()};
}

void record_failed_start(const Context& context, const CompareOptions& options, const Error& error) {
  if (!options.machines.slice || !check_campaign_folder(options.out, context.force())) return;
  const Slice slice = *options.machines.slice;
  const Result<RunFolder> folder = open_shard(options.out, slice, context.force());
  if (!folder) return;
  ShardRecord record = next_try(*folder, slice);
  record.state = ShardState::failed;
  record.ended = record.began;
  record.error = error.to_string();
  static_cast<void>(write_json(*folder / kShardRecord, to_json(record)));
  static_cast<void>(write_page_of_failed_start(context, options.out));
}

Result<CampaignIndex> done_in(const fs::path& out, const std::vector<fs::path>& shards, std::vector<Error>* broken) {
  CampaignIndex found;
  std::error_code ignored;
  if (fs::exists(out / kCampaignFile, ignored)) {
    SACCADE_TRY(const Campaign campaign, Campaign::open_to_read(out / kCampaignFile));
    SACCADE_CHECK(found.add(campaign));
  }
  for (const fs::path& file : shards) {
    const Result<std::string> other_version = add_shard(file, found);
    if (!other_version && broken == nullptr) return other_version.error();
    if (broken == nullptr) continue;
    if (!other_version) broken->push_back(other_version.error());
    if (other_version && !other_version->empty()) broken->push_back(made_by(*other_version, file));
  }
  return found;
}

Result<Outcome> slice_status(const Comparison& comparison) {
  const fs::path& out = comparison.options().out;
  std::error_code ignored;
  if (!fs::exists(out / kCampaignFile, ignored) && !fs::is_directory(out / kShardsFolder, ignored)) {
    return Error{Errc::not_found,
                 std::string{"there is no campaign: it has neither "} + kCampaignFile + " nor " + kShardsFolder +
                     "; check --out",
                 out.string()};
  }
  SACCADE_TRY(const CampaignIndex merged, done_in(out, {}));
  std::vector<Error> broken;
  SACCADE_TRY(const CampaignIndex found, done_in(out, shard_files(out), &broken));
  const std::vector<PlannedRun> plan = comparison.plan(found);
  const std::size_t done = done_of(plan);
  const std::size_t in_campaign = done_of(comparison.plan(merged));
  SACCADE_TRY(const std::vector<SliceProgress> slices, progress_of(comparison, plan, 0));
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
      text << "slice " << slice_text(slice.record.slice)
           << (slice.record.state == ShardState::unknown ? ": " : " failed: ") << slice.record.error << '\n';
    }
  }
  if (const std::vector<std::string> aside = set_aside_shards(out); !aside.empty()) {
    text << "set aside: " << joined(aside) << '\n';
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
    if (files.empty()) return no_shards(options.out);
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

std::string left_out_text(const ShardMerge& merged) {
  const auto counted = [](std::size_t count, const std::string& what) {
    return count == 0 ? std::string{} : std::to_string(count) + (count == 1 ? " run of " : " runs of ") + what;
  };
  const std::string settings = counted(merged.other_settings, "other settings");
  const std::string others = counted(merged.left_out - merged.other_settings, "other scenes, strategies or seeds");
  if (settings.empty() && others.empty()) return {};
  return settings + (settings.empty() || others.empty() ? "" : " and ") + others + " left out";
}

Result<ShardMerge> merge_shards(const Comparison& comparison, const std::vector<fs::path>& shards,
                                const std::function<Result<const Campaign*>()>& open) {
  for (const fs::path& file : shards) SACCADE_CHECK(check_not_emptied(file));
  // With equal views the plan depends on what the shards have of sphere.
  const fs::path& out = comparison.options().out;
  const bool reads_shards = comparison.options().equal_views;
  SACCADE_TRY(const CampaignIndex found, done_in(out, reads_shards ? shards : std::vector<fs::path>{}));
  const ShardFilter filter{comparison, comparison.plan(found)};
  ShardMerge merged;
  const AcceptRun accept = [&](const StoredRun& run) { return filter.choose(run, merged.other_settings); };
  SACCADE_TRY(static_cast<CampaignMerge&>(merged), merge_into(out / kCampaignFile, shards, accept, open));
  return merged;
}

}  // namespace saccade::cli
