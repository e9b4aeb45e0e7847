// SPDX-License-Identifier: Apache-2.0
// saccade annotate on folders of clouds, as a user runs it.
#include "cli/annotated_boxes.hpp"

namespace saccade::test {
namespace {

class AnnotateFolder : public AnnotatedBoxes {
 protected:
  void SetUp() override {
    write_boxes("a", 30, "clouds");
    write_boxes("b", 40, "clouds");
    write_boxes("c", 50, "clouds");
  }
  [[nodiscard]] nlohmann::json result_of(const Arguments& more, const std::string& cloud = "clouds") const {
    const Outcome outcome = run_program(annotate(more, cloud));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.status == 0 ? outcome.json()["result"] : nlohmann::json{};
  }
  [[nodiscard]] std::string error_of(const Arguments& more, int status = 3) const {
    const Outcome outcome = run_program(annotate(more, "clouds"));
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return outcome.err;
  }
};

TEST_F(AnnotateFolder, AllAreSimulated) {
  const nlohmann::json result = result_of(
      {"--simulate", path("clouds"), "--clicks", "2", "--out", path("labels"), "--picture", path("pictures")});
  ASSERT_EQ(result["clouds"].size(), 3U);
  EXPECT_EQ(result["clouds"][1]["file"], path("clouds/b.csv"));
  double iou{0.0};
  for (const nlohmann::json& cloud : result["clouds"]) {
    EXPECT_EQ(cloud["objects"], kLabels);
    iou += cloud["per_label"][0]["iou_mean"].get<double>() / 3.0;
  }
  EXPECT_NEAR(result["mean"]["per_label"][0]["iou_mean"].get<double>(), iou, 1e-12);
  EXPECT_EQ(result["mean"]["per_label"].size(), 2U);
  EXPECT_EQ(result["mean"]["noc"]["90"]["reached"], 3);
  EXPECT_EQ(result["mean"]["noc"]["90"]["never"], 0);
  EXPECT_EQ(result["mean"]["noc"]["90"]["clicks_per_label"], 1.0);
  EXPECT_EQ(names_in(path("labels")), (std::vector<std::string>{"a.csv", "b.csv", "c.csv"}));
  EXPECT_EQ(names_in(path("pictures")), (std::vector<std::string>{"a.png", "b.png", "c.png"}));
  EXPECT_EQ(*read_labels(path("labels/b.csv"), kPoints), *read_labels(path("clouds/b.txt"), kPoints));

  // One cloud by itself gives the same, and labels that were written are truth by the same names.
  const nlohmann::json one = result_of({"--simulate", path("clouds/b.txt"), "--clicks", "2"}, "clouds/b.csv");
  EXPECT_EQ(one["clicks"], result["clouds"][1]["clicks"]);
  const nlohmann::json again = result_of({"--simulate", path("labels"), "--clicks", "2"});
  EXPECT_EQ(again["mean"]["per_label"], result["mean"]["per_label"]);
  const Outcome table = run_program({"annotate", path("clouds"), "--simulate", path("labels"), "--max-path", "0.01"});
  EXPECT_NE(table.out.find("never in 3 clouds"), std::string::npos) << table.out;
}

TEST_F(AnnotateFolder, SessionsAreListedAndExported) {
  fs::create_directory(path("sessions"));
  const Arguments sessions{"--session", path("sessions")};
  const nlohmann::json none = result_of(sessions);
  ASSERT_EQ(none["clouds"].size(), 3U);
  EXPECT_EQ(none["clouds"][0]["points"], kPoints);
  EXPECT_EQ(none["clouds"][0]["actions"], 0);
  EXPECT_EQ(none["mean"]["begun"], 0);
  EXPECT_TRUE(names_in(path("sessions")).empty());

  // A session of one cloud may be named by its folder.
  const nlohmann::json one =
      result_of(sessions + Arguments{"--script", write("s.jsonl", four_clicks())}, "clouds/b.csv");
  EXPECT_EQ(one["actions"], kLabels);
  EXPECT_EQ(names_in(path("sessions")), std::vector<std::string>{"b.sacann"});
  const nlohmann::json listed = result_of(sessions + Arguments{"--out", path("labels")});
  EXPECT_EQ(listed["clouds"][0]["actions"], 0);
  EXPECT_EQ(listed["clouds"][1]["actions"], kLabels);
  EXPECT_EQ(listed["clouds"][1]["labelled"], kPoints);
  EXPECT_EQ(listed["mean"]["begun"], 1);
  EXPECT_NEAR(listed["mean"]["labelled_share"].get<double>(), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(names_in(path("labels")), std::vector<std::string>{"b.csv"});
  EXPECT_EQ(*read_labels(path("labels/b.csv"), kPoints), *read_labels(path("clouds/b.txt"), kPoints));
  const Outcome table = run_program(Arguments{"annotate", path("clouds"), "--quiet"} + sessions);
  EXPECT_NE(table.out.find("b.csv     12000   100.0 %"), std::string::npos) << table.out;
}

TEST_F(AnnotateFolder, TheFolderOfSessionsThatAreBegunIsMade) {
  const nlohmann::json result = result_of({"--session", path("new"), "--seeds", path("clouds")});
  EXPECT_EQ(result["mean"]["begun"], 3);
  EXPECT_EQ(names_in(path("new")), (std::vector<std::string>{"a.sacann", "b.sacann", "c.sacann"}));
}

TEST_F(AnnotateFolder, SeedsBeginWhatIsNotBegun) {
  fs::create_directory(path("sessions"));
  const Arguments sessions{"--session", path("sessions")};
  ASSERT_EQ(
      result_of(sessions + Arguments{"--script", write("s.jsonl", "{\"do\": \"clear\"}")}, "clouds/b.csv")["actions"],
      1);
  for (int i = 0; i < 2; ++i) {
    const nlohmann::json result = result_of(sessions + Arguments{"--seeds", path("clouds")});
    EXPECT_EQ(result["clouds"][0]["actions"], kLabels);
    EXPECT_EQ(result["clouds"][1]["actions"], 1);
    EXPECT_EQ(result["clouds"][0].contains("seeds"), i == 0);
    EXPECT_EQ(names_in(path("sessions")), (std::vector<std::string>{"a.sacann", "b.sacann", "c.sacann"}));
  }
}

TEST_F(AnnotateFolder, WhatDoesNotFitIsSaidBeforeTheWork) {
  EXPECT_NE(error_of({"--simulate", path("none")}, 2).find("none"), std::string::npos);
  EXPECT_NE(error_of({"--simulate", path("clouds/a.txt")}).find("is not a folder"), std::string::npos);
  EXPECT_NE(error_of({"--script", write("s.jsonl", four_clicks())}, 2).find("one cloud"), std::string::npos);
  EXPECT_NE(error_of({"--session", path("none")}).find("is not a folder"), std::string::npos);
  fs::create_directory(path("truth"));
  EXPECT_NE(error_of({"--simulate", path("truth")}).find("no labels of a.csv"), std::string::npos);
  EXPECT_NE(error_of({"--simulate", path("clouds"), "--out", path("clouds")}).find("--out"), std::string::npos);
  fs::copy_file(path("clouds/a.txt"), path("truth/a.txt"));
  std::ofstream{path("truth/a.label")};
  EXPECT_NE(error_of({"--simulate", path("truth")}).find("both a.label and a.txt"), std::string::npos);
  fs::copy_file(path("clouds/a.csv"), path("clouds/a.xyz"));
  EXPECT_NE(error_of({"--simulate", path("clouds")}).find("would share its files with a.csv"), std::string::npos);
}

TEST_F(AnnotateFolder, InterruptedRunsLeaveWholeFiles) {
  for (int i = 0; i < 20; ++i) write_boxes(std::string(1, static_cast<char>('d' + i)), 30, "clouds");
  RunningProgram program{{"--json", path("result.json"), "annotate", path("clouds"), "--simulate", path("clouds"),
                          "--clicks", "20", "--out", path("labels"), "--max-path", "0.05"}};
  ASSERT_TRUE(wait_for_file(folder_ / "labels" / "b.csv"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted; "), std::string::npos) << outcome.err;
  const nlohmann::json result = nlohmann::json::parse(text("result.json"))["result"];
  EXPECT_EQ(result["interrupted"], true);
  EXPECT_EQ(result["clouds"].size(), names_in(path("labels")).size());
  EXPECT_LT(result["clouds"].size(), 23U);
}

}  // namespace
}  // namespace saccade::test
