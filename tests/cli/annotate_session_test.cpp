// SPDX-License-Identifier: Apache-2.0
// saccade annotate with scripts and sessions, as a user runs it.
#include "cli/annotated_boxes.hpp"
#include "saccade/annotate/annotation.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/sessions/annotation_script.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "saccade/io/sessions/label_presets.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

class AnnotateSession : public AnnotatedBoxes {
 protected:
  [[nodiscard]] nlohmann::json result_of(const Arguments& more) const {
    const Outcome outcome = run_program(annotate(more));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.status == 0 ? outcome.json()["result"] : nlohmann::json{};
  }
  [[nodiscard]] std::string error_of(const Arguments& arguments, int status = 3) const {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }
  /// Returns the library's result of these actions.
  [[nodiscard]] std::vector<std::uint32_t> library_labels(const std::string& script) const {
    const auto file = read_cloud(folder_ / "cloud.csv");
    const auto cloud = cloud_from_fields(file->fields());
    NeighbourhoodConfig config;
    config.max_path = 10.0;
    config.strong_borders = true;
    auto graph = Neighbourhood::build(*cloud, config, Executor{});
    Annotation annotation{std::make_shared<const Neighbourhood>(std::move(*graph))};
    const auto actions = parse_annotation_script(script);
    EXPECT_TRUE(actions) << actions.error().to_string();
    for (const ScriptedAction& scripted : *actions) {
      auto action = resolve_action(scripted, cloud->positions_m, annotation, 0, Executor{});
      EXPECT_TRUE(action) << action.error().to_string();
      annotation.apply(std::move(*action));
    }
    return {annotation.labels().begin(), annotation.labels().end()};
  }
};

TEST_F(AnnotateSession, AScriptLabelsAScene) {
  const std::string before = text("cloud.csv");
  const nlohmann::json result = result_of({"--script", write("a.jsonl", four_clicks()), "--out", path("labels.npy"),
                                           "--names", path("n.json"), "--picture", path("labels.png")});
  EXPECT_EQ(*read_labels(folder_ / "labels.npy", kPoints), truth());
  EXPECT_EQ(result["points"], kPoints);
  EXPECT_EQ(result["labelled"], kPoints);
  EXPECT_EQ(result["control_points"], kLabels);
  EXPECT_EQ(result["actions"], kLabels);
  ASSERT_EQ(result["labels"].size(), std::size_t{kLabels});
  EXPECT_EQ(result["labels"][1]["number"], 2);
  EXPECT_EQ(result["labels"][1]["points"], 40 * 20);
  EXPECT_EQ(result["labels"][1]["control_points"], 1);
  EXPECT_EQ(result["ms"]["actions"]["count"], kLabels);
  EXPECT_GT(result["ms"]["graph"], 0.0);
  EXPECT_GE(result["ms"]["actions"]["max"], result["ms"]["actions"]["median"]);
  EXPECT_EQ(result["interrupted"], false);
  EXPECT_EQ(read_label_presets(folder_ / "n.json")->size(), std::size_t{kLabels});
  EXPECT_GT(fs::file_size(path("labels.png")), 5000U);
  EXPECT_EQ(text("cloud.csv"), before);
}

TEST_F(AnnotateSession, EveryActionIsThatOfTheLibrary) {
  const std::string script =
      four_clicks() +
      R"({"do": "labels", "labels": [{"number": 9, "name": "strip", "class": "tape", "instance": 4}]})" + "\n" +
      R"({"do": "paint", "label": 9, "client": 1, "view": {"T_world_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], )" +
      R"("fov_deg": 40, "size": [400, 300], "point_size_px": 8}, "rectangle": [0, 100, 400, 140]})" + "\n" +
      R"({"do": "paint", "label": 0, "lasso": [[180, 90], [220, 90], [220, 150]], "below_m": "any"})" + "\n" +
      R"({"do": "paint", "label": 3, "client": 1, "brush": {"line": [[100, 230], [140, 230]], "radius_m": 0.02}})" +
      "\n" + R"({"do": "undo", "client": 1})" + "\n" +
      R"({"do": "move", "from": [-0.2, 0, 0.95], "to": [-0.2, 0.05, 0.95]})" + "\n" +
      R"({"do": "remove", "at": [0.2, 0, 0.95]})" + "\n";
  const nlohmann::json result = result_of({"--script", write("a.jsonl", script), "--out", path("labels.npy")});
  const auto labels = read_labels(folder_ / "labels.npy", kPoints);
  ASSERT_TRUE(labels);
  EXPECT_EQ(*labels, library_labels(script));
  EXPECT_GT(std::count(labels->begin(), labels->end(), 9U), 500);
  EXPECT_EQ(result["labels"].back()["name"], "strip");
  EXPECT_EQ(result["labels"].back()["class"], "tape");
  EXPECT_EQ(result["labels"].back()["instance"], 4);
}

