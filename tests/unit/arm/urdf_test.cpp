// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/urdf.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "support/shared_arms.hpp"
#include "support/temp_folder.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::replaced;

/// Base, a joint that turns, one that slides, a flange, a camera beside it.
const std::string kUrdf{R"(<robot name="small">
  <link name="base"><collision><origin xyz="0 0 0.1"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.3"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" effort="1" velocity="3" acceleration="4"/></joint>
  <link name="arm"><collision><geometry><cylinder radius="0.05" length="0.4"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="slider"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="1" velocity="0.5"/></joint>
  <link name="slider"/>
  <joint name="plate" type="fixed"><parent link="slider"/><child link="flange"/><origin xyz="0.1 0 0"/></joint>
  <link name="flange"><collision><geometry><sphere radius="0.03"/></geometry></collision></link>
</robot>)"};

/// Returns the URDF with more elements.
std::string with(const std::string& more) { return replaced(kUrdf, "</robot>", more + "</robot>"); }

const std::string kCamera{
    R"(<joint name="mount" type="fixed"><parent link="flange"/><child link="camera_optical_frame"/>
  <origin xyz="0 0 0.05" rpy="0 1.5707963267948966 0"/></joint><link name="camera_optical_frame"/>)"};

void expect_bad_urdf(const std::string& urdf, const std::string& part, Errc code = Errc::corrupt_data,
                     const UrdfConfig& config = {}) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto arm = parse_urdf(urdf, {}, config);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  ASSERT_FALSE(arm) << part;
  EXPECT_EQ(arm.error().code, code) << arm.error().to_string();
  EXPECT_NE(arm.error().to_string().find(part), std::string::npos) << arm.error().to_string();
  EXPECT_EQ(arm.error().to_string().find('\n'), std::string::npos) << arm.error().to_string();
}

TEST(Urdf, ReadsAnArm) {
  const auto read = parse_urdf(with(kCamera));
  ASSERT_TRUE(read) << read.error().to_string();
  const ArmModel& arm = read->arm;
  ASSERT_EQ(arm.dof(), 2);
  EXPECT_EQ(arm.name(), "small");
  EXPECT_EQ(arm.joint(0).kind, JointKind::revolute);
  EXPECT_EQ(arm.joint(0).axis_joint, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(arm.joint(0).limits.acceleration, 4.0);
  EXPECT_EQ(arm.joint(1).kind, JointKind::prismatic);
  EXPECT_EQ(arm.joint(1).limits.acceleration, 1.0);  // half a second
  EXPECT_EQ(arm.description().flange_name, "slider");
  EXPECT_EQ(arm.description().camera_name, "camera_optical_frame");
  ASSERT_EQ(arm.links().size(), 3U);
  EXPECT_EQ(arm.links()[0].bodies.size(), 1U);
  ASSERT_EQ(arm.links()[2].bodies.size(), 1U);
  EXPECT_EQ(arm.links()[2].bodies[0].name, "flange");
  EXPECT_EQ(arm.links()[2].bodies[0].T_link_body.translation(), Eigen::Vector3d(0.1, 0, 0));
  Configuration q{2};
  q << 0.5 * std::numbers::pi, 0.2;
  const Pose T = camera_pose(arm, q);
  EXPECT_LT((T.translation() - Eigen::Vector3d(0, 0.3, 0.35)).norm(), 1e-15);
  EXPECT_LT((T.linear().col(2) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_NE(read->notes[0].find("1 of 2 joints have no acceleration limit"), std::string::npos) << read->notes[0];
}

TEST(Urdf, TakesTheLongestChainWhereNothingIsSaid) {
  const auto read = parse_urdf(kUrdf);
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->arm.description().flange_name, "flange");
  EXPECT_NE(read->notes[0].find("no camera is mounted"), std::string::npos);
  UrdfConfig config;
  config.base = "arm";
  const auto part = parse_urdf(kUrdf, {}, config);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->arm.dof(), 1);
  EXPECT_EQ(part->arm.links()[0].name, "arm");
}

TEST(Urdf, FoldsBranchesIntoTheLinkThatTheyHangOn) {
  const std::string gripper = R"(
    <joint name="left" type="prismatic"><parent link="flange"/><child link="finger"/><axis xyz="0 1 0"/>
      <limit lower="0.01" upper="0.04" effort="1" velocity="1"/></joint>
    <link name="finger"><collision><geometry><box size="0.01 0.01 0.05"/></geometry></collision></link>)";
  UrdfConfig config;
  config.tip = "flange";
  const auto read = parse_urdf(with(gripper), {}, config);
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->arm.links()[2].bodies.size(), 2U);
  EXPECT_EQ(read->arm.links()[2].bodies[1].name, "finger");
  EXPECT_EQ(read->arm.links()[2].bodies[1].T_link_body.translation(), Eigen::Vector3d(0.1, 0.01, 0));
  EXPECT_NE(read->notes[1].find("joint left is not on the chain: it stands still at 0.01"), std::string::npos);
  config.keep_beyond_tip = false;
  EXPECT_EQ(parse_urdf(with(gripper), {}, config)->arm.links()[2].bodies.size(), 1U);
}

