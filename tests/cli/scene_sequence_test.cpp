// SPDX-License-Identifier: Apache-2.0
// saccade scene sequence: what it writes, what its switches do, and that fuse reads it.
#include <gtest/gtest.h>

#include <set>

#include "cli/run_program.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

class SceneSequence : public ::testing::Test {
 protected:
  /// A small one of the desk, or of another scene.
  [[nodiscard]] Outcome run(const std::string& out, const Arguments& more = {},
                            const std::string& scene = "desk") const {
    return run_program(
        Arguments{"scene", "sequence", scene, "--out", (folder_ / out).string(), "--image-size", "160,120", "--quiet"} +
        more);
  }
  [[nodiscard]] std::vector<Frame> frames_of(const std::string& out) const {
    const auto source = open_rgbd_folder(folder_ / out);
    EXPECT_TRUE(source) << source.error().message;
    std::vector<Frame> frames;
    while (auto frame = (*source)->next().value()) frames.push_back(std::move(*frame));
    return frames;
  }
  [[nodiscard]] std::vector<Frame> made(const std::string& out, const Arguments& more = {}) const {
    const Outcome outcome = run(out, more + Arguments{"--frames", "2"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return frames_of(out);
  }
  [[nodiscard]] std::string bytes_of(const std::string& out) const {
    std::string all;
    for (const std::string& name : names_in(folder_ / out)) all += name + text_of(folder_ / out / name);
    return all;
  }
  TempFolder folder_;
};

TEST_F(SceneSequence, IsAFolderOfFramesWithTheirTruth) {
  const Outcome outcome = run("a", {"--frames", "3", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  expect_envelope(outcome.json(), "scene");
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("frames"), 3);
  EXPECT_EQ(result.at("interrupted"), false);
  EXPECT_GT(result.at("ms_per_frame").at("render").at("median").get<double>(), 0.0);
  EXPECT_GT(result.at("ms_per_frame").at("write").at("median").get<double>(), 0.0);
  const fs::path folder = folder_ / "a";
  EXPECT_EQ(names_in(folder), (Arguments{"camera.json", "frame-000000.color.png", "frame-000000.depth.png",
                                         "frame-000000.label.png", "frame-000000.pose.txt", "frame-000001.color.png",
                                         "frame-000001.depth.png", "frame-000001.label.png", "frame-000001.pose.txt",
                                         "frame-000002.color.png", "frame-000002.depth.png", "frame-000002.label.png",
                                         "frame-000002.pose.txt", "sequence.json", "true-poses.txt"}));
  const nlohmann::json document = read_json(folder / "sequence.json").value();
  EXPECT_EQ(document.at("scene"), "desk");
  EXPECT_EQ(document.at("frames"), 3);
  EXPECT_EQ(document.at("complete"), true);
  EXPECT_EQ(document.at("switches"), result.at("switches"));
  EXPECT_EQ(document.at("segments").size(), result.at("segments").get<std::size_t>());
  const Image16 labels = read_png16(folder / "frame-000001.label.png").value();
  std::set<std::string> seen;
  for (const std::uint16_t label : labels.pixels()) {
    if (label > 0) seen.insert(document.at("segments").at(std::to_string(label)).get<std::string>());
  }
  EXPECT_TRUE(seen.contains("desk"));
  EXPECT_GT(seen.size(), 10U);

  const std::vector<Frame> frames = frames_of("a");
  ASSERT_EQ(frames.size(), 3U);
  const std::vector<Pose> true_poses = read_poses(folder / "true-poses.txt").value();
  ASSERT_EQ(true_poses.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(frames[i].color && frames[i].T_world_camera);
    const double error_m = (frames[i].T_world_camera->translation() - true_poses[i].translation()).norm();
    EXPECT_GT(error_m, 0.0);
    EXPECT_LT(error_m, 0.03);
  }
}

TEST_F(SceneSequence, FusesWithItsPoses) {
  ASSERT_EQ(run("a", {"--frames", "4"}, "workshop-1").status, 0);
  const Outcome outcome = run_program(fuse(folder_ / "a", folder_ / "run", {"--tracking", "forced", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("frames"), 4);
  EXPECT_TRUE(outcome.json().at("result").at("skipped").empty());
  EXPECT_GT(outcome.json().at("result").at("mesh").at("triangles").get<int>(), 1000);
}

TEST_F(SceneSequence, IsTheSameForEveryThreadCount) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; the other tests render, too";
  for (const std::string scene : {"desk", "magazines-1"}) {
    ASSERT_EQ(run(scene + "1", {"--frames", "3", "--threads", "1"}, scene).status, 0);
    ASSERT_EQ(run(scene + "5", {"--frames", "3", "--threads", "5"}, scene).status, 0);
    ASSERT_EQ(run(scene + "s", {"--frames", "3", "--seed", "2"}, scene).status, 0);
    EXPECT_TRUE(bytes_of(scene + "1") == bytes_of(scene + "5"));
    EXPECT_FALSE(bytes_of(scene + "1") == bytes_of(scene + "s"));
  }
}

TEST_F(SceneSequence, EverySwitchChangesItsOwn) {
  const Arguments off{"--depth-noise", "off",          "--pose-noise", "off",         "--color-noise",
                      "off",           "--vignetting", "off",          "--auto-gain", "off"};
  const std::vector<Frame> plain = made("plain", off);
  ASSERT_EQ(plain.size(), 2U);
  struct Switch {
    Arguments arguments;
    bool depth;
    bool color;
    bool pose;
  };
  const std::vector<Switch> switches{{{"--depth-noise", "on"}, true, false, false},
                                     {{"--pose-noise", "on"}, false, false, true},
                                     {{"--color-noise", "on"}, false, true, false},
                                     {{"--vignetting", "on"}, false, true, false},
                                     {{"--auto-gain", "on"}, false, true, false}};
  for (std::size_t i = 0; i < switches.size(); ++i) {
    Arguments arguments = off;
    for (std::size_t k = 0; k < off.size(); k += 2) {
      if (off[k] == switches[i].arguments[0]) arguments[k + 1] = switches[i].arguments[1];
    }
    const std::string out = std::to_string(i);
    const std::vector<Frame> frames = made(out, arguments);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[1].depth != plain[1].depth, switches[i].depth) << switches[i].arguments[0];
    EXPECT_EQ(*frames[1].color != *plain[1].color, switches[i].color) << switches[i].arguments[0];
    EXPECT_EQ(frames[1].T_world_camera->matrix() != plain[1].T_world_camera->matrix(), switches[i].pose)
        << switches[i].arguments[0];
    EXPECT_EQ(text_of(folder_ / out / "frame-000001.label.png"), text_of(folder_ / "plain" / "frame-000001.label.png"));
  }
  EXPECT_TRUE(read_json(folder_ / "4" / "sequence.json").value().contains("gains"));
}

TEST_F(SceneSequence, TheSensorIsTheSceneSUnlessSaid) {
  const auto sensor = [&](const std::string& out, const Arguments& more, const std::string& scene) {
    EXPECT_EQ(run(out, more + Arguments{"--frames", "1"}, scene).status, 0);
    return read_json(folder_ / out / "sequence.json").value().at("switches");
  };
  EXPECT_EQ(sensor("a", {}, "magazines-2").at("sensor"), "kinect-v2");
  EXPECT_EQ(sensor("b", {}, "magazines-2").at("auto_gain"), "on");
  EXPECT_EQ(sensor("c", {}, "workshop-2").at("vignetting"), "corrected");
  EXPECT_EQ(sensor("d", {}, "desk").at("vignetting"), "on");
  const nlohmann::json other = sensor("e", {"--camera", "kinect-v2", "--vignetting", "corrected"}, "desk");
  EXPECT_EQ(other.at("sensor"), "kinect-v2");
  EXPECT_EQ(other.at("vignetting"), "corrected");
}

TEST_F(SceneSequence, AShorterOneLeavesNoFrameOfALongerOne) {
  ASSERT_EQ(run("a", {"--frames", "4"}).status, 0);
  ASSERT_EQ(run("a", {"--frames", "2"}).status, 0);
  EXPECT_EQ(frames_of("a").size(), 2U);
  ASSERT_EQ(run("b", {"--frames", "2"}).status, 0);
  EXPECT_TRUE(bytes_of("a") == bytes_of("b"));
}

TEST_F(SceneSequence, KeepsWholeFramesWhenInterrupted) {
  RunningProgram program{
      {"scene", "sequence", "desk", "--out", (folder_ / "a").string(), "--image-size", "160,120", "--json", "-"}};
  ASSERT_TRUE(wait_for_file(folder_ / "a" / "frame-000003.depth.png"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(result.at("interrupted"), true);
  const nlohmann::json document = read_json(folder_ / "a" / "sequence.json").value();
  EXPECT_EQ(document.at("complete"), false);
  EXPECT_NE(outcome.err.find("interrupted after "), std::string::npos) << outcome.err;
  const Outcome info = run_program({"info", (folder_ / "a").string()});
  EXPECT_NE(info.out.find("scene sequence was interrupted"), std::string::npos) << info.out;
  const std::vector<Frame> frames = frames_of("a");
  EXPECT_GE(frames.size(), 4U);
  EXPECT_EQ(frames.size(), document.at("frames").get<std::size_t>());
  EXPECT_EQ(frames.size(), read_poses(folder_ / "a" / "true-poses.txt").value().size());
  EXPECT_EQ(4 * frames.size() + 3, names_in(folder_ / "a").size());
}

TEST_F(SceneSequence, RefusesWhatItCannotDo) {
  expect_failure(run("a", {}, "atrium"), 3, "scene", {"atrium", "there are workshop-1"});
  expect_failure(run("a", {"--frames", "0"}), 2, "scene", {"--frames"});
  expect_failure(run("a", {"--camera", "lidar"}), 2, "scene", {"--camera", "xtion or kinect-v2"});
  expect_failure(run("a", {"--vignetting", "maybe"}), 2, "scene", {"--vignetting", "on, off or corrected"});
  expect_failure(run_program({"scene", "sequence", "desk", "--out", (folder_ / "a").string(), "--image-size", "8,8"}),
                 2, "scene", {"--image-size"});
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  fs::create_directory(folder_ / "mine");
  (void)folder_.write("mine/letter.txt", "dear");
  expect_failure(run("mine", {"--frames", "1"}), 3, "scene", {"other files"});
  EXPECT_EQ(run("mine", {"--frames", "1", "--force"}).status, 0);
  EXPECT_EQ(text_of(folder_ / "mine" / "letter.txt"), "dear");
  (void)folder_.write("mine/sequence.json", "[1]");
  expect_failure(run("mine", {"--frames", "1"}), 3, "scene", {"does not describe a sequence"});
}

}  // namespace
}  // namespace saccade::test
