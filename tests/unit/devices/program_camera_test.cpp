// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/programs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "saccade/sensor/analytic_scene.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

const std::string kCameraPy{"/usr/bin/python3 -B '" + (test::source_folder() / "devices/camera.py").string() + "'"};
const std::string kRobotPy{"/usr/bin/python3 -B '" + (test::source_folder() / "examples/external_robot.py").string() +
                           "'"};

/// Returns the view of the examples.
AnalyticScene ball_on_plane() {
  AnalyticScene scene;
  scene.objects.push_back({"plane", HalfSpace{}, {160, 160, 150}, {}});
  scene.objects.push_back({"ball", Sphere{{0.0, 0.0, 0.1}, 0.1}, {200, 60, 40}, {}});
  return scene;
}

Pose above() { return look_at({0.5, -0.3, 0.4}, {0.0, 0.05, 0.15}); }

/// Compares with the exact picture; pixels on an edge may fall to either side. Returns how many returns there were.
int expect_truth(const ProgramCamera& camera, const Frame& frame, double tolerance_m) {
  const auto truth = render(ball_on_plane(), camera.intrinsics(), above());
  EXPECT_TRUE(truth.ok());
  int returns = 0;
  int off = 0;
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      const float seen = std::max(frame.depth(u, v), 0.0F);
      returns += seen > 0.0F ? 1 : 0;
      if (std::abs(static_cast<double>(seen) - static_cast<double>(truth->depth(u, v))) > tolerance_m) ++off;
    }
  }
  EXPECT_LE(off, 4);
  EXPECT_EQ(frame.depth.width(), 160);
  EXPECT_EQ(frame.depth.height(), 120);
  return returns;
}

TEST(ProgramCamera, ThePythonExampleSeesItsScene) {
  auto camera = ProgramCamera::start({kCameraPy});
  ASSERT_TRUE(camera.ok()) << camera.error().to_string();
  EXPECT_EQ(camera->intrinsics(), (PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.1, 3.0}));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = camera->capture(above());
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_GT(expect_truth(*camera, *frame, 1e-6), 10000);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->name, "frame " + std::to_string(i));
    EXPECT_TRUE(frame->T_world_camera->isApprox(above()));
    EXPECT_FALSE(frame->color);
  }
  const auto sky = camera->capture(look_at({0.0, 0.0, 1.0}, {0.0, 0.0, 2.0}));
  ASSERT_TRUE(sky.ok());
  EXPECT_EQ(sky->depth(3, 4), -3.0F);  // free up to the camera's range
}

TEST(ProgramCamera, TheCppExampleSeesItsSceneInColor) {
  const std::filesystem::path example = test::example_program("external_camera");
  if (!std::filesystem::exists(example)) GTEST_SKIP() << "the examples are not built";
  auto camera = ProgramCamera::start({example.string()});
  ASSERT_TRUE(camera.ok()) << camera.error().to_string();
  for (int i = 0; i < 5; ++i) {
    const auto frame = camera->capture(above());
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    EXPECT_GT(expect_truth(*camera, *frame, 0.0006), 10000);
    ASSERT_TRUE(frame->color.has_value());
    EXPECT_EQ((*frame->color)(80, 70), (Rgb8{200, 60, 40}));
    EXPECT_EQ((*frame->color)(3, 118), (Rgb8{160, 160, 150}));
  }
}

TEST(ProgramRobot, ThePythonExampleReachesItsBox) {
  auto robot = ProgramRobot::start({kRobotPy});
  ASSERT_TRUE(robot.ok()) << robot.error().to_string();
  const auto reached = (*robot)->move_to(above());
  ASSERT_TRUE(reached.ok()) << reached.error().to_string();
  ASSERT_TRUE(reached->has_value());
  EXPECT_TRUE((*reached)->isApprox(above()));
  EXPECT_EQ((*robot)->why_not_reached(), "");
  const auto beyond = (*robot)->move_to(look_at({0.0, 2.0, 0.5}, {0.0, 0.0, 0.0}));
  ASSERT_TRUE(beyond.ok());
  EXPECT_FALSE(beyond->has_value());
  EXPECT_EQ((*robot)->why_not_reached(), "y = 2.000 m is not within -0.8 and 0.8 m");
}

