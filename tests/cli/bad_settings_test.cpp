// SPDX-License-Identifier: Apache-2.0
// Settings of explorations and comparisons that cannot be meant: one clear line, before anything moves.
#include <gtest/gtest.h>

#include "run_program.hpp"

namespace saccade::test {
namespace {

std::string scene_of(const std::string& name, const std::string& workspace) {
  return "scene: " + name + "\nworkspace: " + workspace +
         "\nscan:\n  - {from: [0, -1, 0.7], look_at: [0, 0, 0.1]}\n"
         "objects:\n  - {name: cube, box: {size: [0.1, 0.1, 0.1]}, at: [0, 0, 0]}\n";
}

TEST(BadSettings, AWorkspaceOfNoVoxelOrOfTooMany) {
  const TempFolder folder;
  const auto explored = [&](const std::string& workspace) {
    const fs::path scene = folder.write("scene.yaml", scene_of("cube", workspace));
    return run_program({"explore", scene.string(), "--robot", "free", "--out", (folder / "run").string()});
  };
  expect_failure(explored("{min: [-350, -350, -30], max: [350, 350, 300]}"), 3, "explore",
                 {"cube", "700.000 x 700.000 x 330.000 m", "metres"});
  expect_failure(run_program({"compare", "--scenes", (folder / "scene.yaml").string(), "--strategies", "sphere",
                              "--out", (folder / "compared").string()}),
                 3, "compare", {"cube", "metres"});
  expect_failure(explored("{min: [0, 0, 0], max: [0.001, 0.001, 0.001]}"), 3, "explore", {"cube", "no voxel"});
}

TEST(BadSettings, ASceneWithoutAName) {
  const TempFolder folder;
  const fs::path scene = folder.write("scene.yaml", scene_of("''", "{min: [-1, -1, -0.1], max: [1, 1, 1]}"));
  expect_failure(run_program({"scene", "export", scene.string(), "--out", (folder / "out").string()}), 3, "scene",
                 {scene.string(), "the name is empty"});
}

TEST(BadSettings, ALeastGainThatIsNoGain) {
  const TempFolder folder;
  for (const char* gain : {"nan", "inf", "-1"}) {
    const std::string given = std::string{"--min-gain="} + gain;
    expect_failure(
        run_program({"compare", "--scenes", "tabletop-1", given, "--list", "--out", (folder / "c").string()}), 2,
        "compare", {"--min-gain", "at least 0"});
  }
}

}  // namespace
}  // namespace saccade::test
