// SPDX-License-Identifier: Apache-2.0
// Choices of parse_urdf where nothing names the arm's joints, its end and the camera's frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/names.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const std::string kTurn{R"(<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>)"};
const std::string kStroke{R"(<axis xyz="0 1 0"/><limit lower="0" upper="0.04" effort="1" velocity="1"/>)"};

/// A joint and the link behind it, 0.1 m above the one before.
std::string piece(const std::string& joint, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more = "") {
  return "<joint name=\"" + joint + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"0 0 0.1\"/>" + more + "</joint><link name=\"" + child + "\"/>";
}

std::string fixed_to(const std::string& parent, const std::string& child) {
  return piece("to_" + child, "fixed", parent, child);
}

std::string follows(const std::string& joint, const std::string& how = "") {
  return kTurn + "<mimic joint=\"" + joint + "\"" + how + "/>";
}

/// Joints that turn, one behind the other: PREFIX_joint1 … in front of PREFIX_link1 …
std::string joints(const std::string& prefix, const std::string& parent, int count) {
  std::string urdf;
  std::string before = parent;
  for (int i = 1; i <= count; ++i) {
    const std::string link = prefix + "_link" + std::to_string(i);
    urdf += piece(prefix + "_joint" + std::to_string(i), "revolute", before, link, kTurn);
    before = link;
  }
  return urdf;
}

Result<UrdfArm> read(const std::string& pieces, const UrdfConfig& config = {}) {
  return parse_urdf(
      "<robot name=\"r\"><link name=\"base\"><collision><geometry><sphere "
      "radius=\"0.05\"/></geometry></collision></link>" +
          pieces + "</robot>",
      {}, config);
}

/// Reads an arm that has to end at this link, with so much to be said about it.
UrdfArm expect_tip(const std::string& pieces, const std::string& tip, int dof, const std::string& said = "",
                   const UrdfConfig& config = {}) {
  const auto arm = read(pieces, config);
  EXPECT_TRUE(arm) << arm.error().to_string();
  if (!arm) return find_robot("comau").value();
  EXPECT_EQ(arm->arm.description().flange_name, tip);
  EXPECT_EQ(arm->arm.dof(), dof);
  EXPECT_NE(joined(arm->choices, "\n").find(said), std::string::npos) << joined(arm->choices, "\n");
  EXPECT_TRUE(std::equal(arm->choices.begin(), arm->choices.end(), arm->notes.begin()));
  return *arm;
}

void expect_unclear(const std::string& pieces, const std::string& part, const UrdfConfig& config = {},
                    Errc code = Errc::invalid_argument) {
  const auto arm = read(pieces, config);
  ASSERT_FALSE(arm) << part;
  EXPECT_EQ(arm.error().code, code);
  EXPECT_NE(arm.error().to_string().find(part), std::string::npos) << arm.error().to_string();
}

const std::string kTwoFingers = piece("open1", "prismatic", "hand", "f1", kStroke) +
                                piece("open2", "prismatic", "hand", "f2", kStroke + "<mimic joint=\"open1\"/>");

TEST(ArmChain, AGripperIsNoPartOfTheArm) {
  const std::string seven = joints("p", "base", 7);
  const std::string said = "the arm ends at p_link8: a gripper's joints are none of it (open1, open2)";
  expect_tip(seven + fixed_to("p_link7", "p_link8") + fixed_to("p_link8", "hand") + kTwoFingers, "p_link8", 7, said);
  expect_tip(seven + fixed_to("p_link7", "plate") + fixed_to("plate", "hand") + kTwoFingers, "hand", 7, "at hand");
  // Links on the hand besides its fingers change nothing.
  const std::string hand = fixed_to("p_link7", "plate") + fixed_to("plate", "hand") + kTwoFingers;
  expect_tip(seven + hand + fixed_to("hand", "logo") + piece("propeller", "continuous", "hand", "p", kTurn), "hand", 7,
             "(open1, open2, propeller)");
  UrdfConfig config;
  config.tip = "f1";
  const UrdfArm told = expect_tip(seven + hand, "f1", 8, "no camera", config);
  EXPECT_EQ(joined(told.choices).find("gripper"), std::string::npos);
}