/// A program that answers the first requests with the given bytes, one after the other, then waits for its end.
class Answers {
 public:
  explicit Answers(const std::vector<std::string>& answers) {
    for (std::size_t i = 0; i < answers.size(); ++i) {
      command_ += "read request; cat " + folder_.write(std::to_string(i), answers[i] + "\n").string() + "; ";
    }
    command_ += "cat >/dev/null'";
  }
  [[nodiscard]] const std::string& command() const { return command_; }

 private:
  test::TempFolder folder_;
  std::string command_{"sh -c '"};
};

const std::string kHello{
    R"({"saccade": 1, "width": 4, "height": 2, "fx": 5, "fy": 5, "cx": 2, "cy": 1, "min_range_m": 0.1, )"
    R"("max_range_m": 3, "depth": "uint16_mm", "color": "none"})"};

void expect_one_line(const Error& error, Errc code, const std::string& words) {
  EXPECT_EQ(error.code, code) << error.to_string();
  EXPECT_NE(error.to_string().find(words), std::string::npos) << error.to_string();
  EXPECT_EQ(error.to_string().find_first_of("\r\n"), std::string::npos);
}

TEST(ProgramCamera, NonsenseInItsHelloIsNamed) {
  const Answers greeting{{"Welcome to CamSDK"}};
  const auto chatty = ProgramCamera::start({greeting.command()});
  ASSERT_FALSE(chatty.ok());
  expect_one_line(chatty.error(), Errc::corrupt_data,
                  "': the answer to hello is wrong: it is not JSON: 'Welcome to CamSDK'; messages belong on stderr");
  const Answers unplugged{{R"({"error": "no camera\nis plugged in"})"}};
  const auto none = ProgramCamera::start({unplugged.command()});
  ASSERT_FALSE(none.ok());
  expect_one_line(none.error(), Errc::unavailable, "hello failed: no camera is plugged in");
}

TEST(ProgramCamera, AFrameOfMillimetres) {
  // Samples 0, 1 mm (nearer than the camera sees), 256 mm, 1000 mm, 3001 mm (farther), 65535, 2 mm, 512 mm.
  using namespace std::string_literals;
  const std::string depth{"\0\0\x01\0\0\x01\xE8\x03\xB9\x0B\xFF\xFF\x02\0\0\x02"s};
  const std::string moved = R"({"number": 0, "bytes": 16, "time_s": 12.5, "T_world_camera": )"
                            R"([[1,0,0,0.5],[0,1,0,-0.25],[0,0,1,0.5],[0,0,0,1]]})";
  const Answers program{{kHello, moved + "\n" + depth}};
  auto camera = ProgramCamera::start({program.command()});
  ASSERT_TRUE(camera.ok()) << camera.error().to_string();
  const auto frame = camera->capture(above());
  ASSERT_TRUE(frame.ok()) << frame.error().to_string();
  EXPECT_EQ(frame->depth, (DepthImage{4, 2, {0.0F, 0.0F, 0.256F, 1.0F, 0.0F, 0.0F, 0.0F, 0.512F}}));
  EXPECT_TRUE(frame->T_world_camera->translation().isApprox(Eigen::Vector3d{0.5, -0.25, 0.5}));
  EXPECT_EQ(frame->time_s, 12.5);
  const auto more = camera->capture(above());  // an unrequested empty line follows the frame
  ASSERT_FALSE(more.ok());
  expect_one_line(more.error(), Errc::corrupt_data, "");
}

TEST(ProgramCamera, WrongSizesAreNamed) {
  const Answers program{{kHello, R"({"number": 0, "bytes": 15})"}};
  auto camera = ProgramCamera::start({program.command()});
  ASSERT_TRUE(camera.ok()) << camera.error().to_string();
  const auto frame = camera->capture(above());
  ASSERT_FALSE(frame.ok());
  expect_one_line(frame.error(), Errc::size_mismatch, "the answer to frame 0 is wrong: bytes must be 16, not 15");
}

