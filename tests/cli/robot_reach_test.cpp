// SPDX-License-Identifier: Apache-2.0
// saccade robot reach.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "run_program.hpp"
#include "saccade/arm/reach_map.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

const Arguments kFiles{"reach.csv", "reach.json", "reach.png"};

Arguments reach(const fs::path& out, const Arguments& more = {}) {
  return Arguments{"robot", "reach", "--out", out.string(), "--quiet", "--step", "0.2"} + more;
}

std::vector<std::vector<double>> rows_of(const fs::path& csv) {
  std::istringstream lines{text_of(csv)};
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,poses,reachable,no_ik,outside_limits,goal_in_collision");
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields{line};
    rows.emplace_back(std::istream_iterator<double>{fields}, std::istream_iterator<double>{});
  }
  return rows;
}

/// The scene's fixtures in the way of nothing else.
ObstacleMap fixtures_alone(const Scene& scene) {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  config.workspace = scene.workspace;
  TsdfMap map = TsdfMap::create(config).value();
  EXPECT_TRUE(map.free(*config.workspace).ok());
  ObstacleConfig obstacles;
  const std::vector<FixtureBox> fixtures = fixture_boxes(scene).value();
  for (const FixtureBox& fixture : fixtures) obstacles.fixtures.push_back(fixture.box);
  return ObstacleMap::create(map.snapshot(), obstacles, {}).value();
}

TEST(RobotReach, TableIsWhatASlowRecomputationGives) {
  if (kSanitized) GTEST_SKIP() << "tables take long under sanitizers; GoesByWhatItIsTold makes one";
  const TempFolder folder;
  const fs::path out = folder / "reach";
  const Outcome outcome = run_program(reach(out));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(names_in(out), kFiles);
  for (const char* part : {"comau_smart_six, inverse kinematics: closed form", "tabletop-1: floor", "best point",
                           "latitude", "outside limits", "results: "}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  }
  const std::vector<std::vector<double>> rows = rows_of(out / "reach.csv");
  ASSERT_EQ(rows.size(), 7U * 5U);
  const Scene scene = find_scene("tabletop-1").value();
  const ObstacleMap obstacles = fixtures_alone(scene);
  const UrdfArm robot = find_robot("comau_smart_six").value();
  const Reachability reachability = Reachability::create(ArmCollision::create(robot.arm).value()).value();
  std::size_t compared{0};
  for (const std::size_t i : {0U, 17U, 34U}) {
    ASSERT_EQ(rows[i].size(), 8U);
    ReachCounts counts;
    const std::vector<ViewCandidate> views = view_sphere({rows[i][0], rows[i][1], rows[i][2]}).value();
    for (const ViewCandidate& view : views) {
      counts.add(reachability.goals(view.T_world_camera, robot.arm.middle(), obstacles).refusal);
      ++compared;
    }
    EXPECT_EQ(rows[i][3], static_cast<double>(counts.poses()));
    EXPECT_EQ(rows[i][4], static_cast<double>(counts.reachable)) << i;
    EXPECT_EQ(rows[i][5], static_cast<double>(counts.no_ik)) << i;
    EXPECT_EQ(rows[i][6], static_cast<double>(counts.outside_limits)) << i;
    EXPECT_EQ(rows[i][7], static_cast<double>(counts.goal_in_collision)) << i;
  }
  EXPECT_EQ(compared, 3U * 960U);
  EXPECT_DOUBLE_EQ(rows[17][0], 0.0);
  EXPECT_DOUBLE_EQ(rows[17][2], 0.1) << "0.1 m above the table";
}

TEST(RobotReach, WritesTheSameForEveryThreadCount) {
  if (kSanitized) GTEST_SKIP() << "tables take long under sanitizers; GoesByWhatItIsTold makes one";
  const TempFolder folder;
  const Outcome one = run_program(reach(folder / "one", {"--threads", "1", "--json", "-"}));
  const Outcome two = run_program(reach(folder / "two", {"--threads", "2", "--json", (folder / "two.json").string()}));
  ASSERT_EQ(one.status, 0) << one.err;
  ASSERT_EQ(two.status, 0) << two.err;
  expect_envelope(one.json(), "robot");
  const nlohmann::json result = one.json().at("result");
  EXPECT_EQ(result, read_json(folder / "two.json").value().at("result"));
  EXPECT_EQ(result, read_json(folder / "two" / "reach.json").value().at("result"));
  EXPECT_EQ(text_of(folder / "one" / "reach.csv"), text_of(folder / "two" / "reach.csv"));
  EXPECT_EQ(text_of(folder / "one" / "reach.png"), text_of(folder / "two" / "reach.png"));
  const auto picture = read_color(folder / "one" / "reach.png");
  ASSERT_TRUE(picture);
  EXPECT_GT(picture->width(), 900);

  const nlohmann::json& total = result.at("total");
  EXPECT_EQ(total.at("poses"), 35 * 960);
  EXPECT_EQ(total.at("reachable").get<int>() + total.at("no_ik").get<int>() + total.at("outside_limits").get<int>() +
                total.at("goal_in_collision").get<int>(),
            35 * 960);
  EXPECT_GT(total.at("share").get<double>(), 0.2);
  EXPECT_GE(result.at("best").at("share").get<double>(), total.at("share").get<double>());
  EXPECT_LE(result.at("worst").at("share").get<double>(), total.at("share").get<double>());
  EXPECT_EQ(result.at("by_latitude").size(), 10U);
  EXPECT_EQ(result.at("by_direction").size(), 120U);
  EXPECT_EQ(result.at("fixtures").size(), 6U);
}

