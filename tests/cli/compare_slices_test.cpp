// SPDX-License-Identifier: Apache-2.0
// saccade compare in slices: shards, their merge, how far they are, and the script for Slurm.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "campaign_bits.hpp"
#include "compare_runs.hpp"
#include "report_page.hpp"
#include "saccade/io/files/sqlite_file.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

/// The columns of a table that are no times.
std::string figures_of(const fs::path& csv) {
  std::string kept;
  std::istringstream lines{text_of(csv)};
  for (std::string line; std::getline(lines, line);) {
    if (line.find("_ms,") == std::string::npos && line.find("seconds,") == std::string::npos) kept += line + '\n';
  }
  return kept;
}

Arguments slice(const fs::path& out, const Arguments& wanted, const std::string& of) {
  return compare(out, wanted + Arguments{"--shard", of, "--quiet"});
}

TEST(CompareSlices, ThreeInAnyOrderEqualOneMachine) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  for (const Arguments& how : {Arguments{}, Arguments{"--equal-views", "--max-views", "2"}}) {
    const TempFolder folder;
    const fs::path out = folder / "sliced";
    const Arguments wanted = Arguments{"--seeds", "1-3"} + how;
    ASSERT_EQ(run_program(compare(folder / "whole", wanted + Arguments{"--quiet"})).status, 0);
    for (const char* of : {"2/3", "0/3", "1/3"}) {
      const Outcome done = run_program(slice(out, wanted, of));
      ASSERT_EQ(done.status, 0) << done.err;
      EXPECT_NE(done.out.find("2 done now, 0 found"), std::string::npos) << done.out;
    }
    const Outcome listed = run_program(compare(out, wanted + Arguments{"--list"}));
    EXPECT_NE(listed.out.find("6 runs, 6 of them done"), std::string::npos) << listed.out;
    expect_failure(run_program(compare(out, wanted + Arguments{"--quiet"})), 3, "compare",
                   {"6 runs that are not merged", "--merge first"});
    const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet", "--json", "-"}));
    ASSERT_EQ(merged.status, 0) << merged.err;
    const nlohmann::json result = merged.json().at("result");
    EXPECT_EQ(result.at("runs").dump(), R"({"done":6,"known":0,"merged_now":6,"planned":6,"shards":3})");
    EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
    EXPECT_EQ(bits_of(out).at(0).size(), 6U);
    EXPECT_GE(bits_of(out).at(1).size(), 6U);
    EXPECT_EQ(figures_of(out / "summary.csv"), figures_of(folder / "whole/summary.csv"));
    EXPECT_EQ(report_in(out / "index.html").at("record").at("result").at("slices").size(), 3U);
    for (const nlohmann::json& slice : result.at("slices")) {
      EXPECT_EQ(slice.at("state"), "done");
      EXPECT_EQ(slice.at("done"), 2);
      EXPECT_EQ(slice.at("tries"), 1);
    }

    // A second merge, and the slices themselves, find everything done.
    const Outcome again =
        run_program(compare(out, wanted + Arguments{"--merge", (out / "shards").string(), "--quiet"}));
    EXPECT_NE(again.out.find("0 merged now, 6 known, 6 of 6 in the campaign"), std::string::npos)
        << again.out << again.err;
    EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
    const Outcome more = run_program(slice(out, wanted, "0/1"));
    EXPECT_NE(more.out.find("0 done now, 6 found"), std::string::npos) << more.out << more.err;
  }
}

