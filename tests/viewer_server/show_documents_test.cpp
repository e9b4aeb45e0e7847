// SPDX-License-Identifier: Apache-2.0
// Files as documents of the viewer; where rays end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/views/view_gain.hpp"
#include "server/show/open_document.hpp"
#include "server/show/ray_hits.hpp"
#include "support/effort.hpp"
#include "support/random_map.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {
namespace {

using namespace server;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}, {0.0F, 0.0F, 3.0F}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

const Layer* layer_named(const SceneDocument& document, const std::string& name) {
  for (const Layer& layer : document.layers) {
    if (layer.name == name) return &layer;
  }
  return nullptr;
}

TEST(ShowDocuments, AMeshIsToldFromACloud) {
  const TempFolder folder;
  ASSERT_TRUE(write_mesh(folder / "mesh.ply", tetrahedron()));
  const auto mesh = open_document(folder / "mesh.ply", {});
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->kind, DocumentKind::mesh);
  EXPECT_EQ(mesh->title, "mesh.ply");
  ASSERT_EQ(mesh->layers.size(), 1U);
  EXPECT_EQ(mesh->layers[0].count, 4U);
  EXPECT_EQ(mesh->layers[0].vertices, 4U);
  EXPECT_EQ(mesh->bounds.max, Eigen::Vector3d(1.0, 2.0, 3.0));
  folder.write("solid.STL",
               "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
               "endloop\nendfacet\nendsolid a\n");
  folder.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const char* name : {"solid.STL", "part.obj"}) {
    const auto other = open_document(folder / name, {});
    ASSERT_TRUE(other) << other.error().to_string();
    EXPECT_EQ(other->kind, DocumentKind::mesh) << name;
    EXPECT_EQ(other->layers[0].count, 1U) << name;
  }
}

TEST(ShowDocuments, ACloudHasItsColoursAndLabels) {
  const TempFolder folder;
  folder.write("cloud.xyz", "x,y,z,r,g,b,label\n0,0,0,255,0,0,0\n1,0,0,0,255,0,4\nnan,0,0,9,9,9,4\n0,2,0,0,0,255,4\n");
  const auto cloud = open_document(folder / "cloud.xyz", {});
  ASSERT_TRUE(cloud) << cloud.error().to_string();
  EXPECT_EQ(cloud->kind, DocumentKind::cloud);
  ASSERT_EQ(cloud->layers.size(), 2U);
  const Layer& points = cloud->layers[0];
  EXPECT_EQ(points.count, 3U);  // without the point that is not finite
  const std::vector<std::uint8_t>& bytes = points.buffer->bytes;
  ASSERT_EQ(bytes.size(), 3U * 16);
  EXPECT_EQ((std::vector<std::uint8_t>{bytes.begin() + 36, bytes.begin() + 40}),
            (std::vector<std::uint8_t>{255, 0, 0, 255}));
  const Layer& labels = cloud->layers[1];
  ASSERT_EQ(labels.legend.size(), 2U);
  EXPECT_EQ(labels.legend[0].text, "4: 2 points");
  EXPECT_NE(std::memcmp(labels.buffer->bytes.data() + 36, labels.buffer->bytes.data() + 40, 4), 0);
  EXPECT_EQ(std::memcmp(labels.buffer->bytes.data() + 40, labels.buffer->bytes.data() + 44, 4), 0);
  EXPECT_EQ(cloud->bounds.max.y(), 2.0);
}

