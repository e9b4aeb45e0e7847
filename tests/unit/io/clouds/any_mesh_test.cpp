// SPDX-License-Identifier: Apache-2.0
// Meshes by assimp: axes and units that files state, and files that crash, hang or fill the memory of a reader.
#include "saccade/io/clouds/any_mesh.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>

#include "saccade/io/clouds/internal/guarded_reading.hpp"
#include "support/effort.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

/// A triangle with corners (0, 0, 0), (1, 0, 0) and (0, 2, 3) in the file's units.
std::string collada(const std::string& asset) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset + R"(</asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count="9">0 0 0 1 0 0 0 2 3</float_array><technique_common><accessor source="#pa" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(AnyMesh, ANodeThatMirrorsKeepsTheOutside) {
  const test::TempFolder folder;
  const std::string whole = collada("");
  const std::string node{"<instance_geometry"};
  std::string mirrored = whole;
  mirrored.insert(mirrored.find(node), "<scale>-1 1 1</scale>");
  const auto normal_y = [](const TriangleMesh& mesh) {
    const auto& [a, b, c] = mesh.triangles.front();
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).y();
  };
  const float before = normal_y(*read_any_mesh(folder.write("a.dae", whole)));
  const float after = normal_y(*read_any_mesh(folder.write("b.dae", mirrored)));
  EXPECT_NE(before, 0.0F);
  EXPECT_EQ(after, before);  // mirrored along x, the outward normal keeps its y
}

TEST(AnyMesh, ColladaKeepsItsAxesAndTakesItsUnit) {
  const test::TempFolder folder;
  struct Case {
    const char* asset;
    char up;
    float scale;
  };
  for (const Case& c : {Case{R"(<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis>)", 'z', 1.0F},
                        Case{R"(<unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis>)", 'y', 0.0254F},
                        Case{R"(<unit meter="0.001"/><up_axis>X_UP</up_axis>)", 'x', 0.001F}, Case{"", 'y', 1.0F}}) {
    const auto path = folder.write("a.dae", collada(c.asset));
    const auto mesh = read_any_mesh(path);
    ASSERT_TRUE(mesh) << mesh.error().to_string();
    ASSERT_EQ(mesh->vertices.size(), 3U);
    EXPECT_TRUE(mesh->vertices[2].isApprox(c.scale * Eigen::Vector3f{0, 2, 3})) << c.asset << mesh->vertices[2];
    EXPECT_EQ(stated_up_axis(path), c.up) << c.asset;
  }
  EXPECT_EQ(stated_up_axis("a.glb"), 'y');
  EXPECT_EQ(stated_up_axis("a.stl"), std::nullopt);
}

TEST(AnyMesh, HostileFilesAreErrors) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers end the child with their own reports, and need its memory";
  const test::TempFolder folder;
  std::string bomb{"glTF\x02\0\0\0", 8};  // a header that claims 4 GB
  bomb += std::string{"\xF0\xFF\xFF\xFF\xF0\xFF\xFF\xFFJSON{}", 14};
  const std::vector<std::pair<std::string, std::string>> files{
      {"bomb.glb", bomb},
      {"deep.gltf", std::string(200000, '[')},
      {"fewer.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"noise.obj", std::string(3000, '\xFE')},
  };
  for (const auto& [name, content] : files) {
    const auto mesh = read_any_mesh(folder.write(name, content));
    ASSERT_FALSE(mesh) << name;
    EXPECT_EQ(mesh.error().code, Errc::corrupt_data) << name;
    EXPECT_NE(mesh.error().to_string().find(name), std::string::npos) << mesh.error().to_string();
  }
}

TEST(AnyMesh, LengthsOfAGlbAreCheckedFirst) {
  const test::TempFolder folder;
  const std::string begin{"glTF\x02\0\0\0", 8};
  for (const auto& [content, message] :
       {std::pair{begin + std::string{"\xF0\xFF\xFF\xFF\xF0\xFF\xFF\xFFJSON{}", 14}, "ends after 22"},
        std::pair{begin + std::string{"\x16\0\0\0\xF0\0\0\0JSON{}", 14}, "states 260 bytes"},
        std::pair{begin, "ends within the header"}}) {
    const auto mesh = read_any_mesh(folder.write("a.glb", content));
    EXPECT_EQ(mesh.error().code, Errc::corrupt_data);
    EXPECT_NE(mesh.error().to_string().find(message), std::string::npos) << mesh.error().to_string();
  }
}

TEST(GuardedReading, GivesTheMeshOrTheErrorOfTheReader) {
  TriangleMesh mesh;
  for (int i = 0; i < 100000; ++i) mesh.vertices.emplace_back(static_cast<float>(i), 0.5F, -1.0F);
  mesh.normals.assign(3, Eigen::Vector3f::UnitZ());
  mesh.colors.assign(2, Rgb8{1, 2, 3});
  mesh.triangles = {{0, 1, 2}, {2, 1, 99999}};
  const auto read = read_guarded("a", {}, [&]() -> Result<TriangleMesh> { return mesh; });
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->vertices, mesh.vertices);
  EXPECT_EQ(read->normals, mesh.normals);
  EXPECT_EQ(read->colors, mesh.colors);
  EXPECT_EQ(read->triangles, mesh.triangles);
  const auto wrong = read_guarded("a", {}, []() -> Result<TriangleMesh> {
    return Error{Errc::unsupported, "a reason", {}};
  });
  EXPECT_EQ(wrong.error().code, Errc::unsupported);
  EXPECT_EQ(wrong.error().message, "a reason");
  EXPECT_EQ(wrong.error().context, "a");
}

TEST(GuardedReading, CrashesHangsAndFloodsAreErrors) {
  if (test::kSanitized) GTEST_SKIP() << "sanitizers end the child with their own reports, and need its memory";
  using Read = std::function<Result<TriangleMesh>()>;
  const auto error_of = [](const ReadLimits& limits, const Read& read) {
    const auto mesh = read_guarded("a", limits, read);
    EXPECT_FALSE(mesh);
    return mesh ? std::string{} : mesh.error().message;
  };
  EXPECT_NE(error_of({}, []() -> Result<TriangleMesh> { std::abort(); }).find("crashed"), std::string::npos);
  EXPECT_NE(error_of({},
                     []() -> Result<TriangleMesh> {
                       std::raise(SIGSEGV);
                       return TriangleMesh{};
                     })
                .find("crashed"),
            std::string::npos);
  const auto flood = []() -> Result<TriangleMesh> {
    std::vector<std::unique_ptr<char[]>> blocks;
    while (true) blocks.push_back(std::make_unique<char[]>(1 << 20));
  };
  EXPECT_NE(error_of({5.0, 64 << 20}, flood).find("64 MiB"), std::string::npos);
  const auto hang = []() -> Result<TriangleMesh> {
    for (volatile bool forever = true; forever;) {
    }
    return TriangleMesh{};
  };
  EXPECT_NE(error_of({0.5, 1 << 30}, hang).find("more than 1 s"), std::string::npos);
}

}  // namespace
}  // namespace saccade