TEST(CompareSlices, AKilledSliceIsTakenAgainAndADuplicateIsRefused) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-6", "--jobs", "1"};
  {
    RunningProgram program{compare(out, wanted + Arguments{"--shard", "0/2"})};
    ASSERT_TRUE(program.wait_for("seed 2"));
    expect_failure(run_program(slice(out, wanted, "0/2")), 3, "compare", {"0-of-2", "another run is writing"});
    Outcome status = run_program(compare(out, wanted + Arguments{"--status"}));
    EXPECT_NE(status.out.find("running"), std::string::npos) << status.out << status.err;
    program.send(SIGKILL);
    EXPECT_EQ(program.finish().status, -1);
  }
  const Outcome status = run_program(compare(out, wanted + Arguments{"--status", "--json", "-"}));
  ASSERT_EQ(status.status, 0) << status.err;
  const nlohmann::json slices = status.json().at("result").at("slices");
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_EQ(slices[0].at("state"), "killed");
  EXPECT_GE(slices[0].at("done").get<int>(), 1);
  EXPECT_EQ(slices[1].at("state"), "waiting");
  EXPECT_FALSE(fs::exists(out / "campaign.sqlite"));  // a look writes nothing
  ASSERT_EQ(run_program(slice(out, wanted, "0/2")).status, 0);
  ASSERT_EQ(run_program(slice(out, wanted, "1/2")).status, 0);
  const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet", "--json", "-"}));
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.json().at("result").at("slices")[0].at("tries"), 2);
  const Outcome more = run_program(compare(out, {"--seeds", "1-8", "--jobs", "1", "--status", "--json", "-"}));
  for (const nlohmann::json& one : more.json().at("result").at("slices")) {
    EXPECT_EQ(one.at("state"), "waiting") << one;  // it was done before seeds were added
    EXPECT_LT(one.at("done"), one.at("planned"));
  }
  ASSERT_EQ(run_program(compare(folder / "whole", wanted + Arguments{"--quiet"})).status, 0);
  EXPECT_EQ(bits_of(out), bits_of(folder / "whole"));
}

TEST(CompareSlices, ShardsThatDoNotFitAreNamedAndTheCampaignStays) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const Arguments wanted{"--seeds", "1-2"};
  ASSERT_EQ(run_program(compare(out, {"--seeds", "1", "--quiet"})).status, 0);
  ASSERT_EQ(run_program(slice(out, wanted, "0/1")).status, 0);
  const std::string before = text_of(out / "campaign.sqlite");
  const fs::path shard = shard_file(out, "0-of-1");
  const std::string good = text_of(shard);
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more + Arguments{"--merge"})), 3, "compare", parts);
    EXPECT_EQ(text_of(out / "campaign.sqlite"), before);
  };
  refused({"--seeds", "1"}, {"0-of-1/campaign.sqlite", "seed 2", "not among its seeds"});
  refused(wanted + Arguments{"--min-gain", "2"}, {"0-of-1", "not of this comparison", "min_gain is 1.0, not 2.0"});
  refused({"--seeds", "1-2", "--strategies", "surface"}, {"0-of-1", "not among its strategies"});
  refused(wanted + Arguments{"--merge", (folder / "nowhere").string()}, {"nowhere", "no campaign.sqlite"});

  std::ofstream{shard, std::ios::binary | std::ios::trunc};
  refused(wanted, {"0-of-1/campaign.sqlite", "is empty", "slice is done"});
  std::ofstream{shard, std::ios::binary} << good;
  const auto change = [&shard](const std::string& sql) { ASSERT_TRUE(SqliteFile::open(shard, 1000)->run(sql)); };
  change("UPDATE runs SET program_version = '0.0.9'");
  refused(wanted, {"0-of-1", "made by Saccade 0.0.9", "move the folder of the shard away"});
  // Its runs do not count, and are not done again into the same file.
  const Outcome old = run_program(compare(out, wanted + Arguments{"--status"}));
  EXPECT_NE(old.out.find("2 in the campaign, 0 in shards, 2 to be done"), std::string::npos) << old.out << old.err;
  EXPECT_NE(old.out.find("made by Saccade 0.0.9"), std::string::npos) << old.out;
  expect_failure(run_program(slice(out, wanted, "0/1")), 3, "compare", {"0-of-1", "made by Saccade 0.0.9"});
  std::ofstream{shard, std::ios::binary} << good;
  change("UPDATE views SET T_world_camera = '[['");
  refused(wanted, {"0-of-1/campaign.sqlite", "cannot read the run"});
  std::ofstream{shard, std::ios::binary} << good;
  change("PRAGMA user_version = 99");
  refused(wanted, {"0-of-1", "newer Saccade"});
  for (const double share : {0.95, 0.6, 0.3}) {
    std::ofstream{shard, std::ios::binary}
        << good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())));
    refused(wanted, {"0-of-1/campaign.sqlite", "damaged"});
  }
  const Outcome status = run_program(compare(out, wanted + Arguments{"--status"}));
  EXPECT_EQ(status.status, 0) << status.err;
  EXPECT_NE(status.out.find("unreadable: "), std::string::npos) << status.out;
  std::ofstream{shard, std::ios::binary} << good;
  // A record that cannot be read stops nothing, and the next try writes it anew.
  std::ofstream{shard.parent_path() / "shard.json"} << "{";
  const Outcome unknown = run_program(compare(out, wanted + Arguments{"--status"}));
  EXPECT_EQ(unknown.status, 0) << unknown.err;
  EXPECT_NE(unknown.out.find("unknown"), std::string::npos) << unknown.out;
  const Outcome merged = run_program(compare(out, wanted + Arguments{"--merge", "--quiet"}));
  EXPECT_NE(merged.out.find("2 merged now, 0 known"), std::string::npos) << merged.out << merged.err;
  ASSERT_EQ(run_program(slice(out, wanted, "0/1")).status, 0);
  EXPECT_NE(text_of(shard.parent_path() / "shard.json").find("\"done\""), std::string::npos);
}

