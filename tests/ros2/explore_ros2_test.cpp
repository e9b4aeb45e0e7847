// SPDX-License-Identifier: Apache-2.0
// saccade explore over ROS 2: the arm is behind a simulated joint_trajectory_controller, the camera behind a topic.
#include <gtest/gtest.h>

#include <cstring>

#include "cli/run_program.hpp"
#include "devices/arm_state.hpp"
#include "fast_robot.hpp"
#include "ros2_programs.hpp"
#include "saccade/arm/urdf.hpp"

namespace saccade::test {
namespace {

FastImage image_of(const DepthImage& depth, double time_s) {
  FastImage image;
  image.header_(header_at(time_s, "camera_depth_optical_frame"));
  image.width_(static_cast<std::uint32_t>(depth.width()));
  image.height_(static_cast<std::uint32_t>(depth.height()));
  image.encoding_("32FC1");
  image.step_(4 * image.width_());
  const auto bytes = std::as_bytes(std::span{depth.pixels()});
  image.data_().resize(bytes.size());
  std::memcpy(image.data_().data(), bytes.data(), bytes.size());
  return image;
}

TEST(Ros2Explore, AnArmAndACameraBehindTopicsExploreToTheEnd) {
  const TempFolder folder;
  const auto read = find_robot("comau_smart_six", {});
  ASSERT_TRUE(read);
  std::vector<std::string> names;
  for (const ArmJoint& joint : read->arm.joints()) names.push_back(joint.name);
  const Configuration middle = read->arm.middle();

  const fs::path scene = source_folder() / "scenes/tabletop-1.yaml";
  const fs::path state_file = folder / "state";
  devices::ArmState state{state_file.string()};
  auto eye = started(device_command(
      "simulated-camera", "", "--scene " + quoted(scene) + " --width 96 --noise 0 --state " + quoted(state_file)));
  ASSERT_TRUE(eye);
  const PinholeCamera k = eye->intrinsics();

  FastNode node;
  const FastArm arm{node, names, {middle.begin(), middle.end()}, [&](const std::vector<double>& q) { state.write(q); }};
  const FastCamera camera{
      node,
      camera_info(static_cast<std::uint32_t>(k.width), static_cast<std::uint32_t>(k.height), k.fx, k.cx, k.cy),
      [&] {
        const double time_s = wall_s();
        return image_of(eye->capture(Pose::Identity()).value().depth, time_s);
      },
      {.reliable = false},
      std::chrono::milliseconds{50}};
  std::ofstream{folder / "cell.yaml"} << text_of(scene) << "arm: {robot: comau_smart_six}\n"
                                      << "camera: {command: \"" << ros2_command("camera /camera/depth") << "\"}\n"
                                      << "joints: {command: \""
                                      << ros2_command("joints /arm_controller/joint_trajectory")
                                      << "\", watchdog: 2}\n";
  const Outcome outcome =
      run_program({"explore", (folder / "cell.yaml").string(), "--out", (folder / "run").string(), "--voxel-size",
                   "0.03", "--max-views", "2", "--min-gain", "1", "--quiet", "--no-pictures", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  const nlohmann::json result = outcome.json().at("result");
  ASSERT_EQ(result.at("views").size(), 2U);
  EXPECT_LT(result.at("final").at("unknown_left").get<int>(), result.at("initial").at("unknown_left").get<int>());
  for (const nlohmann::json& view : result.at("views")) EXPECT_GT(view.at("motion_s").get<double>(), 0.1);
  EXPECT_GE(arm.heard().size(), 3U);  // two poses of the scan may be one motion
}

}  // namespace
}  // namespace saccade::test