TEST(Urdf, GivesEndlessJointsASpeed) {
  const auto read =
      parse_urdf(replaced(replaced(kUrdf, "revolute", "continuous"),
                          R"(<limit lower="-1" upper="2" effort="1" velocity="3" acceleration="4"/>)", ""));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->arm.joint(0).kind, JointKind::continuous);
  EXPECT_EQ(read->arm.joint(0).limits.speed, 1.0);
  EXPECT_TRUE(std::isinf(read->arm.joint(0).limits.upper));
}

TEST(Urdf, SaysWhatIsWrongAndWhere) {
  expect_bad_urdf("", "no XML");
  expect_bad_urdf("<robot name='a'><link name='b'>", "no XML");
  expect_bad_urdf("<scene/>", "begins with <scene>");
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  expect_bad_urdf(deep, "nested too deeply");
  std::string chain{"<robot name='a'><link name='0'/>"};
  for (int i = 0; i < 2000; ++i) {
    const std::string next = std::to_string(i + 1);
    chain += "<link name='" + next + "'/><joint name='" + next + "' type='fixed'><parent link='" + std::to_string(i) +
             "'/><child link='" + next + "'/></joint>";
  }
  expect_bad_urdf(chain + "</robot>", "too many links before it");
  expect_bad_urdf("<robot name='a'/>", "no URDF that can be read");
  expect_bad_urdf("<robot name='a'><link name='b'/></robot>", "no joint moves behind b");
  expect_bad_urdf("<robot name='a'><link name='b\nc'/></robot>", "no joint moves behind b c");
  expect_bad_urdf(with("<link name='lost'/>"), "root link");
  expect_bad_urdf(with(R"(<joint name="back" type="fixed"><parent link="flange"/><child link="arm"/></joint>)"),
                  "link arm: has two joints above it, back and turn; the joints must form a tree");
  expect_bad_urdf(with(R"(<joint name="back" type="fixed"><parent link="flange"/><child link="base"/></joint>)"),
                  "loop of joints");
  expect_bad_urdf(with(R"(<joint name="on" type="fixed"><parent link="flange"/><child link="nowhere"/></joint>)"),
                  "nowhere");
  expect_bad_urdf(replaced(kUrdf, "0 0 2", "0 0 0"), "joint turn: its axis has no length");
  // A number that urdfdom cannot parse must not reach its messages as a format: this one wrote to memory.
  expect_bad_urdf(replaced(kUrdf, "0 0 2", "0 %n%s%n &#37;n"), "its xyz holds a %");
  expect_bad_urdf(replaced(kUrdf, "0 0 2", "0 &#37;n 1"), "its xyz holds a %");
  expect_bad_urdf(replaced(kUrdf, "upper=\"2\"", "upper=\"nan\""), "upper");
  expect_bad_urdf(replaced(kUrdf, "upper=\"2\"", "upper=\"-2\""), "joint turn: its lower limit must lie below");
  expect_bad_urdf(replaced(kUrdf, "velocity=\"3\"", ""), "velocity");
  expect_bad_urdf(replaced(kUrdf, "velocity=\"3\"", "velocity=\"0\""), "joint turn: its speed limit must be positive");
  expect_bad_urdf(replaced(kUrdf, "acceleration=\"4\"", "acceleration=\"-4\""), "joint turn: its acceleration limit");
  expect_bad_urdf(replaced(kUrdf, "acceleration=\"4\"", "acceleration=\"fast\""),
                  "joint turn: acceleration is not a number");
  expect_bad_urdf(replaced(kUrdf, "radius=\"0.03\"", "radius=\"0\""), "link flange: the radius of a collision sphere");
  expect_bad_urdf(replaced(kUrdf, "type=\"revolute\"", "type=\"floating\""), "joint turn: only revolute, continuous",
                  Errc::unsupported);
  expect_bad_urdf(replaced(kUrdf, "velocity=\"0.5\"/>", "velocity=\"0.5\"/><mimic joint=\"turn\"/>"),
                  "joint slide: follows joint turn, as in a parallel linkage", Errc::unsupported);
  expect_bad_urdf(replaced(kUrdf, "revolute\">", "revolute\"><parent"), "no XML");
}

