// SPDX-License-Identifier: Apache-2.0
// Messages of the program while it works and where something is odd: views as they are taken, sparse clouds, problems
// of many files, mixed cameras; and meshes as scenes.
#include <gtest/gtest.h>

#include <sstream>

#include "run_program.hpp"

namespace saccade::test {
namespace {

TEST(Advice, ARepeatedProblemIsSaidOnceWithACount) {
  const TempFolder folder;
  make_sample(folder / "frames", 3);
  const Outcome outcome = run_program(
      {"filter", (folder / "frames").string(), "--camera", "kinect-v2", "--out", (folder / "out").string(), "--quiet"});
  expect_failure(outcome, 3, "filter",
                 {"and 2 more: has 160x120 pixels", "filter is for the depth images of a Kinect v2"});
  const std::string& text = outcome.err;
  EXPECT_EQ(text.find("has 160x120"), text.rfind("has 160x120")) << text;
}

TEST(Advice, PointsFarApartAgainstTheVoxelsAreSaidWithWhatToTry) {
  const TempFolder folder;
  std::ostringstream ply;
  ply << "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\nproperty float "
         "z\nend_header\n";
  for (int i = 0; i < 900; ++i) ply << 0.04 * (i % 30) << ' ' << 0.04 * (i / 30) << " 0\n";
  const std::string cloud = folder.write("sparse.ply", ply.str()).string();
  const Outcome sparse = run_program({"segment", cloud});
  EXPECT_EQ(sparse.status, 0) << sparse.err;
  EXPECT_NE(sparse.err.find("the points are 0.04 m apart and the voxels 0.0075 m large"), std::string::npos)
      << sparse.err;
  const std::size_t advice = sparse.err.find("Try --voxel-size 0.08 --seed-size ");
  ASSERT_NE(advice, std::string::npos) << sparse.err;
  std::istringstream words{sparse.err.substr(advice)};
  std::string word;
  std::vector<std::string> tried;
  while (words >> word) tried.push_back(word);
  ASSERT_GE(tried.size(), 5U);
  const Outcome better = run_program({"segment", cloud, tried[1], tried[2], tried[3], tried[4], "--json", "-"});
  EXPECT_EQ(better.status, 0) << better.err;
  EXPECT_EQ(better.err.find("apart"), std::string::npos) << better.err;
  EXPECT_EQ(better.json().at("result").at("found"), 1);
}

TEST(Advice, AViewIsSaidWhenItWasTaken) {
  const TempFolder folder;
  const Arguments explore{"explore",      tiny_cell_file(), "--out",        (folder / "run").string(),
                          "--robot",      "free",           "--image-size", "96,72",
                          "--voxel-size", "0.015",          "--max-views",  "2",
                          "--no-pictures"};
  RunningProgram program{explore + Arguments{"--json", "-"}};
  ASSERT_TRUE(program.wait_for("view  1  at ("));
  EXPECT_EQ(program.out(), "") << "the result comes at the end";
  const Outcome outcome = program.finish();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("views").size(), 2U);
  const Outcome text = run_program(explore + Arguments{"--force", "--quiet"});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part : {"view  1  at (", "view  2  at (", "  promised ", " cm²  delivered ", "  refused ", " s\n"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << part << '\n' << text.out;
  }
}

TEST(Advice, ACameraWithTheNoiseOfAnotherIsSaid) {
  const TempFolder folder;
  const fs::path file = folder.write("file", "");
  const auto said = [&](const Arguments& more) {
    return run_program(Arguments{"explore", tiny_cell_file(), "--out", file.string(), "--robot", "free"} + more).err;
  };
  EXPECT_NE(said({"--camera", "realsense"}).find("camera realsense, the noise is that of a Kinect v1"),
            std::string::npos);
  EXPECT_EQ(said({"--camera", "kinect-v2"}).find("the noise is"), std::string::npos);
  EXPECT_EQ(said({"--camera", "realsense", "--no-noise"}).find("the noise is"), std::string::npos);
}

TEST(Advice, AMeshIsAScene) {
  const TempFolder folder;
  const fs::path mesh =
      folder.write("block.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Outcome drawn = run_program(
      {"scene", "render", mesh.string(), "--out", (folder / "a.png").string(), "--image-size", "64,48", "--json", "-"});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_GE(drawn.json().at("result").at("objects").size(), 2U);  // the table, too
  const Outcome explored =
      run_program({"explore", mesh.string(), "--out", (folder / "run").string(), "--robot", "free", "--image-size",
                   "96,72", "--voxel-size", "0.015", "--max-views", "1", "--no-pictures", "--quiet", "--json", "-"});
  ASSERT_EQ(explored.status, 0) << explored.err;
  EXPECT_EQ(explored.json().at("result").at("scene"), "block.obj");
}

}  // namespace
}  // namespace saccade::test