TEST_F(AnnotateSession, TheScriptOfTheDocumentationDoesWhatItSays) {
  const std::string page = *read_text_file(source_folder() / "docs/guides/annotation.md");
  const std::string mark{"<!-- script -->\n```\n"};
  const std::size_t begin = page.find(mark) + mark.size();
  const std::string script = page.substr(begin, page.find("```", begin) - begin);
  const nlohmann::json result = result_of({"--script", write("a.jsonl", script)});
  EXPECT_EQ(result["actions"], 8);
  EXPECT_EQ(result["control_points"], 4);
  ASSERT_EQ(result["labels"].size(), 3U);
  EXPECT_EQ(result["labels"][1]["color"], "#ff8000");
  EXPECT_GT(result["labels"][1]["points"], 3 * 400);  // half of the boxes
  EXPECT_GT(result["labels"][2]["points"], 500);      // painted
}

TEST_F(AnnotateSession, ASessionGoesOn) {
  const std::string session = path("cloud.sacann");
  const Arguments on{"--session", session};
  write("a.jsonl", four_clicks());
  EXPECT_EQ(result_of(on + Arguments{"--script", path("a.jsonl")})["actions"], 4);
  const nlohmann::json exported = result_of(on + Arguments{"--out", path("labels.npy")});  // without a script
  EXPECT_EQ(exported["actions"], 4);
  EXPECT_EQ(exported["ms"]["actions"]["count"], 0);
  EXPECT_EQ(*read_labels(folder_ / "labels.npy", kPoints), truth());

  // Undo is everyone's own, over several runs of the program.
  write("b.jsonl", "{\"do\": \"set\", \"label\": 7, \"points\": [0]}\n{\"do\": \"undo\", \"client\": 0}\n");
  const nlohmann::json undone = result_of(on + Arguments{"--script", path("b.jsonl"), "--client", "5"});
  EXPECT_EQ(undone["actions"], 6);
  EXPECT_EQ(undone["control_points"], 4);  // box 3 is gone, the new one is there
  write("c.jsonl", "{\"do\": \"redo\"}\n{\"do\": \"undo\", \"client\": 5}\n{\"do\": \"redo\"}\n");
  const Outcome notes = run_program(
      {"annotate", path("cloud.csv"), "--session", session, "--script", path("c.jsonl"), "--out", path("labels.npy")});
  EXPECT_EQ(notes.status, 0) << notes.err;
  EXPECT_NE(notes.err.find("c.jsonl, line 3: client 0 has nothing to redo"), std::string::npos) << notes.err;
  EXPECT_NE(notes.out.find("100.0 %"), std::string::npos) << notes.out;
  EXPECT_EQ(*read_labels(folder_ / "labels.npy", kPoints), truth());
  EXPECT_EQ(read_journal(session)->actions.size(), 8U);  // what had nothing to do is not kept
}

TEST_F(AnnotateSession, TheGraphIsTheSessions) {
  const Arguments plain{"--json", "-", "annotate", path("cloud.csv"), "--session", path("s.sacann")};
  ASSERT_EQ(run_program(annotate({"--session", path("s.sacann"), "--script", write("a.jsonl", four_clicks())})).status,
            0);
  const Outcome same = run_program(plain + Arguments{"--out", path("labels.npy")});  // --max-path is not given
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(*read_labels(folder_ / "labels.npy", kPoints), truth());
  EXPECT_NE(
      error_of(plain + Arguments{"--max-path", "2"}).find("--max-path 2 does not fit: this session was begun with 10"),
      std::string::npos);
  EXPECT_NE(error_of(plain + Arguments{"--adapt-to-density"}).find("--adapt-to-density true"), std::string::npos);
  EXPECT_EQ(run_program(plain + Arguments{"--max-path", "10", "--neighbours", "10"}).status, 0);
}

