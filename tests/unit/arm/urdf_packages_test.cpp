// SPDX-License-Identifier: Apache-2.0
// Where parse_urdf looks for package://NAME/….
#include <gtest/gtest.h>

#include <filesystem>

#include "saccade/arm/urdf.hpp"
#include "support/environment_variable.hpp"
#include "support/shared_arms.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::EnvironmentVariable;

constexpr const char* kTriangle{"o t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"};

/// Folders with a URDF of its own, away from the packages.
class UrdfPackagesTest : public testing::Test {
 protected:
  UrdfPackagesTest() { fs::create_directories(folder_ / "mine"); }

  /// Reads an arm whose only mesh is the one named.
  [[nodiscard]] Result<UrdfArm> read(const std::string& mesh) const {
    return parse_urdf(R"(<robot name="a"><link name="b"/><link name="c"><collision><geometry><mesh filename=")" + mesh +
                          R"("/></geometry></collision></link><joint name="j" type="continuous"><parent link="b"/>
                      <child link="c"/><axis xyz="0 0 1"/></joint></robot>)",
                      folder_ / "mine", config_);
  }
  /// Returns the height of the mesh that was found: packages are told apart by it.
  [[nodiscard]] float height(const std::string& mesh) const {
    const auto arm = read(mesh);
    EXPECT_TRUE(arm) << arm.error().to_string();
    if (!arm) return -1.0F;
    return std::get<MeshBody>(arm->arm.links()[1].bodies.at(0).shape).mesh.vertices[0].z();
  }
  void write_mesh(const std::string& name, int height) const {
    folder_.write(name, test::replaced(kTriangle, " 0\n", " " + std::to_string(height) + "\n"));
  }
  [[nodiscard]] std::string error(const std::string& mesh) const {
    const auto arm = read(mesh);
    EXPECT_FALSE(arm);
    return arm ? "" : arm.error().to_string();
  }

  test::TempFolder folder_;
  UrdfConfig config_;
  EnvironmentVariable no_ros_{"ROS_PACKAGE_PATH", ""};
  EnvironmentVariable no_ament_{"AMENT_PREFIX_PATH", ""};
};

TEST_F(UrdfPackagesTest, FindsThemOnPathsInOrder) {
  write_mesh("first/src/group/arm/meshes/t.obj", 1);  // by its folder's name, three folders down
  write_mesh("second/cloned/meshes/t.obj", 2);
  folder_.write("second/cloned/package.xml",
                "<?xml version=\"1.0\"?>\n<package format=\"3\">\n<name> arm\n</name></package>");
  write_mesh("third/arm/meshes/t.obj", 3);
  write_mesh("fourth/share/arm/meshes/t.obj", 4);
  const std::string mesh{"package://arm/meshes/t.obj"};
  EXPECT_NE(error(mesh).find("--package-path and ROS_PACKAGE_PATH name no folder"), std::string::npos) << error(mesh);

  const EnvironmentVariable ament{"AMENT_PREFIX_PATH",
                                  (folder_ / "nowhere").string() + ":" + (folder_ / "fourth").string()};
  EXPECT_EQ(height(mesh), 4.0F);
  const EnvironmentVariable ros{"ROS_PACKAGE_PATH", ":" + (folder_ / "third").string() + ":"};
  EXPECT_EQ(height(mesh), 3.0F);
  config_.package_paths = {folder_ / "empty", folder_ / "second", folder_ / "first"};
  EXPECT_EQ(height(mesh), 2.0F);
  config_.package_paths = {folder_ / "first", folder_ / "second"};
  EXPECT_EQ(height(mesh), 1.0F);
  config_.package_paths = {folder_ / "second" / "cloned"};  // the package itself
  EXPECT_EQ(height(mesh), 2.0F);
  write_mesh("mine/arm/meshes/t.obj", 5);
  EXPECT_EQ(height(mesh), 5.0F) << "the URDF's own folder goes before";
  config_.packages["arm"] = folder_ / "third" / "arm";
  EXPECT_EQ(height(mesh), 3.0F);
}

TEST_F(UrdfPackagesTest, APackageWithoutTheFileHidesNoOther) {
  write_mesh("first/arm/meshes/other.obj", 1);
  write_mesh("second/arm/meshes/t.obj", 2);
  config_.package_paths = {folder_ / "first", folder_ / "second"};
  EXPECT_EQ(height("package://arm/meshes/t.obj"), 2.0F);
  const std::string text = error("package://arm/meshes/u.obj");
  EXPECT_NE(text.find("its package has no such file: " + (folder_ / "first" / "arm").string() + ", " +
                      (folder_ / "second" / "arm").string()),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("give --package arm=FOLDER"), std::string::npos) << text;
}

TEST_F(UrdfPackagesTest, SaysWhereItLookedAndWhatToDo) {
  fs::create_directories(folder_ / "src" / "other");
  fs::create_directory_symlink(folder_ / "src", folder_ / "src" / "other" / "loop");
  config_.package_paths = {folder_ / "src"};
  const EnvironmentVariable ros{"ROS_PACKAGE_PATH", "/opt/ros/none/share"};
  const std::string text = error("package://arm/meshes/t.obj");
  EXPECT_NE(text.find("link c, mesh package://arm/meshes/t.obj: there is no package arm in " +
                      (folder_ / "mine").string() + " and above it, nor below " + (folder_ / "src").string() +
                      ", /opt/ros/none/share; give --package arm=FOLDER, or --package-path"),
            std::string::npos)
      << text;
  EXPECT_NE(error("t.stl").find("there is no such file: " + (folder_ / "mine" / "t.stl").string()), std::string::npos)
      << error("t.stl");
}

}  // namespace
}  // namespace saccade
