// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include <gtest/gtest.h>

#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/scene/mesh_parts.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using test::TempFolder;

/// A box from its lowest corner, written as PLY.
std::filesystem::path write_box(const TempFolder& folder, const std::string& name, const Eigen::Vector3d& size_m,
                                const Eigen::Vector3f& at = {5.0F, -3.0F, 1.0F}) {
  TriangleMesh mesh = tessellate(BoxShape{size_m}).value();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += at;
  EXPECT_TRUE(write_mesh(folder / name, mesh));
  return folder / name;
}

Box placed(const Scene& scene) { return bounds_of(std::get<MeshShape>(scene.objects.back().shape).mesh); }

TriangleMesh cube_at(float x, double edge_m = 0.1) {
  TriangleMesh mesh = tessellate(BoxShape{{edge_m, edge_m, edge_m}}).value();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += Eigen::Vector3f{x, 0.0F, static_cast<float>(-0.5 * edge_m)};
  mesh.normals.clear();
  return mesh;
}

TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
  return mesh;
}

TriangleMesh without_shared_vertices(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t i : triangle) soup.vertices.push_back(mesh.vertices[i]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TEST(MeshScene, StandsInTheMiddleOfTheTable) {
  const TempFolder folder;
  const auto scene = mesh_scene(write_box(folder, "box.ply", {0.3, 0.2, 0.1}));
  ASSERT_TRUE(scene) << scene.error().to_string();
  EXPECT_EQ(scene->name, "box.ply");
  EXPECT_TRUE(scene->validate());
  EXPECT_TRUE(RayScene::build(*scene));
  const Box box = placed(*scene);
  EXPECT_LT((box.min - Eigen::Vector3d{-0.15, -0.1, 0.0}).norm(), 1e-6);
  EXPECT_LT((box.max - Eigen::Vector3d{0.15, 0.1, 0.1}).norm(), 1e-6);
  EXPECT_FALSE(scene->objects.back().support);
  EXPECT_FALSE(scene->scan.empty());
}

TEST(MeshScene, IsScaledAndTurned) {
  const TempFolder folder;
  const auto path = write_box(folder, "box.ply", {300, 200, 100});
  const auto upright = mesh_scene(path, {0.001, UpAxis::y});
  ASSERT_TRUE(upright) << upright.error().to_string();
  // y becomes z; z becomes −y.
  EXPECT_LT((placed(*upright).max - Eigen::Vector3d{0.15, 0.05, 0.2}).norm(), 1e-6);
}

TEST(MeshScene, IsTurnedWhereItIsInsideOut) {
  const TempFolder folder;
  TriangleMesh box = tessellate(BoxShape{{0.3, 0.2, 0.1}}).value();
  const auto read = [&](const TriangleMesh& mesh) {
    EXPECT_TRUE(write_mesh(folder / "box.ply", mesh));
    return std::get<MeshShape>(mesh_scene(folder / "box.ply")->objects.back().shape).mesh.triangles;
  };
  const auto upright = read(box);
  box = turned(std::move(box));
  EXPECT_EQ(read(box), upright);
  box.triangles.resize(box.triangles.size() / 2);  // open: either side may be meant
  EXPECT_EQ(read(box), box.triangles);
}

TEST(MeshScene, EachClosedPartIsTurnedByItself) {
  const TempFolder folder;
  const auto read = [&](const TriangleMesh& mesh) {
    EXPECT_TRUE(write_mesh(folder / "mesh.ply", mesh));
    return read_upright_mesh(folder / "mesh.ply", UpAxis::z)->triangles;
  };
  const TriangleMesh right = both(cube_at(0.0F), cube_at(0.3F));
  const TriangleMesh wrong = both(cube_at(0.0F), turned(cube_at(0.3F)));
  EXPECT_EQ(read(right), right.triangles);
  EXPECT_EQ(read(wrong), right.triangles);
  EXPECT_EQ(read(without_shared_vertices(wrong)).size(), right.triangles.size());
  TriangleMesh soup = without_shared_vertices(wrong);
  turn_outside_out(soup);
  const TriangleMesh right_soup = without_shared_vertices(right);
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const auto normal = [&](const TriangleMesh& mesh) -> Eigen::Vector3f {
      const auto& [a, b, c] = mesh.triangles[i];
      return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    };
    EXPECT_GT(normal(soup).dot(normal(right_soup)), 0.0F) << i;
  }
  // Cubes that touch: their vertices tell them apart.
  EXPECT_EQ(read(both(cube_at(0.0F), turned(cube_at(0.1F)))), both(cube_at(0.0F), cube_at(0.1F)).triangles);
  // What is open stays as it is beside what is turned.
  TriangleMesh open = turned(cube_at(0.3F));
  open.triangles.pop_back();
  EXPECT_EQ(read(both(turned(cube_at(0.0F)), open)), both(cube_at(0.0F), open).triangles);
}