TEST_F(AnnotateSession, PresetsAreDefinedOnce) {
  write("p.yaml", "labels: [{number: 1, name: table}, {number: 8, name: mug, class: '40', color: '#010203'}]");
  const Arguments begin{"--session", path("s.sacann"), "--presets", path("p.yaml")};
  const nlohmann::json result = result_of(begin);
  EXPECT_EQ(result["actions"], 1);
  ASSERT_EQ(result["labels"].size(), 2U);
  EXPECT_EQ(result["labels"][1]["name"], "mug");
  EXPECT_EQ(result["labels"][1]["color"], "#010203");
  EXPECT_EQ(result["labels"][1]["points"], 0);
  EXPECT_EQ(result_of(begin)["actions"], 1);
  EXPECT_EQ(result_of({"--session", path("s.sacann"), "--names", path("names.txt")})["actions"], 1);
  EXPECT_EQ(text("names.txt"), "1 table\n8 mug\n");
}

TEST_F(AnnotateSession, LabelsAreSeeds) {
  const Arguments seeds{"--session", path("s.sacann"), "--seeds", path("cloud.txt")};
  const nlohmann::json result = result_of(seeds + Arguments{"--out", path("labels.npy")});
  EXPECT_EQ(result["seeds"]["points"], kPoints);
  EXPECT_GE(result["seeds"]["reproduced"], 0.99 * kPoints);
  EXPECT_EQ(result["seeds"]["control_points"], result["control_points"]);
  EXPECT_EQ(result["actions"], kLabels);  // one per label
  const auto labels = read_labels(folder_ / "labels.npy", kPoints);
  const std::vector<std::uint32_t> wanted = truth();
  std::size_t same{0};
  for (std::size_t i = 0; i < kPoints; ++i) same += (*labels)[i] == wanted[i] ? 1 : 0;
  EXPECT_EQ(same, result["seeds"]["reproduced"]);
  // They can be edited, and begin a session only once.
  EXPECT_EQ(result_of({"--session", path("s.sacann"), "--script", write("u.jsonl", "{\"do\": \"undo\"}")})["actions"],
            kLabels + 1);
  EXPECT_NE(error_of(annotate(seeds)).find("holds 5 actions already"), std::string::npos);
  EXPECT_NE(error_of(annotate({"--seeds", path("cloud.csv")})).find("label"), std::string::npos);
  EXPECT_NE(error_of(annotate({"--seeds", path("cloud.txt"), "--seed-share", "2"}), 2).find("--seed-share"),
            std::string::npos);
}

TEST_F(AnnotateSession, SeedsThatWereCutShortGoOn) {
  const Arguments seeds{"--session", path("s.sacann"), "--seeds", path("cloud.txt")};
  const nlohmann::json whole = result_of(seeds);
  const SavedSession saved = read_journal(path("s.sacann")).value();
  ASSERT_GE(saved.actions.size(), 3U);
  const std::size_t two_actions = encode_journal_header(saved.subject).size() +
                                  encode_journal_record(saved.actions[0]).size() +
                                  encode_journal_record(saved.actions[1]).size();
  constexpr std::size_t kTorn{5};  // bytes of the third
  fs::resize_file(path("s.sacann"), two_actions + kTorn);
  const nlohmann::json again = result_of(seeds);
  EXPECT_EQ(again["seeds"], whole["seeds"]);
  EXPECT_EQ(again["labels"], whole["labels"]);
  EXPECT_EQ(read_journal(path("s.sacann"))->actions, saved.actions);
  EXPECT_NE(error_of(annotate(seeds)).find("actions already"), std::string::npos);
}

TEST_F(AnnotateSession, MarginsSayWhereLabelsAreInDoubt) {
  write("a.jsonl", four_clicks());
  const nlohmann::json result = result_of({"--script", path("a.jsonl"), "--margins", path("margins.ply")});
  const auto file = read_cloud(folder_ / "margins.ply");
  ASSERT_TRUE(file) << file.error().to_string();
  ASSERT_NE(file->fields().find("r"), nullptr);
  const Column* margin = file->fields().find("margin");
  ASSERT_NE(margin, nullptr);
  EXPECT_EQ(file->fields().rows, kPoints);
  const nlohmann::json next = result["next_best_click"];
  EXPECT_LT(next["point"], kPoints);
  EXPECT_EQ(next["position_m"].size(), 3U);
  EXPECT_GT(next["settles"], 0.0);
  EXPECT_EQ(next["label"], truth()[next["point"].get<std::size_t>()]);
  EXPECT_FALSE(result_of({"--script", path("a.jsonl")}).contains("next_best_click"));
  EXPECT_NE(error_of(annotate({"--script", path("a.jsonl"), "--margins", path("a.csv")}), 2).find(".ply"),
            std::string::npos);
}