TEST(CompareSlices, RunsOfTwoSettingsShareTheirShards) {
  if (kSanitized) GTEST_SKIP() << "comparisons take long under sanitizers; the unit tests merge campaigns";
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto wanted = [](const char* min_gain) { return Arguments{"--seeds", "1", "--min-gain", min_gain}; };
  for (const char* min_gain : {"1", "2"}) {
    for (const char* of : {"0/2", "1/2"}) ASSERT_EQ(run_program(slice(out, wanted(min_gain), of)).status, 0);
  }
  for (const char* min_gain : {"1", "2"}) {
    const Outcome merged = run_program(compare(out, wanted(min_gain) + Arguments{"--merge", "--quiet"}));
    ASSERT_EQ(merged.status, 0) << merged.err;
    EXPECT_NE(merged.out.find("2 merged now"), std::string::npos) << merged.out << merged.err;
  }
  EXPECT_EQ(bits_of(out).at(0).size(), 4U);
}

TEST(CompareSlices, AFolderThatIsNoCampaignIsRefused) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  expect_failure(run_program(compare(out, {"--status"})), 3, "compare", {"out", "there is no campaign"});
  fs::create_directories(out);
  std::ofstream{out / "letter.txt"} << "Dear reader";
  expect_failure(run_program(compare(out, {"--status"})), 3, "compare", {"there is no campaign"});
  expect_failure(run_program(slice(out, {"--seeds", "1"}, "0/2")), 3, "compare", {"other files", "letter.txt"});
  EXPECT_FALSE(fs::exists(out / "shards"));
  const fs::path failed = folder / "failed/shards/0-of-2";
  fs::create_directories(failed);
  std::ofstream{failed / "shard.json"} << R"({"slice": 0, "of": 2, "state": "failed", "tries": 1, "machine": "node7",
    "job": "", "began": "", "ended": "", "error": "scene.yaml: there is no such file"})";
  expect_failure(run_program(compare(folder / "failed", {"--merge"})), 3, "compare",
                 {"no shards to merge", "slice 0 of 2", "scene.yaml: there is no such file"});
}

TEST(CompareSlices, ASliceOfAnotherMachineIsLostOnceItsRecordIsOld) {
  const TempFolder folder;
  const fs::path shard = folder / "out/shards/0-of-1";
  fs::create_directories(shard);
  std::ofstream{shard / "shard.json"} << R"({"slice": 0, "of": 1, "state": "running", "tries": 1, "machine": "node7",
    "job": "12_0", "began": "2024-06-30T12:00:00Z", "ended": "", "error": ""})";
  const auto state = [&] {
    const Outcome status = run_program(compare(folder / "out", {"--seeds", "1", "--status", "--json", "-"}));
    EXPECT_EQ(status.status, 0) << status.err;
    return status.json().at("result").at("slices").at(0).at("state").get<std::string>();
  };
  EXPECT_EQ(state(), "running");
  fs::last_write_time(shard / "shard.json", fs::file_time_type::clock::now() - std::chrono::minutes{20});
  EXPECT_EQ(state(), "lost");
  std::ofstream{shard / "campaign.sqlite"} << std::string(1000, 'x');
  const Outcome listed = run_program(compare(folder / "out", {"--seeds", "1", "--list"}));
  EXPECT_NE(listed.out.find("unreadable: "), std::string::npos) << listed.out << listed.err;
  EXPECT_NE(listed.out.find("0-of-1/campaign.sqlite"), std::string::npos) << listed.out;
}