TEST(ArmChain, TellsGrippersByTheirLooks) {
  const std::string six = joints("a", "base", 6) + fixed_to("a_link6", "hand");
  // Two that slide and do not follow each other, as in the thesis' Comau; one of them would be a joint of the arm.
  expect_tip(six + piece("b1", "prismatic", "hand", "f1", kStroke), "f1", 7);
  expect_tip(six + piece("b1", "prismatic", "hand", "f1", kStroke) + piece("b2", "prismatic", "hand", "f2", kStroke),
             "hand", 6, "(b1, b2)");
  // A jaw by its name.
  expect_tip(six + piece("grip", "revolute", "hand", "moving_Jaw_1", kTurn), "hand", 6, "(grip)");
  // A linkage behind one motor: rods that follow it beside and behind it.
  expect_tip(six + piece("motor", "revolute", "hand", "left", kTurn) +
                 piece("rod", "revolute", "hand", "right", follows("motor")) +
                 piece("tip1", "revolute", "left", "left_end", follows("motor")) +
                 piece("tip2", "revolute", "right", "right_end", follows("motor")),
             "hand", 6, "(motor, rod)");
  // Fingers of several joints; two alike, or three and more.
  expect_tip(six + joints("x", "hand", 3) + joints("y", "hand", 3), "hand", 6, "(x_joint1, y_joint1)");
  expect_tip(six + joints("x", "hand", 4) + joints("y", "hand", 4) + joints("z", "hand", 3), "hand", 6);
}

TEST(ArmChain, TakesNoArmForAGripper) {
  // Two arms on a torso; a finger that belongs to one of them does not make it shorter than the other.
  const std::string torso = joints("torso", "base", 2);
  expect_unclear(torso + joints("left", "torso_link2", 6) + joints("right", "torso_link2", 6) +
                     piece("grip", "revolute", "left_link6", "left_finger", kTurn),
                 "name a tip: --tip left_link6 (8 joints), --tip right_link6 (8 joints)");
  // A last joint with another beside it.
  expect_unclear(joints("a", "base", 5) + joints("b", "a_link5", 1) + joints("c", "a_link5", 1), "--tip b_link1");
  // Three joints from the base have no arm before them.
  expect_unclear(joints("x", "base", 1) + joints("y", "base", 1) + joints("z", "base", 1), "--tip x_link1 (1 joint), ");
  expect_tip(piece("finger", "revolute", "base", "finger", kTurn), "finger", 1);
  // A rod along the arm follows a joint of the arm.
  const UrdfArm arm = expect_tip(
      joints("a", "base", 6) + piece("rod", "revolute", "a_link1", "cylinder", follows("a_joint2")), "a_link6", 6);
  EXPECT_EQ(joined(arm.choices).find("gripper"), std::string::npos) << joined(arm.choices);
}

TEST(ArmChain, ProposesTheTipsOfSeveralArms) {
  const auto arm = [](const std::string& side) {
    return joints(side, "base", 6) + fixed_to(side + "_link6", side + "_flange") +
           fixed_to(side + "_flange", side + "_tool0") + fixed_to(side + "_link6", side + "_sensor");
  };
  const std::string both = arm("left") + arm("right");
  expect_unclear(
      both, "several chains are equally long; name a tip: --tip left_tool0 (6 joints), --tip right_tool0 (6 joints)");
  UrdfConfig config;
  config.tip = "right_tool0";
  expect_tip(both, "right_tool0", 6, "", config);
  const std::string eye = fixed_to("right_sensor", "right_rgb_optical_frame");
  const UrdfArm seeing =
      expect_tip(both + eye, "right_link6", 6, "of 2 chains of 6 joints the one that carries right_rgb_optical_frame");
  EXPECT_EQ(seeing.arm.description().camera_name, "right_rgb_optical_frame");
  expect_unclear(both + eye + fixed_to("left_sensor", "left_rgb_optical_frame"), "--tip left_tool0");
  std::string many;
  for (int i = 10; i < 30; ++i) many += joints("a" + std::to_string(i), "base", 2);
  expect_unclear(many, "--tip a17_link2 (2 joints), …");
}

