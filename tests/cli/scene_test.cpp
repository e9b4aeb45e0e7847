// SPDX-License-Identifier: Apache-2.0
// saccade scene list, render, export.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::test {
namespace {

TEST(SceneCommand, ListsTheBuiltInScenes) {
  const Outcome people = run_program({"scene", "list"});
  EXPECT_EQ(people.status, 0);
  for (const char* name : {"bottle", "jug", "tabletop-1", "tabletop-4", "desk", "clutter:SEED"}) {
    EXPECT_NE(people.out.find(name), std::string::npos) << name;
  }
  const Outcome machine = run_program({"scene", "list", "--json", "-"});
  EXPECT_EQ(machine.json().at("result").at("scenes").size(), 13U) << machine.out;
}

TEST(SceneCommand, DrawsAScene) {
  const TempFolder folder;
  const fs::path picture = folder / "jug.png";
  const Outcome outcome = run_program({"scene", "render", "jug", "--out", picture.string(), "--image-size", "320,240"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto image = read_color(picture);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width(), 320);
  EXPECT_EQ(image->height(), 240);
  EXPECT_NE((*image)(0, 0), (*image)(160, 120));  // background and table
}

TEST(SceneCommand, ExportsItsTruth) {
  const TempFolder folder;
  const fs::path out = folder / "truth";
  const Outcome outcome =
      run_program({"scene", "export", "clutter:4", "--out", out.string(), "--spacing", "0.02", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto mesh = read_ply(out / "true_mesh.ply");
  const auto surface = read_ply(out / "surface.ply");
  const auto summary = read_json(out / "scene.json");
  ASSERT_TRUE(mesh && surface && summary);
  const auto labels = mesh->find("vertex")->table.find("label")->values<std::int32_t>();
  EXPECT_EQ(*std::max_element(labels.begin(), labels.end()) + 1, static_cast<int>(summary->at("objects").size()));
  const ColumnTable& points = surface->find("vertex")->table;
  const auto seen = points.find("observable")->values<std::uint8_t>();
  EXPECT_EQ(points.rows, summary->at("surface").at("points").get<std::size_t>());
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), summary->at("surface").at("observable").get<std::ptrdiff_t>());
  EXPECT_GT(std::count(seen.begin(), seen.end(), 0), 100);
  EXPECT_GT(std::count(seen.begin(), seen.end(), 1), 1000);
}

TEST(SceneCommand, RefusesWhatItCannotDo) {
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  const auto refused = [](const Arguments& arguments, int status, const std::string& part) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  refused({"scene"}, 2, "name what to do: export, list, render, scan or sequence");
  refused({"scene", "render", "atrium", "--out", out}, 3, "atrium: no such scene; there are bottle");
  refused({"scene", "render", "jug"}, 2, "--out");
  refused({"scene", "render", "jug", "--out", out, "--image-size", "0,5"}, 2, "--image-size");
  refused({"scene", "export", "jug", "--out", out, "--spacing", "-1"}, 2, "--spacing");
  refused({"scene", "render", "bottel", "--out", out}, 3, "did you mean bottle?");
  refused({"scene", "scan", "room:1", "--step", "4", "--out", (folder / "none" / "room.pcd").string()}, 3,
          "cannot create a file in this folder");  // before it scans
  const fs::path typo = folder.write("typo.yaml", "scene: a\nworkspce: 3\n");
  refused({"scene", "render", typo.string(), "--out", out}, 3,
          "typo.yaml, line 2, column 1: unknown key workspce in a scene; known here: ");
  refused({"scene", "render", typo.string(), "--out", out}, 3, "; did you mean workspace?");
  const fs::path missing = folder.write("missing.yaml", "scene: a\n");
  refused({"scene", "render", missing.string(), "--out", out}, 3, "a scene needs the key workspace");
  const fs::path map = folder.write("map.sacmap", std::string("SACMAP\0\1", 8));
  refused({"scene", "render", map.string(), "--out", out}, 3, "map.sacmap: is a saved map, not a text in YAML");
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace saccade::test