TEST_F(AnnotateSession, ScriptsThatFailSayWhere) {
  const auto run = [&](const std::string& script, const Arguments& more = {}) {
    return error_of(annotate(Arguments{"--script", write("a.jsonl", script)} + more));
  };
  EXPECT_NE(run("{\"do\": \"clear\"}\n{\"do\": \"draw\"}\n").find("a.jsonl, line 2: unknown action 'draw'"),
            std::string::npos);
  EXPECT_NE(
      run("# none\n{\"do\": \"set\", \"label\": 1, \"points\": [12000]}").find("line 2: point 12000 is not one of"),
      std::string::npos);
  EXPECT_NE(run("{\"do\": \"remove\", \"points\": [4]}").find("a.jsonl, line 1: there is no control point to remove"),
            std::string::npos);
  EXPECT_NE(run("{\"do\": \"set\", \"label\": 1, \"at\": [9, 9, 9]}").find("line 1: no point within 0.05 m"),
            std::string::npos);
  // Lines before stay done, and the session says so; a line that is no action is found before any is done.
  const Arguments session{"--session", path("s.sacann")};
  EXPECT_NE(run(four_clicks() + "set 4", session).find("line 6"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("s.sacann")));
  EXPECT_NE(run(four_clicks() + "{\"do\": \"move\", \"from\": 4, \"to\": 5}", session)
                .find("line 6: point 4 is not a control point, so it cannot be moved; the 4 actions before it are in "
                      "the session"),
            std::string::npos);
  EXPECT_EQ(read_journal(path("s.sacann"))->actions.size(), 4U);
}

TEST_F(AnnotateSession, AnInterruptedScriptGoesOnInItsSession) {
  std::string script;
  for (int i = 0; i < 50'000; ++i) script += "{\"do\": \"set\", \"label\": 1, \"points\": [17]}\n";
  RunningProgram program{{"--json", path("result.json"), "annotate", path("cloud.csv"), "--session", path("s.sacann"),
                          "--script", write("a.jsonl", script), "--out", path("labels.npy")}};
  ASSERT_TRUE(program.wait_for("actions"));
  program.send(SIGTERM);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 143) << outcome.err;
  EXPECT_NE(outcome.err.find("of 50000 actions were done and are in the session"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(path("labels.npy")));
  const nlohmann::json result = nlohmann::json::parse(text("result.json"))["result"];
  EXPECT_EQ(result["interrupted"], true);
  EXPECT_EQ(result["actions"], read_journal(path("s.sacann"))->actions.size());
  EXPECT_LT(result["actions"], 50'000);
}

TEST_F(AnnotateSession, WhatIsNoSessionOfThisCloudStaysAsItIs) {
  const Arguments on{"--session", path("s.sacann")};
  EXPECT_NE(error_of(annotate(on)).find("there is no such session"), std::string::npos);
  ASSERT_EQ(run_program(annotate(on + Arguments{"--script", write("a.jsonl", four_clicks())})).status, 0);
  const std::string journal = text("s.sacann");
  write_boxes("other", 20);
  for (const Arguments& what : {Arguments{}, Arguments{"--script", path("a.jsonl")}}) {
    const std::string error = error_of(annotate(on + what, "other.csv"));
    EXPECT_NE(error.find("s.sacann"), std::string::npos) << error;
    EXPECT_NE(error.find("positions"), std::string::npos) << error;
  }
  EXPECT_NE(error_of(annotate({"--session", path("cloud.txt")})).find("cloud.txt"), std::string::npos);
  EXPECT_NE(error_of(annotate(on + Arguments{"--out", path("cloud.csv")})).find("--out"), std::string::npos);
  EXPECT_NE(error_of(annotate(on + Arguments{"--names", path("a.doc")}), 2).find(".json"), std::string::npos);
  EXPECT_EQ(text("s.sacann"), journal);

  // A torn end does not count and is said, and stays until something is done.
  write("s.sacann", journal.substr(0, journal.size() - 3));
  const Outcome torn = run_program({"annotate", path("cloud.csv"), "--session", path("s.sacann")});
  EXPECT_EQ(torn.status, 0) << torn.err;
  EXPECT_NE(torn.err.find("the last action was never finished"), std::string::npos) << torn.err;
  EXPECT_EQ(text("s.sacann").size(), journal.size() - 3);
  // A disk that is full.
  const Outcome full = run_program(annotate(on + Arguments{"--script", path("a.jsonl")}), journal.size() + 20);
  EXPECT_EQ(full.status, 3) << full.err;
  EXPECT_NE(full.err.find("cannot be written"), std::string::npos) << full.err;
}

}  // namespace
}  // namespace saccade::test