TEST(MeshScene, TheWallOfACavityIsTurnedWithItsBody) {
  const TriangleMesh hollow = both(cube_at(0.0F), turned(cube_at(0.0F, 0.06)));
  TriangleMesh read = hollow;
  turn_outside_out(read);
  EXPECT_EQ(read.triangles, hollow.triangles);
  read = turned(hollow);
  turn_outside_out(read);
  EXPECT_EQ(read.triangles, hollow.triangles);
}

TEST(MeshScene, ATubeIsOpen) {
  TriangleMesh tube = cube_at(0.0F);
  std::erase_if(tube.triangles, [&](const auto& triangle) {
    const auto height = [&](std::size_t i) { return tube.vertices[triangle[i]].z(); };
    return height(0) == height(1) && height(1) == height(2);
  });
  ASSERT_EQ(tube.triangles.size(), 8U);
  const TriangleMesh inside_out = turned(tube);
  TriangleMesh read = inside_out;
  turn_outside_out(read);
  EXPECT_EQ(read.triangles, inside_out.triangles);
}

TEST(MeshScene, ClosedPartsAreBodies) {
  TriangleMesh open = cube_at(0.6F);
  open.triangles.pop_back();
  const TriangleMesh mesh = both(both(both(cube_at(0.0F), open), cube_at(0.3F)), open);
  for (const TriangleMesh& file : {mesh, without_shared_vertices(mesh)}) {
    const std::vector<TriangleMesh> bodies = bodies_of(file);
    ASSERT_EQ(bodies.size(), 3U);
    EXPECT_EQ(bodies[0].triangles.size(), 12U);
    EXPECT_EQ(bodies[1].triangles.size(), 12U);
    EXPECT_EQ(bodies[2].triangles.size(), 22U);
    EXPECT_NEAR(bounds_of(bodies[0]).max.x(), 0.05, 1e-6);
    EXPECT_NEAR(bounds_of(bodies[1]).min.x(), 0.25, 1e-6);
    EXPECT_NEAR(bounds_of(bodies[2]).min.x(), 0.55, 1e-6);
  }
  TriangleMesh many;
  for (std::size_t i = 0; i < kMostMeshBodies; ++i) many = both(std::move(many), cube_at(0.2F * static_cast<float>(i)));
  EXPECT_EQ(bodies_of(many).size(), kMostMeshBodies);
  EXPECT_EQ(bodies_of(both(many, cube_at(-0.2F))).size(), 1U);
}