TEST(RobotReach, GoesByWhatItIsTold) {
  const TempFolder folder;
  const Outcome outcome = run_program(reach(
      folder / "out", {"--base", "base", "--base-at", "-0.5,-0.75,0.4,30", "--workspace", "-0.2,-0.2,0,0.2,0.2,0.5",
                       "--height", "0.2", "--radius", "0.6,0.9", "--scene", "jug", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("scene"), "jug");
  EXPECT_EQ(result.at("points"), 4);
  EXPECT_EQ(result.at("poses_per_point"), 1920);
  EXPECT_EQ(result.at("height_m"), 0.2);
  EXPECT_EQ(result.at("by_radius").size(), 2U);
  EXPECT_EQ(result.at("T_world_base").at(1).at(3), -0.75);
  // The base as the URDF has it: the same answer.
  const Outcome urdf = run_program(reach(folder / "urdf", {"--workspace", "-0.2,-0.2,0,0.2,0.2,0.5", "--height", "0.2",
                                                           "--radius", "0.6,0.9", "--json", "-"}));
  EXPECT_EQ(urdf.json().at("result").at("total"), result.at("total"));
}

TEST(RobotReach, EndsWithFiveWhenNothingCanBeReached) {
  const TempFolder folder;
  const Outcome outcome = run_program(reach(folder / "out", {"--base-at", "20,0,0"}));
  EXPECT_EQ(outcome.status, 5);
  EXPECT_NE(outcome.err.find("not one pose can be reached"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("0.0 %"), std::string::npos);
  EXPECT_EQ(names_in(folder / "out"), kFiles);
}

TEST(RobotReach, SaysWhatIsWrong) {
  const TempFolder folder;
  const fs::path out = folder / "out";
  const auto refused = [&out](const Arguments& more, int status, const Arguments& parts) {
    expect_failure(run_program(Arguments{"robot", "reach", "--out", out.string(), "--quiet"} + more), status, "robot",
                   parts);
  };
  refused({"--step", "0"}, 2, {"--step", "positive"});
  refused({"--step", "nan"}, 2, {"--step"});
  refused({"--step", "3"}, 3, {"larger than the workspace"});
  refused({"--step", "0.0001"}, 3, {"million poses", "larger step"});
  refused({"--radius", "-1"}, 2, {"--distance"});  // the name of before
  refused({"--workspace", "0,0,0,0,1,1"}, 2, {"--workspace"});
  refused({"--height", "2"}, 3, {"--height", "outside the workspace"});
  refused({"--base-at", "1,2"}, 2, {"--base-at", "X,Y,Z"});
  refused({"--scene", "atrium"}, 3, {"atrium: no such scene"});
  refused({"hal"}, 3, {"hal: no such robot; there are comau_smart_six"});
  refused({"--package", "a"}, 2, {"NAME=FOLDER"});
  EXPECT_FALSE(fs::exists(out));
  expect_failure(run_program({"robot", "reach"}), 2, "robot", {"--out"});
  const std::string file = folder.write("file", "text").string();
  expect_failure(run_program(reach(file)), 3, "robot", {"is a file; the results need a folder"});
  fs::create_directories(folder / "full");
  folder.write("full/notes.txt", "mine");
  expect_failure(run_program(reach(folder / "full")), 3, "robot", {"holds other files", "--force"});
  EXPECT_EQ(run_program(reach(folder / "full", {"--force"})).status, 0);
  EXPECT_EQ(text_of(folder / "full" / "notes.txt"), "mine");
}

/// Six joints whose last axes do not meet: iteration.
std::string offset_wrist() {
  std::string urdf = "<robot name=\"offset\"><link name=\"l0\"/>";
  const char* axes[]{"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"};
  const char* origins[]{"0 0 0.3", "0 0 0", "0.5 0 0", "0.4 0 0", "0.1 0.05 0", "0.1 0 0.05"};
  for (int i = 0; i < 6; ++i) {
    const std::string n = std::to_string(i + 1);
    urdf += "<link name=\"l" + n + "\"/><joint name=\"j" + n + "\" type=\"revolute\"><parent link=\"l" +
            std::to_string(i) + "\"/><child link=\"l" + n + "\"/><origin xyz=\"" + origins[i] + "\"/><axis xyz=\"" +
            axes[i] + "\"/><limit lower=\"-2.5\" upper=\"2.5\" velocity=\"1\" effort=\"1\"/></joint>";
  }
  return urdf + "</robot>";
}

TEST(RobotReach, InterruptedItKeepsWhatWasDone) {
  const TempFolder folder;
  const std::string urdf = folder.write("arm.urdf", offset_wrist()).string();
  const fs::path out = folder / "out";
  RunningProgram program{{"robot", "reach", urdf, "--out", out.string(), "--radius", "0.2", "--step", "0.03"}};
  ASSERT_TRUE(program.wait_for("testing poses: 1")) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("milliseconds a pose"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted after "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("numeric"), std::string::npos) << outcome.out;
  EXPECT_EQ(names_in(out), kFiles);
  const auto result = read_json(out / "reach.json").value().at("result");
  EXPECT_EQ(rows_of(out / "reach.csv").size(), result.at("points_done").get<std::size_t>());
  EXPECT_LT(result.at("points_done"), result.at("points"));
}

}  // namespace
}  // namespace saccade::test
