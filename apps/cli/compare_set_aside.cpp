// SPDX-License-Identifier: Apache-2.0
#include "compare_set_aside.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include "compare_shards.hpp"
#include "compare_slices.hpp"
#include "saccade/trial/campaign.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

Status check_shard(const fs::path& file) {
  SACCADE_CHECK(check_not_emptied(file));
  SACCADE_TRY(const Campaign shard, Campaign::open_to_read(file));
  return shard.check_whole();
}

/// A name in DIR/set-aside that nothing has yet: 2-of-10, else 2-of-10.2 and so on.
fs::path free_name(const fs::path& out, const fs::path& shard) {
  const fs::path wanted = out / kSetAsideFolder / shard.filename();
  fs::path name = wanted;
  std::error_code ignored;
  for (std::size_t n = 2; fs::exists(name, ignored); ++n) name = wanted.string() + '.' + std::to_string(n);
  return name;
}

Error still_runs(const fs::path& file) {
  return {Errc::invalid_argument, "is damaged, and its slice still runs; end it before it is set aside", file.string()};
}

}  // namespace

Status set_aside_damaged(Context& context, const fs::path& out) {
  for (const fs::path& file : shard_files(out)) {
    const Status whole = check_shard(file);
    if (whole || whole.error().code != Errc::corrupt_data) continue;
    const fs::path shard = file.parent_path();
    if (read_shard_record(shard, {}).state == ShardState::running) return still_runs(file);
    SACCADE_TRY(const RunFolder locked, RunFolder::open(shard, {}, {}, true));  // no slice begins meanwhile
    const fs::path target = free_name(out, shard);
    std::error_code code;
    fs::create_directories(target.parent_path(), code);
    if (!code) fs::rename(shard, target, code);
    if (code) {
      return Error{Errc::io_failure, "cannot be moved to " + target.string() + ": " + code.message(), shard.string()};
    }
    context.bar().warn(whole.error().to_string() + "; set aside as " + target.string());
  }
  return {};
}

std::vector<std::string> set_aside_shards(const fs::path& out) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator{out / kSetAsideFolder, ignored}) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Error with_set_aside_hint(Error error, const CompareOptions& options) {
  if (error.code != Errc::corrupt_data || options.machines.set_aside || !options.machines.merged.empty()) return error;
  for (const fs::path& file : shard_files(options.out)) {
    if (!error.context.starts_with(file.string())) continue;
    error.message += "; --set-aside moves it away and goes on without it";
    break;
  }
  return error;
}

}  // namespace saccade::cli