TEST(ArmChain, ProposesTheLikeliestOfSeveralTips) {
  const std::string two = joints("a", "base", 6) + joints("b", "base", 6);
  expect_unclear(
      two + fixed_to("b_link6", "tool0") + fixed_to("a_link6", "a_flange"),
      "name a tip: --tip a_flange (6 joints), --tip tool0 (6 joints); --tip tool0 is the likeliest, by its name");
  expect_unclear(two + fixed_to("a_link6", "a_ee"), "--tip a_ee is the likeliest, by its name");
  expect_unclear(two + fixed_to("a_link6", "camera_link"), "--tip camera_link is the likeliest, by its name");
  const auto neither = read(two + fixed_to("a_link6", "a_tool0") + fixed_to("b_link6", "b_tool0"));
  ASSERT_FALSE(neither);
  EXPECT_EQ(neither.error().to_string().find("likeliest"), std::string::npos) << neither.error().to_string();
  expect_tip(joints("a", "base", 6) + joints("cable", "base", 7) + fixed_to("a_link6", "tool0"), "cable_link7", 7,
             "the longest chain is taken, to cable_link7; a flange by its name is elsewhere: --tip tool0 (6 joints)");
}

TEST(ArmChain, KnowsFlangesByTheirNames) {
  const std::string six = joints("a", "base", 6);
  expect_tip(six + fixed_to("a_link6", "a_ee_link") + fixed_to("a_link6", "a_tool0"), "a_tool0", 6);
  expect_tip(six + fixed_to("a_link6", "ee_link") + fixed_to("a_link6", "bracket"), "ee_link", 6);
  expect_tip(six + fixed_to("a_link6", "flange") + fixed_to("flange", "bracket"), "flange", 6);
  expect_tip(joints("a", "base", 5) + piece("last", "revolute", "a_link5", "flange", kTurn) + fixed_to("flange", "eye"),
             "flange", 6);
  expect_tip(joints("a", "base", 8) + fixed_to("a_link8", "plate"), "plate", 8);
  expect_tip(six + fixed_to("a_link6", "mytool0") + fixed_to("a_link6", "bracket"), "a_link6", 6);
  expect_tip(six + fixed_to("a_link3", "tool0"), "a_link6", 6);  // it is fixed to another link
  expect_tip(six + fixed_to("a_link6", "b_tcp") + fixed_to("a_link6", "c_tcp"), "a_link6", 6);
  expect_tip(six + fixed_to("a_link6", "b_tcp") + fixed_to("b_tcp", "c_tcp"), "b_tcp", 6);
}

TEST(ArmChain, FindsOpticalFramesAtTheFlange) {
  const std::string six = joints("a", "base", 6) + fixed_to("a_link6", "tool0") + fixed_to("tool0", "mount");
  const auto camera = [](const UrdfArm& arm) { return arm.arm.description().camera_name; };
  const std::string rgb = fixed_to("mount", "kinect_rgb_optical_frame");
  EXPECT_EQ(
      camera(expect_tip(six + rgb, "a_link6", 6, "kinect_rgb_optical_frame is taken for the camera's optical frame")),
      "kinect_rgb_optical_frame");
  const std::string depth = fixed_to("mount", "kinect_depth_optical_frame");
  const UrdfArm two = expect_tip(
      six + rgb + depth, "a_link6", 6,
      "kinect_depth_optical_frame is taken for the camera's optical frame; others there: --camera-frame kinect_rgb_o");
  EXPECT_EQ(camera(two), "kinect_depth_optical_frame");
  EXPECT_NEAR(two.arm.description().T_flange_camera.translation().z(), 0.3, 1e-12);
  // A tip that was named stays the tip.
  UrdfConfig config;
  config.tip = "tool0";
  const UrdfArm told = expect_tip(six + rgb, "tool0", 6, "", config);
  EXPECT_NEAR(told.arm.description().T_flange_camera.translation().z(), 0.2, 1e-12);
  const UrdfArm named = expect_tip(six + rgb + fixed_to("mount", "camera_optical_frame"), "a_link6", 6);
  EXPECT_EQ(camera(named), "camera_optical_frame");
  EXPECT_TRUE(named.choices.empty()) << named.choices.front();
  // Two eyes, neither of which says depth.
  const std::string eyes = fixed_to("mount", "left_optical_frame") + fixed_to("mount", "right_optical_frame");
  expect_unclear(six + eyes,
                 "several optical frames are fixed to a_link6; name the camera's: --camera-frame left_optical_frame, "
                 "--camera-frame right_optical_frame");
  config = {};
  config.T_flange_camera = Pose{Eigen::Translation3d{0, 0, 0.7}};
  const UrdfArm measured = expect_tip(six + eyes, "a_link6", 6, "", config);
  EXPECT_EQ(measured.arm.description().T_flange_camera.translation().z(), 0.7);
  EXPECT_TRUE(measured.choices.empty());
}