TEST(MeshScene, RefusesAMeshWhoseCoordinatesAreRounded) {
  const TempFolder folder;
  const auto path = write_box(folder, "far.ply", {0.1, 0.08, 0.12}, {5e5F, 5.4e6F, 100.0F});
  const auto mesh = read_upright_mesh(path, UpAxis::z);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, Errc::invalid_argument);
  EXPECT_NE(mesh.error().message.find("so far from the origin (5.4e+06) that its coordinates are rounded to 0.5 units"),
            std::string::npos)
      << mesh.error().message;
  EXPECT_FALSE(read_upright_mesh(write_box(folder, "point.ply", {0.1, 0.1, 0.1}, {4e6F, 4e6F, 4e6F}), UpAxis::z));
  // Millimetres at half a kilometre: rounded to a thirty-second.
  EXPECT_TRUE(read_upright_mesh(write_box(folder, "near.ply", {100, 80, 120}, {5e5F, 0.0F, 100.0F}), UpAxis::z));
}

TEST(MeshScene, RefusesWhatHasNoPlaceAndSaysWhatWouldDo) {
  const TempFolder folder;
  const auto hint = [&](const Eigen::Vector3d& size_units, double scale = 1.0) {
    const Eigen::Vector3f at = (10.0 * size_units).cast<float>();
    const auto scene = mesh_scene(write_box(folder, "box.ply", size_units, at), {scale, UpAxis::z});
    EXPECT_FALSE(scene);
    if (scene) return std::string{};
    EXPECT_EQ(scene.error().code, Errc::invalid_argument);
    EXPECT_EQ(scene.error().context, (folder / "box.ply").string());
    return scene.error().message;
  };
  EXPECT_NE(hint({120, 80, 100}).find("0.001 (millimetres)"), std::string::npos);
  EXPECT_NE(hint({12, 8, 10}).find("0.01 (centimetres)"), std::string::npos);
  EXPECT_NE(hint({0.2, 0.2, 0.2}, 0.001).find("1 (metres)"), std::string::npos);
  EXPECT_NE(hint({0.2, 0.2, 0.5}).find("scale it"), std::string::npos);
  EXPECT_NE(hint({1e-6, 1e-6, 1e-6}).find("scale it"), std::string::npos);
  EXPECT_EQ(mesh_scene(folder / "none.ply").error().code, Errc::not_found);
  EXPECT_EQ(mesh_scene(folder / "none.ply", {-1.0, UpAxis::z}).error().code, Errc::invalid_argument);
  folder.write("bad.obj", "v 0 0 0\n");
  EXPECT_EQ(mesh_scene(folder / "bad.obj").error().code, Errc::corrupt_data);
  folder.write("bad.glb", "glTF?");
  EXPECT_EQ(mesh_scene(folder / "bad.glb").error().code, Errc::corrupt_data);
}

TEST(MeshScene, FilesOfAFolderByTheirNames) {
  const TempFolder folder;
  for (const char* name : {"b.ply", "a.STL", "c.txt", "d.obj.bak", "sub.ply/e.ply"}) folder.write(name, "");
  const auto files = mesh_files(folder.path());
  ASSERT_TRUE(files);
  ASSERT_EQ(files->size(), 2U);
  EXPECT_EQ((*files)[0], folder / "a.STL");
  EXPECT_EQ((*files)[1], folder / "b.ply");
  EXPECT_EQ(mesh_files(folder / "none").error().code, Errc::io_failure);
  std::filesystem::create_directory(folder / "empty");
  EXPECT_EQ(mesh_files(folder / "empty").error().code, Errc::invalid_argument);
}

TEST(MeshScene, HouseholdObjectsStandOnTheTable) {
  const std::filesystem::path folder = test::shared_data() / "meshes_ycb";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto files = mesh_files(folder);
  ASSERT_TRUE(files);
  EXPECT_GE(files->size(), 10U);
  for (const std::filesystem::path& file : *files) {
    const auto scene = mesh_scene(file);
    ASSERT_TRUE(scene) << scene.error().to_string();
    EXPECT_NEAR(placed(*scene).min.z(), 0.0, 1e-6) << file;
    EXPECT_GT(placed(*scene).max.z(), 0.02) << file;
    EXPECT_TRUE(scene->validate()) << file;
  }
}

}  // namespace
}  // namespace saccade
