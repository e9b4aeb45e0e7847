// SPDX-License-Identifier: Apache-2.0
// Services of the command scaffold: suggestions for typing errors, help in words, the reference in docs.
#include <gtest/gtest.h>

#include "run_program.hpp"

namespace saccade::test {
namespace {

/// Expects a usage error of one line that holds some text.
void expect_usage(const Arguments& arguments, const std::string& part) {
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << part << '\n' << outcome.err;
}

TEST(Scaffold, SuggestsTheNearestCommandOptionAndChoice) {
  expect_usage({"explor"}, "there is no command explor; did you mean explore?");
  expect_usage({"scene", "rendr"}, "there is no command rendr; did you mean render?");
  expect_usage({"dance"}, "there is no command dance; name annotate, ");
  expect_usage({"explore", "tabletop-1", "--max-view", "3", "--out", "X"},
               "there is no option --max-view; did you mean --max-views? (see saccade explore --help)");
  expect_usage({"explore", "tabletop-1", "--max-view", "3"},
               "there is no option --max-view");  // before the missing one
  expect_usage({"score", "--xyz=1"}, "there is no option --xyz (see saccade score --help)");
  expect_usage({"info", "--quite"}, "did you mean --quiet?");
  expect_usage({"info", "a", "b"}, "there is an argument too many: b");
  expect_usage({"segment", "a.pcd", "--method", "flood-fil"},
               "must be lccp, sv-lccp or flood-fill, not 'flood-fil'; did you mean flood-fill?");
  expect_usage({"nbv", "a", "--poi", "0,0,0", "--camera", "kinect-v3"}, "; did you mean kinect-v");
  const Arguments explore{"explore", "tabletop-1", "--out", "X"};
  expect_usage(explore + Arguments{"--strategy", "surfce"}, "; did you mean surface?");
  expect_usage(explore + Arguments{"--saliency", "roundnes=2"}, "; did you mean roundness?");
  expect_usage(explore + Arguments{"--publish", "rso2"}, "; did you mean ros2?");
  const Arguments compare{"compare", "--scenes", "tabletop-1", "--out", "X"};
  expect_usage(compare + Arguments{"--strategies", "sphere,atention"}, "; did you mean attention?");
  expect_usage(compare + Arguments{"--noise", "kinect-v"}, "; did you mean kinect-v1?");
  expect_usage({"scene"}, "name what to do: export, list, render, scan or sequence (see saccade scene --help)");
}

TEST(Scaffold, HelpSaysRangesAndDefaultsInWords) {
  const std::string help = run_program({"nbv", "--help"}).out;
  EXPECT_NE(help.find("--top N (default 10)"), std::string::npos) << help;
  EXPECT_NE(help.find("--tilt DEGREES (default 0)"), std::string::npos) << help;
  EXPECT_NE(help.find("--count rays|voxels (default rays)"), std::string::npos) << help;
  const std::string explore = run_program({"explore", "--help"}).out;
  EXPECT_NE(explore.find("--max-views N (0 to 1000; default "), std::string::npos) << explore;
  EXPECT_NE(explore.find("--distance METRES[,METRES...]"), std::string::npos) << explore;
  EXPECT_EQ(explore.find("--radius"), std::string::npos) << "an old name is read, not shown";
  EXPECT_EQ(explore.find("->"), std::string::npos) << explore;
}

TEST(Scaffold, TheReferenceInDocsIsThatOfTheProgram) {
  const Outcome made = run_program({"generate", "markdown"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_GT(made.out.size(), 10000U);
  EXPECT_EQ(made.out, text_of(source_folder() / "docs/reference/cli.md"))
      << "write it anew: saccade generate markdown > docs/reference/cli.md";
}

TEST(Scaffold, NothingToShowIsStatus5WithTheResultAllTheSame) {
  const TempFolder folder;
  const fs::path cloud = folder.write("a.xyz", "0 0 0 0\n1 0 0 0\n0 1 0 0\n");
  const fs::path labelled = folder.write("b.ply",
                                         "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                         "property float z\nproperty int label\nend_header\n0 0 0 0\n1 0 0 0\n");
  const Outcome outcome = run_program({"score", labelled.string(), labelled.string(), "--json", "-", "--quiet"});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_EQ(outcome.err, "saccade score: no point has a true label above 0; there is nothing to score\n");
  expect_envelope(outcome.json(), "score");
  EXPECT_EQ(run_program({"info", cloud.string()}).status, 0);
}

}  // namespace
}  // namespace saccade::test
