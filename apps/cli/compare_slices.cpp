// SPDX-License-Identifier: Apache-2.0
#include "compare_slices.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <set>
#include <utility>

#include "options.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// For each run the number of its part. Runs of one part have to be done in their order by one process.
std::vector<std::size_t> part_numbers(const std::vector<PlannedRun>& plan, bool equal_views) {
  std::vector<std::size_t> numbers;
  numbers.reserve(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const bool goes_on = equal_views && i > 0 && plan[i].scene == plan[i - 1].scene &&
                         plan[i].noise == plan[i - 1].noise && plan[i].seed == plan[i - 1].seed;
    numbers.push_back(i == 0 ? 0 : numbers.back() + (goes_on ? 0 : 1));
  }
  return numbers;
}

/// The first part of a slice, and the first after it.
std::pair<std::size_t, std::size_t> part_range(const Slice& slice, std::size_t parts) {
  return {slice.index * parts / slice.count, (slice.index + 1) * parts / slice.count};
}

/// "2-of-10".
std::optional<Slice> slice_of(const std::string& name) {
  constexpr std::string_view kOf{"-of-"};
  const std::size_t at = name.find(kOf);
  if (at == std::string::npos) return std::nullopt;
  const auto index = whole_number(std::string_view{name}.substr(0, at));
  const auto count = whole_number(std::string_view{name}.substr(at + kOf.size()));
  if (!index || !count || *index >= *count) return std::nullopt;
  return Slice{static_cast<std::size_t>(*index), static_cast<std::size_t>(*count)};
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    if (entry.is_directory(code)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void add_file(std::vector<fs::path>& files, const fs::path& folder) {
  std::error_code code;
  if (fs::is_regular_file(folder / kCampaignFile, code)) files.push_back(folder / kCampaignFile);
}

/// Whether a process of this machine holds the lock of the folder (RunFolder).
bool is_locked(const fs::path& folder) {
  const Descriptor opened{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  return opened.get() >= 0 && ::flock(opened.get(), LOCK_SH | LOCK_NB) != 0;
}

constexpr std::chrono::minutes kRenewal{1};
constexpr std::chrono::minutes kLost{15};  // clocks of machines differ, and network file systems answer late

bool is_old(const fs::path& file) {
  std::error_code code;
  const fs::file_time_type renewed = fs::last_write_time(file, code);
  return !code && fs::file_time_type::clock::now() - renewed > kLost;
}

}  // namespace

SliceCounter::SliceCounter(const std::vector<PlannedRun>& plan, bool equal_views) : upto_(1) {
  const std::vector<std::size_t> numbers = part_numbers(plan, equal_views);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (numbers[i] + 2 > upto_.size()) upto_.push_back(upto_.back());
    ++upto_.back().planned;
    upto_.back().done += plan[i].found ? 1 : 0;
  }
}

SliceRuns SliceCounter::of(const Slice& slice) const {
  const auto [first, last] = part_range(slice, parts());
  return {upto_[last].planned - upto_[first].planned, upto_[last].done - upto_[first].done};
}

std::vector<PlannedRun> runs_of(const Slice& slice, const std::vector<PlannedRun>& plan, bool equal_views) {
  const std::vector<std::size_t> numbers = part_numbers(plan, equal_views);
  const auto [first, last] = part_range(slice, plan.empty() ? 0 : numbers.back() + 1);
  std::vector<PlannedRun> runs;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (numbers[i] >= first && numbers[i] < last) runs.push_back(plan[i]);
  }
  return runs;
}

fs::path shard_folder(const fs::path& out, const Slice& slice) {
  return out / kShardsFolder / (std::to_string(slice.index) + "-of-" + std::to_string(slice.count));
}

std::string machine_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string{name.data()} : std::string{};
}

json to_json(const ShardRecord& record) {
  return {{"slice", record.slice.index}, {"of", record.slice.count},  {"state", kShardStateNames.of(record.state)},
          {"tries", record.tries},       {"machine", record.machine}, {"job", record.job},
          {"began", record.began},       {"ended", record.ended},     {"error", record.error}};
}