TEST(CompareSlices, ASliceThatCannotBeginLeavesARecord) {
  const TempFolder folder;
  const std::vector<Arguments> commands{
      {"compare", "--scenes", (folder / "gone.yaml").string(), "--strategies", "sphere"},
      {"benchmark", "view-sphere", "--objects", (folder / "gone").string()}};
  for (const Arguments& command : commands) {
    const fs::path out = folder / command.front();
    Arguments all = command;
    all.insert(all.end(), {"--out", out.string(), "--shard", "0/2"});
    expect_failure(run_program(all), 3, command.front(), {"gone"});
    const auto record = nlohmann::json::parse(std::ifstream{out / "shards/0-of-2/shard.json"});
    EXPECT_EQ(record.at("state"), "failed");
    EXPECT_NE(record.at("error").get<std::string>().find("gone"), std::string::npos) << record;
    const nlohmann::json slices = report_in(out / "index.html").at("record").at("result").at("slices");
    EXPECT_EQ(slices.at(0).at("error"), record.at("error")) << slices;
  }
}

TEST(CompareSlices, TheNumberOfATaskIsTheSlice) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more)), 2, "compare", parts);
    EXPECT_FALSE(fs::exists(out));
  };
  for (const char* wrong : {"3", "3/3", "/3", "0/0", "-1/3", "x/3", "1/3/5", "0/1000000"})
    refused({"--shard", wrong}, {"--shard", "0/10 and the last 9/10"});
  const std::vector<const char*> names{"SLURM_ARRAY_TASK_ID", "OMPI_COMM_WORLD_RANK", "PMI_RANK",
                                       "PMIX_RANK",           "JOB_COMPLETION_INDEX", "SLURM_PROCID",
                                       "SLURM_NTASKS",        "SLURM_STEP_NUM_TASKS"};
  for (const char* name : names) ::unsetenv(name);
  refused({"--shard", "auto/3"}, {"--shard", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"});
  ::setenv("OMPI_COMM_WORLD_RANK", "7", 1);
  refused({"--shard", "auto/3"}, {"'7/3'"});
  ::setenv("SLURM_ARRAY_TASK_ID", "2", 1);
  refused({"--shard", "auto/3"}, {"--shard", "SLURM_ARRAY_TASK_ID is 2", "OMPI_COMM_WORLD_RANK is 7"});
  ::unsetenv("SLURM_ARRAY_TASK_ID");
  ::unsetenv("OMPI_COMM_WORLD_RANK");
  ::setenv("SLURM_PROCID", "7", 1);
  ::setenv("SLURM_NTASKS", "9", 1);
  refused({"--shard", "auto/7"}, {"SLURM_PROCID"});  // other tasks than slices
  ::setenv("SLURM_NTASKS", "7", 1);
  refused({"--shard", "auto/7"}, {"'7/7'"});
  ::setenv("PMIX_RANK", "8", 1);
  refused({"--shard", "auto/7"}, {"'8/7'"});
  ::unsetenv("PMIX_RANK");
  ::setenv("SLURM_PROCID", "0", 1);
  ::setenv("SLURM_ARRAY_TASK_ID", "2", 1);
  const Outcome done = run_program(compare(out, {"--seeds", "1", "--shard", "auto/3", "--quiet"}));
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_TRUE(fs::exists(shard_file(out, "2-of-3")));
  for (const char* name : names) ::unsetenv(name);
}

TEST(CompareSlices, TheScriptForSlurmIsShown) {
  const TempFolder folder;
  const fs::path out = folder / "a campaign's";
  const Outcome shown = run_program(compare(out, {"--seeds", "1-5", "--slurm", "--dry-run", "--partition", "long",
                                                  "--time=2:00:00", "--cpus", "4", "--tasks", "5", "--threads", "1"}));
  ASSERT_EQ(shown.status, 0) << shown.err;
  for (const char* line : {"#!/bin/bash\n", "#SBATCH --array=0-4\n", "#SBATCH --cpus-per-task=4\n",
                           "#SBATCH --partition=long\n", "#SBATCH --time=2:00:00\n", "#SBATCH --requeue\n",
                           " --seeds 1-5 ", " --threads 4 ", "a campaign'\\''s'", " --shard auto/5 "})
    EXPECT_NE(shown.out.find(line), std::string::npos) << line << '\n' << shown.out;
  for (const char* part : {"--dry-run", "--slurm", "--cpus ", "--tasks"})
    EXPECT_EQ(shown.out.find(part), std::string::npos) << part << '\n' << shown.out;
  EXPECT_FALSE(fs::exists(out));
  const Outcome fewer = run_program(compare(out, {"--seeds", "1", "--slurm", "--dry-run", "--tasks", "2000"}));
  EXPECT_NE(fewer.out.find("#SBATCH --array=0-1\n"), std::string::npos) << fewer.out;  // there are two runs
  const auto refused = [&](const Arguments& more, const Arguments& parts) {
    expect_failure(run_program(compare(out, more)), 2, "compare", parts);
  };
  refused({"--dry-run"}, {"--slurm"});
  refused({"--cpus", "2"}, {"--slurm"});
  refused({"--slurm", "--partition", "a b"}, {"--partition", "letters"});
  refused({"--slurm", "--shard", "0/3"}, {"cannot be given with --shard"});
  refused({"--merge", "--status"}, {"cannot be given with --status"});
}

/// Stand-ins for sbatch and squeue come first in PATH while this lives.
class StandInSlurm {
 public:
  explicit StandInSlurm(const fs::path& folder) : folder_{folder}, path_{std::getenv("PATH")} {
    fs::create_directories(folder_);
    set("squeue", "");
    ::setenv("PATH", (folder_.string() + ':' + path_).c_str(), 1);
  }
  StandInSlurm(const StandInSlurm&) = delete;
  StandInSlurm& operator=(const StandInSlurm&) = delete;
  ~StandInSlurm() { ::setenv("PATH", path_.c_str(), 1); }

  void set(const std::string& name, const std::string& script) const {
    std::ofstream{folder_ / name} << "#!/bin/sh\n" << script << '\n';
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }

 private:
  fs::path folder_;
  std::string path_;
};

TEST(CompareSlices, WhatSlurmWarnsOfIsNotTheNumberOfAJob) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const StandInSlurm slurm{folder / "bin"};
  const Arguments wanted = compare(out, {"--seeds", "1", "--slurm", "--partition", "long", "--json", "-"});
  const std::string calls = (folder / "calls").string();
  slurm.set("squeue", "echo 'squeue: warning' >&2");
  slurm.set("sbatch", "echo \"$*\" \"[$SBATCH_ARRAY_INX]\" >>'" + calls +
                          "'; echo 'INFO: a plugin'; echo '123;clusterA'; echo 'sbatch: Billing' >&2");
  ::setenv("SBATCH_ARRAY_INX", "0-9", 1);
  const Outcome done = run_program(wanted);
  ::unsetenv("SBATCH_ARRAY_INX");
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.json().at("result").at("array_job"), "123");
  const std::string given = text_of(calls);
  for (const char* part : {"--array=0-1", "--cpus-per-task=1", "--partition=long", "--requeue", "--output=/dev/null",
                           "--job-name=saccade-", "--dependency=afterany:123", "[]"})
    EXPECT_NE(given.find(part), std::string::npos) << part << '\n' << given;
  EXPECT_EQ(given.find("[0-9]"), std::string::npos) << given;

  // The script writes to its log before it does anything that may fail.
  const std::string script = text_of(out / "logs/array.sh");
  EXPECT_LT(script.find("\nexec >>"), script.find("\ncd ")) << script;
  EXPECT_LT(script.find("\ncd "), script.find("--shard auto/")) << script;

  slurm.set("sbatch", "");
  expect_failure(run_program(wanted), 3, "compare", {"sbatch", "no number of a job"});
  slurm.set("sbatch", "case \"$*\" in *dependency*) echo 'no such queue' >&2; exit 1;; esac; echo 77");
  expect_failure(run_program(wanted), 3, "compare", {"no such queue", "job 77", "--merge", "scancel 77"});
  slurm.set("sbatch", "echo 'sbatch: error: Invalid job array specification' >&2; exit 1");
  expect_failure(run_program(wanted), 3, "compare", {"Invalid job array specification", "MaxArraySize", "--tasks"});
  fs::create_directory_symlink(out, folder / "other-name");
  const auto name_of = [&](const fs::path& spelled) {
    const Outcome shown = run_program(compare(spelled, {"--seeds", "1", "--slurm", "--dry-run"}));
    const std::size_t at = shown.out.find("--job-name=");
    return at == std::string::npos ? shown.err : shown.out.substr(at, shown.out.find('\n', at) - at);
  };
  EXPECT_EQ(name_of(out), name_of(folder / "other-name"));
  slurm.set("squeue", "echo 'squeue: warning'; echo '55 '");
  expect_failure(run_program(wanted), 3, "compare", {"job 55", "still queued or running"});
}

}  // namespace
}  // namespace saccade::test