TEST(Urdf, RefusesFramesThatAreNotThere) {
  UrdfConfig config;
  config.base = "pelvis";
  expect_bad_urdf(kUrdf, "pelvis: there is no such link to be the base", Errc::invalid_argument, config);
  config = {};
  config.tip = "hand";
  expect_bad_urdf(kUrdf, "hand: there is no such link to be the tip", Errc::invalid_argument, config);
  config = {};
  config.camera = "eye";
  expect_bad_urdf(kUrdf, "eye: there is no such link to be the camera's frame", Errc::invalid_argument, config);
  config.camera = "arm";
  config.tip = "flange";
  expect_bad_urdf(kUrdf, "link arm: the camera's frame is not fixed to the tip flange", Errc::invalid_argument, config);
  config = {};
  config.base = "flange";
  config.tip = "arm";
  expect_bad_urdf(kUrdf, "link arm: does not come behind the base flange", Errc::invalid_argument, config);
  const std::string fork = R"(<joint name="other" type="continuous"><parent link="arm"/><child link="left"/></joint>
                              <link name="left"/>)";
  expect_bad_urdf(with(fork),
                  "several chains are equally long; name a tip: --tip flange (2 joints), --tip left (2 joints)",
                  Errc::invalid_argument);
}

TEST(Urdf, FindsMeshes) {
  const test::TempFolder folder;
  const std::string triangle = "o t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  fs::create_directories(folder / "arm" / "urdf");
  fs::create_directories(folder / "arm" / "meshes");
  folder.write("arm/meshes/t.obj", triangle);
  folder.write("arm/package.xml", "<package><name>arm_description</name></package>");
  const auto mesh = [](const std::string& name) {
    return replaced(kUrdf, "<sphere radius=\"0.03\"/>", "<mesh filename=\"" + name + "\" scale=\"2 3 -1\"/>");
  };
  for (const char* name : {"package://arm_description/meshes/t.obj", "package://arm/meshes/t.obj", "../meshes/t.obj"}) {
    const auto read = parse_urdf(mesh(name), folder / "arm" / "urdf");
    ASSERT_TRUE(read) << read.error().to_string();
    const CollisionBody& body = read->arm.links()[2].bodies[0];
    ASSERT_EQ(kind_of(body), "mesh");
    const TriangleMesh& triangles = std::get<MeshBody>(body.shape).mesh;
    ASSERT_EQ(triangles.vertices.size(), 3U);
    EXPECT_FLOAT_EQ(triangles.vertices[1].x() + triangles.vertices[2].x(), 2.0F);
    EXPECT_FLOAT_EQ(triangles.vertices[1].y() + triangles.vertices[2].y(), 3.0F);
  }
  UrdfConfig config;
  config.packages["elsewhere"] = folder / "arm";
  EXPECT_TRUE(parse_urdf(mesh("package://elsewhere/meshes/t.obj"), {}, config));
  expect_bad_urdf(mesh("package://nowhere/meshes/t.obj"),
                  "link flange, mesh package://nowhere/meshes/t.obj: there is no package", Errc::not_found);
  expect_bad_urdf(mesh("package://elsewhere/meshes/u.obj"), "is not in", Errc::not_found, config);
  expect_bad_urdf(mesh("t.obj"), "there is no such file", Errc::not_found);
  expect_bad_urdf(mesh("http://example.com/t.obj"), "only package:// and file:// are read", Errc::unsupported);
  folder.write("arm/meshes/t.obj", "nothing");
  expect_bad_urdf(mesh("package://elsewhere/meshes/t.obj"), "t.obj: the file has no triangles", Errc::corrupt_data,
                  config);
}

