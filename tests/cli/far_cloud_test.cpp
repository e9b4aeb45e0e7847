// SPDX-License-Identifier: Apache-2.0
// Clouds in map coordinates: annotate, segment and info answer as for the cloud around the origin.
#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/label_io.hpp"

namespace saccade::test {
namespace {

const Eigen::Vector3d kFar_m{461234.5, 5263456.25, 512.0};

/// A flat patch of 25 x 20 points, 2 cm apart, around an origin; doubles.
void write_patch(const fs::path& path, const Eigen::Vector3d& origin_m) {
  std::vector<std::vector<double>> axes(3);
  for (int i = 0; i < 500; ++i) {
    axes[0].push_back(origin_m.x() + 0.02 * (i % 25));
    axes[1].push_back(origin_m.y() + 0.02 * (i / 25));
    axes[2].push_back(origin_m.z());
  }
  ColumnTable table;
  table.add<double>("x", axes[0]);
  table.add<double>("y", axes[1]);
  table.add<double>("z", axes[2]);
  ASSERT_TRUE(write_ply(path, table));
}

std::string place_text(const Eigen::Vector3d& p) {
  return "[" + nlohmann::json(p.x()).dump() + ", " + nlohmann::json(p.y()).dump() + ", " +
         nlohmann::json(p.z()).dump() + "]";
}

/// A click in a corner by its place, then paint in a rectangle seen by a camera 1 m above the patch.
std::string script_at(const Eigen::Vector3d& origin_m) {
  const Eigen::Vector3d eye_m = origin_m + Eigen::Vector3d{0.25, 0.2, 1.0};
  const auto row = [](const char* turn, double at) {
    return "[" + std::string{turn} + ", " + nlohmann::json(at).dump() + "]";
  };
  const std::string pose = "[" + row("1, 0, 0", eye_m.x()) + ", " + row("0, -1, 0", eye_m.y()) + ", " +
                           row("0, 0, -1", eye_m.z()) + ", [0, 0, 0, 1]]";
  return R"({"do": "set", "label": 1, "at": )" + place_text(origin_m) + "}\n" +
         R"({"do": "paint", "label": 2, "view": {"size": [200, 200], "fov_deg": 40, "T_world_camera": )" + pose +
         R"(}, "rectangle": [90, 90, 110, 110]})" + "\n";
}

Outcome annotate(const TempFolder& folder, const char* name, const Eigen::Vector3d& origin_m) {
  const fs::path cloud = folder / (std::string{name} + ".ply");
  write_patch(cloud, origin_m);
  const fs::path script = folder.write(std::string{name} + ".jsonl", script_at(origin_m));
  return run_program({"--json", "-", "--quiet", "annotate", cloud.string(), "--script", script.string(), "--session",
                      (folder / (std::string{name} + ".sacann")).string(), "--out",
                      (folder / (std::string{name} + "-labels.ply")).string()});
}

TEST(FarClouds, AnnotationIsThatOfTheCloudAroundTheOrigin) {
  const TempFolder folder;
  const Outcome near = annotate(folder, "near", Eigen::Vector3d::Zero());
  const Outcome far = annotate(folder, "far", kFar_m);
  ASSERT_EQ(near.status, 0) << near.err;
  ASSERT_EQ(far.status, 0) << far.err;
  EXPECT_EQ(far.json().at("result").at("labelled"), 500);
  const auto labels_of = [&](const char* name) { return read_labels(folder / name, 500).value(); };
  const std::vector<std::uint32_t> labels = labels_of("far-labels.ply");
  EXPECT_EQ(labels, labels_of("near-labels.ply"));
  EXPECT_GT(std::count(labels.begin(), labels.end(), 2U), 10) << "the rectangle";
  EXPECT_EQ(read_cloud(folder / "far-labels.ply").value().fields().find("x")->value(1), 461234.5 + 0.02)
      << "doubles stay";
}

TEST(FarClouds, SegmentsAndFactsAreThoseOfTheCloudAroundTheOrigin) {
  const TempFolder folder;
  write_patch(folder / "near.ply", Eigen::Vector3d::Zero());
  write_patch(folder / "far.ply", kFar_m);
  const Outcome near = run_program({"--json", "-", "segment", (folder / "near.ply").string()});
  const Outcome far = run_program({"--json", "-", "segment", (folder / "far.ply").string()});
  ASSERT_EQ(near.status, 0) << near.err;
  ASSERT_EQ(far.status, 0) << far.err;
  EXPECT_EQ(far.json().at("result").at("found"), near.json().at("result").at("found"));
  EXPECT_NE(far.err.find("(461200, 5263500, 500) is subtracted"), std::string::npos) << far.err;
  EXPECT_EQ(near.err.find("subtracted"), std::string::npos);
  const nlohmann::json info = run_program({"--json", "-", "info", (folder / "far.ply").string()}).json();
  const nlohmann::json& cloud = info.at("result").at("cloud");
  EXPECT_NEAR(cloud.at("bounds_m").at("min").at(0).get<double>(), kFar_m.x(), 1e-4);
  EXPECT_NEAR(cloud.at("spacing_m").get<double>(), 0.02, 1e-5);
  EXPECT_EQ(cloud.at("offset_m").at(1), 5263500.0);
}

}  // namespace
}  // namespace saccade::test