Result<ShardRecord> shard_record_from_json(const json& value) {
  try {
    ShardRecord record;
    record.slice = {value.at("slice").get<std::size_t>(), value.at("of").get<std::size_t>()};
    const auto state = value.at("state").get<std::string>();
    const auto known = kShardStateNames.find(state);
    if (!known) return Error{Errc::corrupt_data, "unknown state \"" + state + "\"", {}};
    record.state = *known;
    record.tries = value.at("tries").get<std::size_t>();
    record.machine = value.at("machine").get<std::string>();
    record.job = value.at("job").get<std::string>();
    record.began = value.at("began").get<std::string>();
    record.ended = value.at("ended").get<std::string>();
    record.error = value.at("error").get<std::string>();
    return record;
  } catch (const json::exception& error) {
    return Error{Errc::corrupt_data, message_of(error), {}};
  }
}

ShardRecord read_shard_record(const fs::path& folder, const Slice& slice) {
  const fs::path file = folder / kShardRecord;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return ShardRecord{.slice = slice};
  const Result<json> value = read_json(file);
  Result<ShardRecord> record = value ? in_file(shard_record_from_json(*value), file) : value.error();
  if (!record) {
    return ShardRecord{.slice = slice,
                       .state = ShardState::unknown,
                       .error = record.error().to_string() + "; the next try of the slice writes it anew"};
  }
  record->slice = slice;
  if (record->state != ShardState::running) return *record;
  if (record->machine != machine_name()) {
    if (is_old(file)) record->state = ShardState::lost;
  } else if (!is_locked(folder)) {
    record->state = ShardState::killed;
  }
  return *record;
}

RecordRenewal::RecordRenewal(const fs::path& folder) {
  thread_ = std::jthread{[this, file = folder / kShardRecord](const std::stop_token& stop) {
    std::unique_lock lock{mutex_};
    while (!ended_.wait_for(lock, stop, kRenewal, [&stop] { return stop.stop_requested(); })) {
      ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);  // the time of the file system's machine, not of this one
    }
  }};
}

std::vector<ShardRecord> shard_records(const fs::path& out) {
  std::vector<ShardRecord> records;
  for (const fs::path& folder : folders_in(out / kShardsFolder)) {
    if (const auto slice = slice_of(folder.filename().string())) records.push_back(read_shard_record(folder, *slice));
  }
  return records;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

const char* campaign_marker(const fs::path& out) {
  std::error_code ignored;
  if (fs::is_regular_file(out / kCampaignFile, ignored)) return kCampaignFile;
  if (!shard_records(out).empty()) return kShardsFolder;
  return fs::is_directory(out / kSetAsideFolder, ignored) ? kSetAsideFolder : nullptr;
}

Result<std::vector<fs::path>> campaign_files(const fs::path& folder) {
  std::vector<fs::path> files;
  add_file(files, folder);
  for (const fs::path& below : {folder, folder / kShardsFolder}) {
    for (const fs::path& shard : folders_in(below)) add_file(files, shard);
  }
  if (files.empty()) {
    return Error{Errc::not_found, std::string{"there is no "} + kCampaignFile + " of a campaign or a shard in it",
                 folder.string()};
  }
  return files;
}

std::vector<fs::path> shard_files(const fs::path& out) {
  std::vector<fs::path> files;
  for (const fs::path& shard : folders_in(out / kShardsFolder)) add_file(files, shard);
  return files;
}

Result<std::vector<SliceProgress>> progress_of(const Comparison& comparison, const std::vector<PlannedRun>& plan,
                                               std::size_t count) {
  const CompareOptions& options = comparison.options();
  const SliceCounter counter{plan, options.equal_views};
  std::set<std::size_t> counts;
  if (count > 0) counts.insert(count);
  for (const fs::path& shard : folders_in(options.out / kShardsFolder)) {
    if (const auto slice = slice_of(shard.filename().string())) counts.insert(slice->count);
  }
  std::vector<SliceProgress> slices;
  for (const std::size_t of : counts) {
    for (std::size_t index = 0; index < of; ++index) {
      const Slice slice{index, of};
      const SliceRuns runs = counter.of(slice);
      ShardRecord record = read_shard_record(shard_folder(options.out, slice), slice);
      // Runs were added to the comparison, or its shard cannot be read.
      if (record.state == ShardState::done && runs.done < runs.planned) record.state = ShardState::waiting;
      slices.push_back({.record = std::move(record), .planned = runs.planned, .done = runs.done});
    }
  }
  return slices;
}

json slices_json(const std::vector<SliceProgress>& slices) {
  json all = json::array();
  for (const SliceProgress& slice : slices) {
    json one = to_json(slice.record);
    one["planned"] = slice.planned;
    one["done"] = slice.done;
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace saccade::cli