TEST(BuiltinRobots, TheComauIsThatOfItsRows) {
  const auto read = find_robot("comau_smart_six");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_TRUE(read->notes.empty()) << read->notes.front();
  const ArmModel& arm = read->arm;
  ASSERT_EQ(arm.dof(), 6);
  const Pose T_world_base = arm.joint(0).T_parent_joint * Eigen::Translation3d{0, 0, -0.45};
  std::mt19937_64 random{9};
  for (int i = 0; i < 100; ++i) {
    const Configuration q = test::random_configuration(arm, random);
    const Pose T_world_flange = camera_pose(arm, q) * arm.description().T_flange_camera.inverse();
    const Pose T_base_flange = test::dh_product(test::comau_rows(), q);
    ASSERT_LT(test::miss(T_world_flange, T_world_base * T_base_flange), 1e-14);
  }
  EXPECT_EQ(InverseKinematics::create(arm)->method(), IkMethod::closed_form);
  EXPECT_NE(find_robot("hal").error().message.find("no such robot"), std::string::npos);
  for (const char* file : {"hal.urdf", "hal.XACRO", "arms/hal", "./hal"})
    EXPECT_EQ(find_robot(file).error().message, "there is no such file") << file;
}

TEST(BuiltinRobots, TheComauReachesTheFirstLookOfEveryScene) {
  const InverseKinematics ik = InverseKinematics::create(find_robot("comau_smart_six")->arm).value();
  int looks{0};
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = parse_scene(builtin.yaml).value();
    for (const Pose& T_world_camera : scene.scan) {
      EXPECT_FALSE(ik.solve(T_world_camera).empty()) << builtin.name;
      ++looks;
    }
  }
  EXPECT_GE(looks, 8);
}

TEST(BuiltinRobots, TheComauMovesAsTheRecordedOne) {
  if (!fs::exists(test::shared_robots())) GTEST_SKIP() << "no robots among the recorded data";
  const auto ours = find_robot("comau_smart_six");
  const auto theirs = test::shared_comau(true);
  ASSERT_TRUE(theirs) << theirs.error().to_string();
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(ours->arm.joint(i).limits.lower, theirs->arm.joint(i).limits.lower);
    EXPECT_EQ(ours->arm.joint(i).limits.upper, theirs->arm.joint(i).limits.upper);
    EXPECT_EQ(ours->arm.joint(i).limits.speed, theirs->arm.joint(i).limits.speed);
  }
  const Pose T_world_base = ours->arm.joint(0).T_parent_joint * Eigen::Translation3d{0, 0, -0.45};
  std::mt19937_64 random{10};
  for (int i = 0; i < 100; ++i) {
    const Configuration q = test::random_configuration(ours->arm, random);
    const Pose T_world_flange = camera_pose(ours->arm, q) * ours->arm.description().T_flange_camera.inverse();
    ASSERT_LT(test::miss(T_world_flange, T_world_base * camera_pose(theirs->arm, q)), 1e-14);
  }
}

TEST(Urdf, ReadsTheRecordedArms) {
  if (!fs::exists(test::shared_robots())) GTEST_SKIP() << "no robots among the recorded data";
  struct Expected {
    Result<UrdfArm> read;
    int dof;
    std::size_t bodies;
  };
  const Expected cases[]{{test::shared_comau(false), 6, 0},    {test::shared_panda(), 7, 8},
                         {test::shared_panda_hand(), 7, 11},   {test::shared_iiwa(), 7, 8},
                         {test::shared_iiwa("spheres"), 7, 0}, {test::shared_iiwa("spheres_dense"), 7, 0}};
  for (const Expected& expected : cases) {
    ASSERT_TRUE(expected.read) << expected.read.error().to_string();
    const ArmModel& arm = expected.read->arm;
    EXPECT_EQ(arm.dof(), expected.dof);
    std::size_t bodies{0};
    for (const ArmLink& link : arm.links()) bodies += link.bodies.size();
    EXPECT_GE(bodies, 7U);
    EXPECT_TRUE(expected.bodies == 0 || expected.bodies == bodies) << arm.name() << " " << bodies;
  }
  EXPECT_EQ(cases[3].read->arm.joint(0).limits.acceleration, 8.57);  // drake:acceleration
}

/// TinyXML by itself reads beyond the end of it, as a sanitizer sees.
TEST(Urdf, ACharacterThatIsCutAtTheEndIsNoXml) {
  for (const char* text : {"<robot><\xF0", "<robot name=\"\xE2", "<robot>\xC3", "\xF0"}) {
    const auto read = parse_urdf(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, Errc::corrupt_data) << text;
  }
}

}  // namespace
}  // namespace saccade
