// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_yaml.hpp"

#include <gtest/gtest.h>

#include "saccade/io/clouds/ply_io.hpp"
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
  for (auto& triangle : box.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_EQ(read(box), upright);
  box.triangles.resize(box.triangles.size() / 2);  // open: either side may be meant
  EXPECT_EQ(read(box), box.triangles);
}

TEST(MeshScene, RefusesWhatHasNoPlaceAndSaysWhatWouldDo) {
  const TempFolder folder;
  const auto hint = [&](const Eigen::Vector3d& size_units, double scale = 1.0) {
    const auto scene = mesh_scene(write_box(folder, "box.ply", size_units), {scale, UpAxis::z});
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
