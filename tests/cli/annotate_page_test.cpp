// SPDX-License-Identifier: Apache-2.0
// saccade annotate with its page, without a browser: its result, and Ctrl-C.
#include <sys/stat.h>

#include <csignal>

#include "cli/annotated_boxes.hpp"

namespace saccade::test {
namespace {

using AnnotatePage = AnnotatedBoxes;

TEST_F(AnnotatePage, SaysWhereTheLabelsGoBeforeThePageIsServed) {
  RunningProgram program{{"--json", path("result.json"), "annotate", path("cloud.csv"), "--no-browser"}};
  ASSERT_TRUE(wait_for_file(path("result.json"))) << program.err();
  for (int i = 0; i < 2000 && program.out().find("Ctrl-C ends it") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("The page is at http://localhost:"), std::string::npos) << outcome.out;
  const nlohmann::json document = nlohmann::json::parse(text("result.json"));
  expect_envelope(document, "annotate");
  const nlohmann::json& clouds = document.at("result").at("clouds");
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_EQ(clouds[0].at("file"), path("cloud.csv"));
  EXPECT_EQ(clouds[0].at("session"), path("cloud.sacann"));
  EXPECT_EQ(clouds[0].at("labels"), path("cloud_labels.csv"));
}

TEST_F(AnnotatePage, ACloudThatCannotBeReadIsSaidBeforeThereIsAPage) {
  const Outcome outcome = run_program({"annotate", write("broken.pcd", "no cloud\n"), "--no-browser"});
  expect_failure(outcome, 3, "annotate", {"broken.pcd"});
  EXPECT_EQ(outcome.err.find("the names of clouds end in"), std::string::npos) << outcome.err;
  const Outcome cell = run_program({"annotate", write("cell.yaml", "# A cell.\ncell:\n"), "--no-browser"});
  expect_failure(cell, 3, "annotate", {"cell.yaml", "the names of clouds end in .pcd, .ply"});
}

/// A named pipe stands for a cloud that takes long to read.
TEST_F(AnnotatePage, CtrlCDoesNotWaitForACloudToBeRead) {
  ASSERT_EQ(::mkfifo(path("slow.csv").c_str(), 0600), 0);
  RunningProgram program{{"annotate", path("slow.csv"), "--no-browser"}};
  int writes{-1};
  for (int i = 0; i < 2000 && writes < 0; ++i) {  // opened as soon as the program reads
    writes = ::open(path("slow.csv").c_str(), O_WRONLY | O_NONBLOCK);
    if (writes < 0) std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  ASSERT_GE(writes, 0) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  ::close(writes);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(outcome.err, "saccade annotate: interrupted\n");
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace saccade::test
