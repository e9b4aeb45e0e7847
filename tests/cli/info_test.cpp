// SPDX-License-Identifier: Apache-2.0
// saccade info: every kind of file that the program reads.
#include <gtest/gtest.h>

#include "run_program.hpp"

namespace saccade::test {
namespace {

nlohmann::json described(const fs::path& path, const std::string& kind) {
  const Outcome outcome = run_program({"info", path.string(), "--json", "-", "--quiet"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("kind"), kind);
  return result;
}

TEST(Info, DescribesCloudsAndMeshes) {
  const TempFolder folder;
  const fs::path cloud = folder.write("cloud.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                      "property float z\nproperty int label\nend_header\n"
                                      "0 0 0 1\n0.1 0 0 2\n0.2 0 0 2\n");
  const nlohmann::json found = described(cloud, "cloud").at("cloud");
  EXPECT_EQ(found.at("points"), 3);
  EXPECT_EQ(found.at("fields").at(3).at("name"), "label");
  EXPECT_NEAR(found.at("spacing_m").get<double>(), 0.1, 1e-6);
  EXPECT_NEAR(found.at("bounds_m").at("max").at(0).get<double>(), 0.2, 1e-6);
  EXPECT_EQ(found.at("labels"), 2);
  EXPECT_EQ(found.at("labelled_points"), 3);
  const Outcome text = run_program({"info", cloud.string()});
  EXPECT_NE(text.out.find("100.00 mm, median to the nearest point"), std::string::npos) << text.out;
  const fs::path mesh = folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  EXPECT_EQ(described(mesh, "mesh").at("mesh").at("triangles"), 1);
}

TEST(Info, DescribesScenesCellsAndArms) {
  const TempFolder folder;
  const nlohmann::json scene = described(tiny_cell_file(), "scene").at("scene");
  EXPECT_GE(scene.at("objects").size(), 2U);
  const fs::path cell = folder.write("cell.yaml",
                                     "cell: bench\nworkspace: {min: [0, 0, 0], max: [1, 1, 1]}\n"
                                     "scan: [{from: [0, 0, 2], look_at: [0, 0, 0]}]\n"
                                     "camera: {command: ./camera.py}\n");
  EXPECT_EQ(described(cell, "cell").at("scene").at("devices").at(0), "camera");
  const fs::path arm = source_folder() / "robots" / "ur_like.urdf";
  EXPECT_EQ(described(arm, "arm").at("arm").at("joints"), 6);
}

TEST(Info, DescribesRecordingsAndResults) {
  const TempFolder folder;
  make_sample(folder / "frames", 2);
  const nlohmann::json frames = described(folder / "frames", "frames").at("frames");
  EXPECT_EQ(frames.at("count"), 2);
  EXPECT_EQ(frames.at("poses"), true);
  EXPECT_EQ(frames.at("complete"), true);
  const fs::path result = folder / "result.json";
  ASSERT_EQ(run_program({"scene", "list", "--json", result.string()}).status, 0);
  EXPECT_EQ(described(result, "result").at("run").at("command"), "scene");
}

TEST(Info, SaysWhatItReadsWhereItCannot) {
  const TempFolder folder;
  expect_failure(run_program({"info", (folder / "none").string()}), 3, "info", {"no such file or folder"});
  const fs::path unknown = folder.write("a.docx", "?");
  expect_failure(run_program({"info", unknown.string()}), 3, "info", {"a.docx", ".sacmap", ".urdf", "RGB-D frames"});
  fs::create_directories(folder / "empty");
  expect_failure(run_program({"info", (folder / "empty").string()}), 3, "info", {"holds no run and no frames"});
}

}  // namespace
}  // namespace saccade::test
