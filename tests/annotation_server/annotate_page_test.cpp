// SPDX-License-Identifier: Apache-2.0
// saccade annotate with its page: the program is started, spoken to over its socket, killed and started again.
#include <sys/stat.h>

#include "annotation_server/served_annotation.hpp"
#include "cli/annotated_boxes.hpp"
#include "saccade/core/clock.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Arguments;
using test::operator+;
using test::ServedAnnotation;

class AnnotatePageTest : public test::AnnotatedBoxes {
 protected:
  [[nodiscard]] Arguments serve(const Arguments& more = {}, const std::string& cloud = "cloud.csv") const {
    return Arguments{"annotate", path(cloud), "--max-path", "10", "--no-browser"} + more;
  }
  static void four_clicks_on(ServedAnnotation& served) {
    int label{0};
    for (const int point : std::vector<int>{kOnTable, 50 * 120 + 20, kOnBox2, kOnBox3}) {
      EXPECT_TRUE(served.act({{"do", "set"}, {"label", ++label}, {"points", {point}}}).at("ok"));
    }
  }
};

TEST_F(AnnotatePageTest, WholeAnnotationWithAKillBetween) {
  {
    ServedAnnotation served{serve()};
    ASSERT_TRUE(served.is_served()) << served.program().err();
    served.connect();
    EXPECT_EQ(served.open().at("cloud").at("points"), kPoints);
    four_clicks_on(served);
    EXPECT_TRUE(served.act({{"do", "undo"}}).at("done"));
    served.program().send(SIGKILL);
  }
  ServedAnnotation served{serve()};
  ASSERT_TRUE(served.is_served()) << served.program().err();
  served.connect();
  const json opened = served.open();
  EXPECT_EQ(opened.at("client_actions"), 5);
  EXPECT_TRUE(served.act({{"do", "redo"}}).at("done"));
  EXPECT_TRUE(served.ask({{"type", "save"}}).at("ok"));
  EXPECT_EQ(*read_labels(folder_ / "cloud_labels.csv", kPoints), truth());
  EXPECT_TRUE(fs::exists(folder_ / "cloud_labels.names.json"));
  const test::Answer file = served.get("/data/labels?cloud=0&format=txt");
  EXPECT_EQ(file.status, 200);
  EXPECT_NE(file.head.find("cloud_labels.txt"), std::string::npos);
  served.program().send(SIGTERM);
  EXPECT_EQ(served.program().finish().status, 0);
  // The labels are the program's own, so it begins again without a word about them.
  EXPECT_TRUE(ServedAnnotation{serve()}.is_served());
}

TEST_F(AnnotatePageTest, AFolderHasItsSessionsAndLabelsInIt) {
  write_boxes("a", 30, "clouds");
  write_boxes("b", 40, "clouds");
  fs::remove(folder_ / "clouds/a.txt");
  fs::remove(folder_ / "clouds/b.txt");
  ServedAnnotation served{serve({}, "clouds")};
  ASSERT_TRUE(served.is_served()) << served.program().err();
  served.connect();
  EXPECT_EQ(served.open(1).at("cloud").at("name"), "b.csv");
  four_clicks_on(served);
  EXPECT_TRUE(served.ask({{"type", "save"}}).at("ok"));
  EXPECT_TRUE(fs::exists(folder_ / "clouds/b.sacann"));
  EXPECT_FALSE(fs::exists(folder_ / "clouds/a.sacann"));
  EXPECT_TRUE(fs::exists(folder_ / "clouds/labels/b.csv"));
  served.program().send(SIGINT);
  EXPECT_EQ(served.program().finish().status, 0);
}

TEST_F(AnnotatePageTest, SaysWhatIsWrongBeforeThereIsAPage) {
  const auto expect_refused = [&](const Arguments& arguments, const std::string& why, int status) {
    const test::Outcome outcome = test::run_program(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out.find("http"), std::string::npos);
  };
  ServedAnnotation served{serve()};
  ASSERT_TRUE(served.is_served());
  expect_refused(serve(), "another program has this session open", 4);
  served.program().send(SIGTERM);
  EXPECT_EQ(served.program().finish().status, 0);

  expect_refused({"annotate", path("cloud.csv"), "--max-path", "20"}, "this session was begun with 10", 3);
  const std::string script = write("script.jsonl", four_clicks());
  expect_refused(serve({"--script", script}), "--script", 2);
  expect_refused({"annotate", path("cloud.csv"), "--page", "--simulate", path("cloud.txt")}, "--simulate", 2);
  expect_refused({"annotate", path("cloud.csv"), "--picture", path("x.png")}, "--picture", 2);
  write("cloud_labels.csv", "somebody else's");
  expect_refused(serve(), "name another place: --out", 3);
  EXPECT_EQ(text("cloud_labels.csv"), "somebody else's");
  EXPECT_TRUE(ServedAnnotation{serve({"--out", path("mine.npy")})}.is_served());
  write("bad.pcd", "no cloud");
  expect_refused({"annotate", path("bad.pcd")}, "bad.pcd", 3);
}

TEST_F(AnnotatePageTest, CtrlCDoesNotWaitForACloudThatIsRead) {
  const std::string endless = path("endless.xyz");
  ASSERT_EQ(::mkfifo(endless.c_str(), 0600), 0);  // no process ever writes to it
  for (const int signal : {SIGINT, SIGTERM}) {
    test::RunningProgram program{serve({}, "endless.xyz")};
    std::this_thread::sleep_for(std::chrono::milliseconds{test::kSanitized ? 2500 : 500});  // it listens by then
    const Stopwatch stopwatch;
    program.send(signal);
    const test::Outcome outcome = program.finish();
    EXPECT_LT(stopwatch.elapsed_ms(), 2'000.0);
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_EQ(outcome.err, "saccade annotate: interrupted\n");
  }
}

TEST_F(AnnotatePageTest, GoesOnWithASessionOfAScript) {
  const std::string script = write("script.jsonl", four_clicks());
  EXPECT_EQ(test::run_program(annotate({"--script", script, "--session", path("s.sacann")})).status, 0);
  ServedAnnotation served{serve({"--page", "--session", path("s.sacann"), "--out", path("out.label")})};
  ASSERT_TRUE(served.is_served()) << served.program().err();
  served.connect();
  const json opened = served.open();
  EXPECT_EQ(opened.at("sequence"), 4);
  EXPECT_EQ(opened.at("client_actions"), 0);
  EXPECT_EQ(opened.at("labels").size(), 4U);
  EXPECT_TRUE(served.ask({{"type", "save"}}).at("ok"));
  EXPECT_EQ(*read_labels(folder_ / "out.label", kPoints), truth());
}

}  // namespace
}  // namespace saccade
