// SPDX-License-Identifier: Apache-2.0
// saccade show, and explore --show.
#include <gtest/gtest.h>

#include <csignal>

#include "run_program.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

Arguments short_run(const fs::path& out) {
  return {"explore",      tiny_cell_file(), "--out",       out.string(), "--image-size", "128,96",
          "--voxel-size", "0.02",           "--max-views", "2",          "--min-gain",   "5",
          "--strategy",   "attention",      "--quiet"};
}

/// The document's summary, and that it is served until it is interrupted.
nlohmann::json shown(const fs::path& subject, const fs::path& results) {
  RunningProgram program{{"show", subject.string(), "--no-browser", "--json", results.string()}};
  const bool serves = wait_for_file(results);
  EXPECT_TRUE(serves) << program.err();
  std::this_thread::sleep_for(std::chrono::milliseconds{200});
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("http://localhost:"), std::string::npos) << outcome.out;
  const auto document = read_json(results);
  EXPECT_TRUE(document);
  return document ? document->value("result", nlohmann::json::object()) : nlohmann::json::object();
}

std::size_t layers_of(const nlohmann::json& document, const std::string& name, std::size_t step) {
  std::size_t found{0};
  for (const nlohmann::json& layer : document.at("layers")) {
    found += layer.at("name") == name && layer.value("step", std::size_t{99}) == step ? 1 : 0;
  }
  return found;
}

TEST(ShowCommand, ShowsAnExplorationViewByView) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers; ShowsARunWhileItGoesOn runs one";
  const TempFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(run_program(short_run(run)).status, 0);
  const auto figures = read_json(run / "run.json");
  ASSERT_TRUE(figures);
  const nlohmann::json& views = figures->at("result").at("views");
  ASSERT_EQ(views.size(), 2U);
  const nlohmann::json document = shown(run, folder / "shown.json");
  EXPECT_EQ(document.at("kind"), "run");
  EXPECT_EQ(document.at("title"), "Exploration of tiny-cell");
  ASSERT_EQ(document.at("steps").size(), 3U);  // with the scan
  EXPECT_TRUE(document["steps"][0].at("T_world_camera").is_null());
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::json& step = document["steps"][i + 1];
    const auto pose = pose_from_json(step.at("T_world_camera"));
    const auto expected = pose_from_json(views[i].at("T_world_camera"));
    ASSERT_TRUE(pose && expected);
    EXPECT_LT((pose->matrix() - expected->matrix()).norm(), 1e-12);
    EXPECT_EQ(step.at("pictures").size(), 4U) << step;
    for (const char* name : {"Surface", "Frontier of the unknown", "Candidates", "Where rays end", "Arm",
                             "The camera's way", "Saliency of segments", "Contours"}) {
      EXPECT_EQ(layers_of(document, name, i + 1), 1U) << name;
    }
  }
  EXPECT_EQ(layers_of(document, "Surface", 0), 1U);

  // As an older version would have left it.
  for (const auto& entry : fs::directory_iterator{run}) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("view-") && !name.ends_with(".png")) fs::remove(entry.path());
  }
  const nlohmann::json older = shown(run, folder / "older.json");
  ASSERT_EQ(older.at("steps").size(), 3U);
  EXPECT_EQ(layers_of(older, "Surface", 1), 0U);
  EXPECT_EQ(layers_of(older, "Arm", 1), 1U);
  EXPECT_EQ(layers_of(older, "Surface", 99), 1U);  // belongs to no step
}

TEST(ShowCommand, ShowsARunWhileItGoesOn) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  Arguments arguments = short_run(run) + Arguments{"--show", "--no-browser", "--no-pictures"};
  arguments.erase(std::find(arguments.begin(), arguments.end(), "--quiet"));
  RunningProgram program{arguments};
  ASSERT_TRUE(program.wait_for("shown until Ctrl-C")) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(outcome.out.find("http://localhost:"), outcome.out.find("view  1")) << outcome.out;
  EXPECT_TRUE(fs::exists(run / "run.json"));
  EXPECT_FALSE(fs::exists(run / "journal.json"));
  EXPECT_TRUE(fs::exists(run / "view-02.sacmap"));
}

TEST(ShowCommand, RefusesWhatItCannotShow) {
  const TempFolder folder;
  const auto show = [](const fs::path& subject, const Arguments& more = {}) {
    return run_program(Arguments{"show", subject.string(), "--no-browser"} + more);
  };
  expect_failure(show(folder / "absent"), 3, "show", {"absent", "no such file"});
  expect_failure(show(folder.path()), 3, "show", {"holds no run"});
  expect_failure(show(folder.write("words.md", "words")), 3, "show", {"words.md", "nothing to show"});
  expect_failure(show(folder.write("broken.sacmap", "words")), 3, "show", {"broken.sacmap"});
  expect_failure(show(folder.write("broken.ply", "words")), 3, "show", {"broken.ply"});
  expect_failure(show(folder.write("broken.stl", "words")), 3, "show", {"broken.stl"});
  expect_failure(show(folder.write("run/run.json", "{").parent_path()), 3, "show", {"run.json"});
  const auto result = [&](const std::string& text) { return folder.write("run/run.json", text).parent_path(); };
  expect_failure(show(result(R"({"command": "explore", "result": {"initial": {"views": 1}}})")), 3, "show",
                 {"damaged", "unknown_left", "run"});
  expect_failure(show(result(R"({"command": "explore", "result": {"views": [{"region": 0, "T_world_camera": 1}]}})")),
                 3, "show", {"a pose must be", "view 1"});
  const fs::path cloud = folder.write("cloud.xyz", "0 0 0\n1 0 0\n");
  expect_failure(show(cloud, {"--port", "70000"}), 2, "show", {"--port"});
  expect_failure(run_program(short_run(folder / "out") + Arguments{"--port", "1234"}), 2, "explore",
                 {"--port", "--show"});
}

}  // namespace
}  // namespace saccade::test