TEST(ArmChain, SaysWhichOpticalFramesAreElsewhere) {
  const UrdfArm arm = expect_tip(
      joints("a", "base", 6) + joints("head", "base", 2) + fixed_to("head_link2", "head_optical_frame"), "a_link6", 6,
      "no camera is mounted: its frame is taken to be that of a_link6, z forward; not fixed to it: "
      "--camera-frame head_optical_frame");
  EXPECT_EQ(arm.arm.description().camera_name, "a_link6");
}

TEST(ArmChain, ProposesNamesLikeTheOneThatIsNotThere) {
  const std::string arm = joints("a", "base", 2) + fixed_to("a_link2", "kinect_depth_optical_frame") +
                          fixed_to("a_link2", "kinect_rgb_optical_frame");
  UrdfConfig config;
  config.camera = "kinect_depth_frame";
  expect_unclear(arm,
                 "kinect_depth_frame: there is no such link to be the camera's frame; names like it: "
                 "kinect_depth_optical_frame",
                 config);
  config.camera = "Optical_Frame";
  expect_unclear(arm, "names like it: kinect_rgb_optical_frame, kinect_depth_optical_frame", config);
  config = {};
  config.tip = "alink2";
  expect_unclear(arm, "alink2: there is no such link to be the tip; names like it: a_link2, a_link1", config);
  config.tip = "wrist";
  const auto nothing = read(arm, config);
  EXPECT_EQ(nothing.error().message, "there is no such link to be the tip");
}

/// Returns where a finger that follows a joint stands: the y of its body's centre in the link before.
double stands_at(const std::string& mimic, const std::string& note, const std::string& others = "") {
  const std::string finger = R"(<joint name="slave" type="prismatic"><parent link="a_link3"/><child link="f"/>)" +
                             kStroke + mimic +
                             R"(</joint><link name="f"><collision><geometry><sphere radius="0.01"/></geometry>
                             </collision></link>)";
  UrdfConfig config;
  config.tip = "a_link3";
  const auto arm = read(joints("a", "base", 3) + others + finger, config);
  EXPECT_TRUE(arm) << arm.error().to_string();
  if (!arm) return -1.0;
  EXPECT_NE(joined(arm->notes, "\n").find(note), std::string::npos) << joined(arm->notes, "\n");
  return arm->arm.links().back().bodies.front().T_link_body.translation().y();
}

TEST(ArmChain, WhatFollowsAJointStandsWhereThatPutsIt) {
  const std::string masters =
      piece("motor", "prismatic", "a_link3", "m",
            R"(<axis xyz="1 0 0"/><limit lower="0.02" upper="0.1" effort="1" velocity="1"/>)") +
      piece("gear", "prismatic", "a_link3", "g", kStroke + R"(<mimic joint="motor" multiplier="-1" offset="0.5"/>)");
  const auto mimic = [](const std::string& joint) {
    return "<mimic joint=\"" + joint + "\" multiplier=\"2\" offset=\"0.01\"/>";
  };
  EXPECT_NEAR(stands_at("", "joint slave is not on the chain: it stands still at 0"), 0.0, 1e-12);
  EXPECT_NEAR(stands_at(mimic("motor"), "joint slave follows joint motor: it stands still at 0.05", masters), 0.05,
              1e-12);
  EXPECT_NEAR(stands_at(mimic("gear"), "joint slave follows joint gear: it stands still at 0.97", masters), 0.97,
              1e-12);
  EXPECT_NEAR(stands_at(mimic("a_joint2"), "follows joint a_joint2, but is not moved with it here"), 0.01, 1e-12);
  EXPECT_NEAR(stands_at(mimic("nothing"), "follows joint nothing, which leads nowhere"), 0.0, 1e-12);
  EXPECT_NEAR(stands_at(mimic("slave"), "which leads nowhere"), 0.0, 1e-12);
}