TEST(ShowDocuments, AMapHasItsSurfaceAndFrontier) {
  const TempFolder folder;
  RandomMap random{5};
  for (int i = 0; i < 6; ++i) random.step();
  const TsdfSnapshot map = random.snapshot();
  ASSERT_TRUE(save_map(map, folder / "map.sacmap"));
  const auto shown = open_document(folder / "map.sacmap", {});
  ASSERT_TRUE(shown) << shown.error().to_string();
  EXPECT_EQ(shown->kind, DocumentKind::map);
  const Layer* const surface = layer_named(*shown, "Surface");
  const Layer* const frontier = layer_named(*shown, "Frontier of the unknown");
  ASSERT_NE(surface, nullptr);
  ASSERT_NE(frontier, nullptr);
  EXPECT_EQ(surface->count, extract_mesh(map, {}).triangles.size());
  EXPECT_GT(surface->count, 0U);
  EXPECT_EQ(frontier->visible, map.config.workspace.has_value());
  EXPECT_LT(frontier->opacity, 1.0) << "the surface is seen through it";
  ASSERT_EQ(frontier->buffer->bytes.size(), 12 * frontier->count);
  EXPECT_EQ(frontier->size_m, map.config.voxel_size_m);
  std::size_t checked{0};
  for (std::size_t i = 0; i < frontier->count; ++i) {
    std::array<float, 3> center{};
    std::memcpy(center.data(), frontier->buffer->bytes.data() + 12 * i, sizeof center);
    const auto index = [&](float x) { return static_cast<std::int32_t>(std::floor(x / map.config.voxel_size_m)); };
    const Index3 voxel{index(center[0]), index(center[1]), index(center[2])};
    bool beside_empty{false};
    for (const Index3& face :
         {Index3{1, 0, 0}, Index3{-1, 0, 0}, Index3{0, 1, 0}, Index3{0, -1, 0}, Index3{0, 0, 1}, Index3{0, 0, -1}}) {
      beside_empty = beside_empty || map.grid.state(voxel + face) == VoxelState::empty;
    }
    checked += map.grid.state(voxel) == VoxelState::unknown && beside_empty ? 1 : 0;
  }
  EXPECT_EQ(checked, frontier->count);
}

TEST(ShowDocuments, AFusionHasTheCamerasWay) {
  const TempFolder folder;
  folder.write("run.json", R"({"command": "fuse", "result": {"frames": 3, "tracking": "icp"}})");
  folder.write("trajectory.txt", "0 0 0 1 0 0 0 1\n1 0.1 0 1 0 0 0 1\n2 0.1 0.2 1 0 0 0 1\n");
  const auto shown = open_document(folder.path(), {});
  ASSERT_TRUE(shown) << shown.error().to_string();
  EXPECT_EQ(shown->kind, DocumentKind::run);
  EXPECT_EQ(shown->facts, (Facts{{"frames", "3"}, {"tracking", "icp"}}));
  ASSERT_EQ(shown->layers.size(), 1U) << "no map, no mesh";
  EXPECT_EQ(shown->layers[0].count, 2U);
  EXPECT_FALSE(shown->layers[0].step);

  folder.write("trajectory.txt", "no trajectory");
  const auto without = open_document(folder.path(), {});
  ASSERT_TRUE(without) << without.error().to_string();
  EXPECT_TRUE(without->layers.empty());
}

TEST(ShowDocuments, TheUpdateOfACellHasTheViewsOfAllItsTasks) {
  const TempFolder folder;
  const auto views = [](std::size_t count) {
    ViewRecord view;
    view.gain_predicted = 80.0;
    return views_to_json(std::vector<ViewRecord>(count, view));
  };
  const nlohmann::json result{{"cell", "bench"},
                              {"initial", scan_to_json(ScanRecord{})},
                              {"tasks", {{{"views", views(2)}}, {{"views", views(0)}}, {{"views", views(1)}}}}};
  folder.write("update.json", nlohmann::json{{"command", "update"}, {"result", result}}.dump());
  for (const char* picture : {"task-1/view-01-seen.png", "task-3/view-01-seen.png"}) folder.write(picture, "a picture");
  const auto shown = open_document(folder.path(), {});
  ASSERT_TRUE(shown) << shown.error().to_string();
  EXPECT_EQ(shown->title, "Updates of bench");
  EXPECT_EQ(shown->facts, (Facts{{"scene", "bench"}, {"views", "3"}, {"tasks", "3"}}));
  ASSERT_EQ(shown->steps.size(), 4U);
  EXPECT_EQ(shown->steps[0].name, "Scan");
  EXPECT_EQ(shown->steps[1].name, "Task 1, view 1");
  EXPECT_EQ(shown->steps[2].name, "Task 1, view 2");
  EXPECT_EQ(shown->steps[3].name, "Task 3, view 1");
  EXPECT_TRUE(shown->steps[3].T_world_camera);
  ASSERT_EQ(shown->steps[1].pictures.size(), 1U);
  ASSERT_EQ(shown->steps[3].pictures.size(), 1U);
  EXPECT_EQ(shown->steps[1].pictures[0].name, "task-1/view-01-seen.png");
  EXPECT_EQ(shown->steps[3].pictures[0].name, "task-3/view-01-seen.png");
  EXPECT_EQ(shown->steps[3].pictures[0].path, folder / "task-3/view-01-seen.png");

  folder.write("update.json", R"({"command": "update", "result": {"cell": "bench", "tasks": [7]}})");
  const auto odd = open_document(folder.path(), {});
  ASSERT_TRUE(odd) << odd.error().to_string();
  EXPECT_TRUE(odd->steps.empty());
}