TEST(ProgramCamera, MayBeAskedAgainAfterItsOwnErrorOnly) {
  const std::string trouble = R"({"number": 0, "error": "too dark"})";
  const Answers program{{kHello, trouble, "{\"error\": \"too dark\"}", "rubbish", trouble}};
  auto camera = ProgramCamera::start({program.command()});
  ASSERT_TRUE(camera.ok()) << camera.error().to_string();
  for (int i = 0; i < 2; ++i) {
    const auto dark = camera->capture(above());
    ASSERT_FALSE(dark.ok());
    expect_one_line(dark.error(), Errc::unavailable, "frame " + std::to_string(i) + " failed: too dark");
  }
  const auto rubbish = camera->capture(above());
  ASSERT_FALSE(rubbish.ok());
  expect_one_line(rubbish.error(), Errc::corrupt_data, "'rubbish'");
  const auto final = camera->capture(above());
  ASSERT_FALSE(final.ok());
  EXPECT_EQ(final.error().to_string(), rubbish.error().to_string());
}

TEST(ProgramCamera, RefusesTimeLimitsThatAreNone) {
  EXPECT_FALSE(ProgramCamera::start({kCameraPy, {}, 0.0, 1.0, {}}).ok());
  EXPECT_FALSE(ProgramCamera::start({kCameraPy, {}, 1.0, -1.0, {}}).ok());
  EXPECT_FALSE(ProgramRobot::start({kRobotPy, {}, 1.0, 0.0, {}}).ok());
  EXPECT_FALSE(ProgramRobot::start({""}).ok());
}

TEST(ProgramRobot, SaysWhatItsProgramSays) {
  const std::string moved =
      R"({"number": 0, "reached": true, "T_world_camera": [[1,0,0,0.5],[0,1,0,-0.25],[0,0,1,0.5],[0,0,0,1]]})";
  const Answers program{{R"({"saccade": 1, "name": "arm"})", moved, R"({"number": 1, "reached": false})",
                         R"({"error": "protective stop"})", R"({"number": 3, "reached": "yes"})"}};
  auto robot = ProgramRobot::start({program.command()});
  ASSERT_TRUE(robot.ok()) << robot.error().to_string();
  const auto elsewhere = (*robot)->move_to(above());
  ASSERT_TRUE(elsewhere.ok() && elsewhere->has_value());
  EXPECT_TRUE((*elsewhere)->translation().isApprox(Eigen::Vector3d{0.5, -0.25, 0.5}));
  const auto unreached = (*robot)->move_to(above());
  ASSERT_TRUE(unreached.ok() && !unreached->has_value());
  const auto stopped = (*robot)->move_to(above());
  ASSERT_FALSE(stopped.ok());
  expect_one_line(stopped.error(), Errc::unavailable, "move 2 failed: protective stop");
  const auto wrong = (*robot)->move_to(above());
  ASSERT_FALSE(wrong.ok());
  expect_one_line(wrong.error(), Errc::corrupt_data, "the answer to move 3 is wrong: reached must be true or false");
}

TEST(ProgramRobot, ADeadRobotIsNamed) {
  const auto none = ProgramRobot::start({"/nowhere/robot"});
  ASSERT_FALSE(none.ok());
  expect_one_line(none.error(), Errc::not_found, "robot '/nowhere/robot'");
  auto robot =
      ProgramRobot::start({"sh -c 'read a; echo \"{\\\"saccade\\\": 1}\"; read b; echo emergency >&2; exit 9'"});
  ASSERT_TRUE(robot.ok()) << robot.error().to_string();
  const auto moved = (*robot)->move_to(above());
  ASSERT_FALSE(moved.ok());
  expect_one_line(moved.error(), Errc::io_failure, "ended with exit status 9 before the answer to move 0");
  expect_one_line(moved.error(), Errc::io_failure, "its stderr ends: emergency");
}

}  // namespace
}  // namespace saccade