TEST(ArmChain, AJointOfTheArmThatFollowsAnotherIsRefused) {
  const std::string linkage =
      joints("a", "base", 3) + piece("level", "revolute", "a_link3", "b", follows("a_joint2")) + joints("c", "b", 1);
  expect_unclear(linkage, "joint level: follows joint a_joint2, as in a parallel linkage", {}, Errc::unsupported);
  // Its motor beside the arm's chain: it is moved nonetheless.
  const std::string beside = joints("a", "base", 3) + piece("motor", "revolute", "a_link1", "rod", kTurn) +
                             piece("level", "revolute", "a_link3", "b", follows("motor")) + joints("c", "b", 1);
  expect_unclear(beside, "joint level: follows joint motor, as in a parallel linkage", {}, Errc::unsupported);
  // A gripper's is not moved, so that its finger may carry the camera.
  UrdfConfig config;
  config.camera = "f2";
  const std::string hand = joints("a", "base", 6) + fixed_to("a_link6", "hand") + kTwoFingers;
  const UrdfArm finger = expect_tip(hand, "f2", 6, "", config);
  EXPECT_EQ(finger.arm.links().size(), 7U);
  EXPECT_NEAR(finger.arm.description().T_link_flange.translation().z(), 0.2, 1e-12);
}

TEST(ArmChain, ReadsTheRecordedArmsWithoutBeingTold) {
  if (!fs::exists(test::shared_robots())) GTEST_SKIP() << "no robots among the recorded data";
  const auto panda = read_urdf(test::shared_robots() / "franka_panda" / "robots" / "panda_arm_hand.urdf");
  ASSERT_TRUE(panda) << panda.error().to_string();
  EXPECT_EQ(panda->arm.dof(), 7);
  EXPECT_EQ(panda->arm.description().flange_name, "panda_link8");
  EXPECT_EQ(
      panda->choices[1],
      "the arm ends at panda_link8: a gripper's joints are none of it (panda_finger_joint1, panda_finger_joint2)");
  EXPECT_NE(joined(panda->notes).find("panda_finger_joint2 follows joint panda_finger_joint1: it stands still at 0"),
            std::string::npos);

  const auto comau = parse_urdf(test::shared_comau_urdf(), test::shared_comau_folder());
  ASSERT_TRUE(comau) << comau.error().to_string();
  EXPECT_EQ(comau->arm.description().flange_name, "gripper_body");
  EXPECT_EQ(comau->choices[1], "the arm ends at gripper_body: a gripper's joints are none of it (joint_12, joint_13)");
  const auto flange = test::shared_comau(false);
  ASSERT_TRUE(flange) << flange.error().to_string();
  ASSERT_EQ(comau->arm.dof(), 6);
  std::mt19937_64 random{3};
  const Configuration middle = comau->arm.middle();
  const Pose T_flange_tip = camera_pose(flange->arm, middle).inverse() * camera_pose(comau->arm, middle);
  for (int i = 0; i < 10; ++i) {
    const Configuration q = test::random_configuration(comau->arm, random);
    EXPECT_LT(test::miss(camera_pose(flange->arm, q) * T_flange_tip, camera_pose(comau->arm, q)), 1e-12);
  }

  const auto iiwa = test::shared_iiwa();
  ASSERT_TRUE(iiwa) << iiwa.error().to_string();
  EXPECT_EQ(iiwa->arm.description().flange_name, "iiwa_link_7");
}

}  // namespace
}  // namespace saccade