TEST(ShowDocuments, AFolderWithoutARunSaysWhereItsPageIs) {
  const TempFolder folder;
  const auto refused = [](const std::filesystem::path& path) {
    const auto document = open_document(path, {});
    EXPECT_FALSE(document) << path;
    return document ? std::string{} : document.error().message;
  };
  folder.write("segments/report.html", "a page");
  folder.write("compared/index.html", "a page");
  folder.write("cell/update.json", "{}");
  folder.write("cell/task-1/report.html", "a page");
  folder.write("bare/words.md", "words");
  for (const std::string slash : {"", "/"}) {
    const auto in = [&](const char* name) { return refused((folder / name).string() + slash); };
    EXPECT_TRUE(in("segments").ends_with("open " + (folder / "segments/report.html").string() + " in a browser"));
    EXPECT_TRUE(in("compared").ends_with("open " + (folder / "compared/index.html").string() + " in a browser"));
    EXPECT_NE(in("cell/task-1").find("show " + (folder / "cell").string() + ";"), std::string::npos);
    EXPECT_EQ(in("bare").find("browser"), std::string::npos);
  }
}

TEST(ShowDocuments, SaysWhatIsNothingToShow) {
  const TempFolder folder;
  const auto code_of = [](const std::filesystem::path& path) {
    const auto document = open_document(path, {});
    EXPECT_FALSE(document) << path;
    return document ? Errc::cancelled : document.error().code;
  };
  EXPECT_EQ(code_of(folder / "absent"), Errc::not_found);
  EXPECT_EQ(code_of(folder.path()), Errc::not_found);  // no run in it
  EXPECT_EQ(code_of(folder.write("text.md", "words")), Errc::unsupported);
  EXPECT_EQ(code_of(folder.write("map.sacmap", "words")), Errc::corrupt_data);
  EXPECT_EQ(code_of(folder.write("mesh.ply", "words")), Errc::corrupt_data);
  EXPECT_EQ(code_of(folder.write("run/run.json", "[]").parent_path()), Errc::corrupt_data);
  EXPECT_EQ(
      code_of(
          folder.write("run/run.json", R"({"command": "explore", "result": {"views": [{"gain": 1}]}})").parent_path()),
      Errc::corrupt_data);
  EXPECT_EQ(code_of(folder.write("run/run.json", R"({"command": "explore", "result": {"views": [7]}})").parent_path()),
            Errc::corrupt_data);
}

TEST(ShowDocuments, RaysThatGainAreThoseOfTheGain) {
  const int cases = std::max(15, scaled_cases(60));  // many regions gain nothing
  std::size_t gained{0};
  int ran{0};
  for (int seed = 0; seed < cases; ++seed) {
    RandomMap random{static_cast<std::uint32_t>(seed)};
    for (int i = 0; i < 5; ++i) random.step();
    const TsdfSnapshot map = random.snapshot();
    GainConfig config;
    config.sensor = PinholeCamera{48, 36, 40.0, 40.0, 23.5, 17.5, seed % 3 == 0 ? 0.0 : 0.3, 3.0};
    const Region region = random.run().region();
    const std::vector<Pose> poses{random.run().pose()};
    const auto expected = evaluate_views(map, region, poses, config, {});
    if (!expected) continue;  // a region that is none
    const std::vector<RayHit> hits = ray_hits(map, region, config.sensor, poses[0], Executor::with_threads(2));
    const auto counted = static_cast<std::uint64_t>(
        std::count_if(hits.begin(), hits.end(), [](const RayHit& hit) { return hit.end == RayEnd::gained; }));
    EXPECT_EQ(counted, expected->gains[0]) << seed;
    gained += counted;
    ++ran;
  }
  EXPECT_GE(ran, cases / 2);
  EXPECT_GT(gained, 0U);
}

}  // namespace
}  // namespace saccade::test
