// SPDX-License-Identifier: Apache-2.0
// Long commands when the terminal goes away (SIGHUP), and folders that two runs want.
#include <csignal>

#include "cli/run_program.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

struct LongCommand {
  std::string name;
  Arguments arguments;        ///< FRAMES, OUT, CLOUD and ARM stand for files of the test
  std::string kept;           ///< file in OUT that is there after the signal; empty: none
  bool kept_is_first{false};  ///< `kept` is written at once, and tells that the work goes on
};

const std::vector<LongCommand>& long_commands() {
  static const std::vector<LongCommand> commands{
      {"sample",
       {"sample", "--frames", "5000", "--image-size", "64,48", "--out", "OUT"},
       "frame-000000.depth.png",
       true},
      {"sequence", {"scene", "sequence", "desk", "--out", "OUT", "--image-size", "160,120"}, "sequence.json"},
      {"fuse", {"fuse", "FRAMES", "--out", "OUT", "--voxel-size", "0.01"}, "map.sacmap"},
      {"surfels", {"surfels", "FRAMES", "--out", "OUT.ply"}, ""},
      {"filter",
       {"filter", "FRAMES", "--intrinsics", "60,60,31.5,23.5", "--out", "OUT"},
       "frame-000000.depth.png",
       true},
      {"explore",
       {"explore", "tabletop-2", "--robot", "free", "--max-views", "50", "--min-gain", "1", "--no-pictures",
        "--image-size", "160,120", "--voxel-size", "0.015", "--out", "OUT"},
       "run.json"},
      {"compare",
       {"compare", "--scenes", "tabletop-2", "--seeds", "1-1000", "--max-views", "1", "--out", "OUT"},
       "campaign.sqlite"},
      {"update", {"update", "--scene", "jug", "--no-pictures", "--out", "OUT"}, ""},
      {"segment", {"segment", "CLOUD", "--voxel-size", "0.004", "--out", "OUT.ply"}, ""},
      {"reproduce", {"reproduce", "2.9"}, ""},
      {"reach", {"robot", "reach", "comau_smart_six", "--step", "0.03", "--out", "OUT"}, ""},
  };
  return commands;
}

class Hangup : public ::testing::TestWithParam<LongCommand> {
 protected:
  [[nodiscard]] Arguments arguments() {
    Arguments made;
    for (std::string argument : GetParam().arguments) {
      if (argument == "FRAMES") argument = frames();
      if (argument == "CLOUD") argument = cloud();
      if (argument.starts_with("OUT")) argument.replace(0, 3, (folder_ / "out").string());
      made.push_back(std::move(argument));
    }
    return made;
  }
  /// A thousand frames, of which there are eight.
  [[nodiscard]] std::string frames() const {
    const fs::path folder = folder_ / "frames";
    const Outcome sampled = run_program({"sample", "--frames", "8", "--image-size", "64,48", "--out", folder.string()});
    EXPECT_EQ(sampled.status, 0) << sampled.err;
    const auto name = [](int i) { return "frame-" + std::to_string(1000000 + i).substr(1); };
    for (int i = 8; i < 1200; ++i) {
      for (const char* kind : {".depth.png", ".color.png", ".pose.txt"}) {
        fs::create_symlink(folder / (name(i % 8) + kind), folder / (name(i) + kind));
      }
    }
    return folder.string();
  }
  /// A plane of a million points.
  [[nodiscard]] std::string cloud() const {
    const fs::path file = folder_ / "plane.xyz";
    std::ofstream text{file};
    for (int i = 0; i < 1'000'000; ++i) text << 0.001 * (i % 1000) << ' ' << 0.001 * (i / 1000) << " 0\n";
    return file.string();
  }
  TempFolder folder_;
};

TEST_P(Hangup, EndsTheCommandAndKeepsWhatWasDone) {
  if (kSanitized) GTEST_SKIP() << "commands take long under sanitizers";
  RunningProgram program{arguments()};
  const fs::path kept = folder_ / "out" / GetParam().kept;
  if (GetParam().kept_is_first) {
    ASSERT_TRUE(wait_for_file(kept));
  } else {
    for (int i = 0; i < 5000 && program.processor_ms() < 250.0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
  }
  program.send(SIGHUP);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 128 + SIGHUP) << outcome.err;
  EXPECT_TRUE(GetParam().kept.empty() || fs::exists(kept)) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(LongCommands, Hangup, ::testing::ValuesIn(long_commands()),
                         [](const auto& command) { return command.param.name; });

TEST(Nohup, ACommandThatIgnoresHangupsGoesOn) {
  const TempFolder folder;
  const auto before = std::signal(SIGHUP, SIG_IGN);  // children keep it, as under nohup
  RunningProgram program{
      {"sample", "--frames", "40", "--image-size", "64,48", "--out", (folder / "out").string(), "--quiet"}};
  std::signal(SIGHUP, before);
  ASSERT_TRUE(wait_for_file(folder / "out" / "frame-000000.depth.png"));
  program.send(SIGHUP);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder / "out" / "frame-000039.depth.png"));
}

TEST(SharedFolder, OneOfTwoRunsTakesIt) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    const TempFolder folder;
    const Arguments sample{"sample", "--frames", "5", "--image-size", "64,48", "--out", (folder / "out").string()};
    RunningProgram first{sample};
    RunningProgram second{sample};
    const Outcome one = first.finish();
    const Outcome other = second.finish();
    EXPECT_TRUE(one.status == 0 || other.status == 0) << one.err << other.err;
    EXPECT_TRUE(fs::exists(folder / "out" / "frame-000004.depth.png"));
  }
}

TEST(FarNumbers, OptionsAreRefusedWithTheirUnit) {
  const TempFolder folder;
  const auto explore = [&folder](const Arguments& more) {
    return run_program(Arguments{"explore", "tabletop-2", "--robot", "free", "--max-views", "1", "--no-pictures",
                                 "--image-size", "64,48", "--out", (folder / "out").string()} +
                       more);
  };
  expect_failure(explore({"--radius", "1e30"}), 2, "explore", {"--radius", "1000 m"});
  expect_failure(explore({"--distance", "0.8,1e-9"}), 2, "explore", {"--distance", "micrometre"});
  expect_failure(explore({"--intrinsics", "1e-30,1e-30,31,23"}), 2, "explore", {"focal lengths", "pixels"});
  expect_failure(explore({"--intrinsics", "50,50,1e30,23"}), 2, "explore", {"principal point", "pixels"});
  expect_failure(explore({"--max-range", "1e30"}), 2, "explore", {"range", "metres"});
  const std::string far = folder
                              .write("far.yaml",
                                     "scene: far\nworkspace: {min: [0, 0, 0], max: [1e20, 1, 1]}\nobjects:\n"
                                     "  - {name: ball, at: [0, 0, 0], sphere: {radius: 0.1}}\n")
                              .string();
  expect_failure(run_program({"scene", "render", far, "--out", (folder / "o.png").string()}), 3, "scene",
                 {"far.yaml", "line 2", "workspace", "1e+20 m"});
}

}  // namespace
}  // namespace saccade::test
