// SPDX-License-Identifier: Apache-2.0
// Bad input to saccade fuse: one clear line, the right exit status, nothing half-written.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/maps/sacmap.hpp"

namespace saccade::test {
namespace {

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override { make_sample(frames(), 4); }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] fs::path run() const { return folder_ / "run"; }
  static std::string name(int i) { return "frame-" + std::to_string(1000000 + i).substr(1); }
  [[nodiscard]] Outcome fused(const Arguments& more = {}) const {
    return run_program(fuse(frames(), run(), Arguments{"--no-pictures", "--no-mesh"} + more));
  }
  /// The run fails with this status and message, and leaves no folder behind.
  void expect_refused(int status, const Arguments& parts, const Arguments& more = {}) const {
    expect_failure(fused(more), status, "fuse", parts);
    EXPECT_FALSE(fs::exists(run()));
  }
  /// Frame 1 is left out for this reason, the other three are fused; when all are like it, the run fails.
  void expect_skipped(const std::string& file_ending, const std::string& content, const std::string& reason,
                      const Arguments& more = {}) const {
    folder_.write("frames/" + name(1) + file_ending, content);
    const Outcome one = fused(Arguments{"--json", "-"} + more);
    ASSERT_EQ(one.status, 0) << one.err;
    const nlohmann::json result = one.json().at("result");
    EXPECT_EQ(result.at("frames"), 3);
    ASSERT_EQ(result.at("skipped").size(), 1U);
    EXPECT_EQ(result.at("skipped").at(0).at("frame"), name(1));
    EXPECT_NE(result.at("skipped").at(0).at("reason").get<std::string>().find(reason), std::string::npos)
        << result.at("skipped").dump();
    fs::remove_all(run());
    for (int i = 0; i < 4; ++i) folder_.write("frames/" + name(i) + file_ending, content);
    expect_refused(3, {frames().string(), reason}, more);
  }
  TempFolder folder_;
};

TEST_F(BadInput, NoFramesAtAll) {
  fs::create_directories(folder_ / "empty");
  expect_failure(run_program(fuse(folder_ / "empty", run())), 3, "fuse", {(folder_ / "empty").string()});
  expect_failure(run_program(fuse(folder_ / "nowhere", run())), 3, "fuse", {(folder_ / "nowhere").string()});
  expect_failure(run_program(fuse(frames() / (name(0) + ".depth.png"), run())), 3, "fuse", {name(0)});
  expect_refused(3, {"4 frames"}, {"--first", "4"});
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(BadInput, MissingOrBrokenIntrinsics) {
  fs::remove(frames() / "camera-intrinsics.txt");
  expect_refused(3, {"--intrinsics fx,fy,cx,cy", frames().string()});
  folder_.write("frames/camera-intrinsics.txt", "131.25 0 79.5\n0 0 59.5\n0 0 1\n");
  expect_refused(3, {"focal lengths must not be 0"});
  folder_.write("frames/camera-intrinsics.txt", "what is this");
  expect_refused(3, {"camera-intrinsics.txt"});
  fs::remove(frames() / "camera-intrinsics.txt");
  EXPECT_EQ(fused({"--intrinsics", "131.25,131.25,79.5,59.5"}).status, 0);
}

TEST_F(BadInput, WrongSizes) {
  expect_refused(3, {"640x480", "160x120"}, {"--camera", "kinect-v1"});
  MaskImage mask{40, 30};
  ASSERT_TRUE(write_png(folder_ / "mask.png", mask));
  expect_refused(3, {"mask", "40x30"}, {"--mask", (folder_ / "mask.png").string()});
  ASSERT_TRUE(write_png(folder_ / "small.png", ColorImage{80, 60}));
  const std::string small = text_of(folder_ / "small.png");
  folder_.write("frames/" + name(1) + ".color.png", small);
  const Outcome one = fused({"--json", "-"});
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.json().at("result").at("skipped").at(0).at("reason").get<std::string>().find("80x60"),
            std::string::npos);
  for (int i = 0; i < 4; ++i) folder_.write("frames/" + name(i) + ".color.png", small);
  const Outcome scaled = fused({"--force"});
  EXPECT_EQ(scaled.status, 0) << "colours that are all of one size are scaled";
  EXPECT_NE(scaled.err.find("80x60 are taken for the view of the depth images, 160x120"), std::string::npos)
      << scaled.err;
}

TEST_F(BadInput, DepthImagesOfAnotherSize) {
  ASSERT_TRUE(write_png16(folder_ / "small.png", Image16{80, 60}));
  folder_.write("frames/" + name(1) + ".depth.png", text_of(folder_ / "small.png"));
  const Outcome outcome = fused({"--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("skipped").at(0).at("frame"), name(1));
}

TEST_F(BadInput, TruncatedPng) {
  const std::string whole = text_of(frames() / (name(0) + ".depth.png"));
  expect_skipped(".depth.png", whole.substr(0, whole.size() / 2), ".depth.png");
}

TEST_F(BadInput, NoImageAtAll) { expect_skipped(".depth.png", "", ".depth.png"); }

TEST_F(BadInput, PosesThatAreNoNumbers) {
  expect_skipped(".pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "pose");
}

TEST_F(BadInput, PosesThatAreNoRotations) {
  expect_skipped(".pose.txt", "1 0 0 0\n0 1.01 0 0\n0 0 1 0\n0 0 0 1\n", "rotation", {"--tracking", "hint"});
}

TEST_F(BadInput, BadPosesDoNotMatterToIcp) {
  folder_.write("frames/" + name(1) + ".pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const Outcome outcome = fused({"--tracking", "icp", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("frames").get<int>() + outcome.json().at("result").at("lost").get<int>(), 4);
  EXPECT_TRUE(outcome.json().at("result").at("skipped").empty());
}

TEST_F(BadInput, PosesThatAreNeededAndAbsent) {
  for (int i = 0; i < 4; ++i) fs::remove(frames() / (name(i) + ".pose.txt"));
  expect_refused(3, {"--poses FILE", "--tracking icp"}, {"--tracking", "forced"});
  expect_refused(3, {"nowhere.txt"}, {"--poses", "nowhere.txt"});
  const fs::path text = folder_.write("text.txt", "no poses here");
  expect_refused(3, {text.string()}, {"--poses", text.string()});
}

TEST_F(BadInput, MapsToContinueThatAreDamaged) {
  ASSERT_EQ(fused().status, 0);
  const std::string whole = text_of(run() / "map.sacmap");
  fs::remove_all(run());
  const auto continued = [&](const fs::path& map) {
    return run_program({"fuse", frames().string(), "--out", run().string(), "--quiet", "--continue", map.string()});
  };
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{10}, std::size_t{100}, whole.size() - 1}) {
    expect_failure(continued(folder_.write("cut.sacmap", whole.substr(0, bytes))), 3, "fuse", {"cut.sacmap"});
  }
  std::string damaged = whole;
  damaged[damaged.size() - 20] = static_cast<char>(damaged[damaged.size() - 20] ^ 1);
  expect_failure(continued(folder_.write("damaged.sacmap", damaged)), 3, "fuse", {"damaged.sacmap"});
  expect_failure(continued(folder_ / "none.sacmap"), 3, "fuse", {"none.sacmap"});
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(BadInput, OutputThatCannotBeWritten) {
  const fs::path file = folder_.write("file", "x");
  for (const fs::path& out : {file, file / "below" / "run"}) {
    expect_failure(run_program(fuse(frames(), out)), 3, "fuse", {out.string()});
  }
  EXPECT_EQ(text_of(file), "x");
  expect_refused(3, {(file / "result.json").string()}, {"--json", (file / "result.json").string()});
}

TEST_F(BadInput, VoxelsOfZeroAndLess) {
  for (const std::string size : {"0", "-0.01", "nan", "inf", "1e-12", "small"}) {
    const Outcome outcome = run_program({"fuse", frames().string(), "--out", run().string(), "--voxel-size", size});
    expect_failure(outcome, 2, "fuse", {"--voxel-size"});
  }
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(BadInput, SizesOfZeroAndLess) {
  expect_refused(2, {"--truncation", "positive"}, {"--truncation", "0"});
  expect_refused(2, {"--clearing", "1 to 100"}, {"--clearing", "0"});
  expect_refused(2, {"--clearing", "1 to 100"}, {"--clearing", "101"});
  expect_refused(2, {"--max-range", "positive"}, {"--max-range", "0"});
  expect_refused(2, {"--min-range"}, {"--min-range=-1"});
  expect_refused(2, {"--min-range", "--max-range"}, {"--min-range", "3", "--max-range", "2"});
  expect_refused(2, {"--depth-scale", "positive"}, {"--depth-scale", "0"});
  expect_refused(2, {"--fill-gaps"}, {"--fill-gaps=-1"});
  expect_refused(2, {"step"}, {"--every", "0"});
  expect_refused(2, {"number of frames"}, {"--count", "0"});
  for (const std::string option : {"--first", "--count", "--every"}) {
    expect_refused(2, {option, "whole number", "'-1'"}, {option + "=-1"});
  }
  expect_refused(2, {"--intrinsics", "positive"}, {"--intrinsics", "0,131,79.5,59.5"});
  expect_refused(2, {"--workspace"}, {"--workspace", "0,0,0,1,1,0"});
  expect_refused(2, {"--tracking", "icp, rgbd, hint or forced"}, {"--tracking", "guess"});
  expect_refused(2, {"--mask"}, {"--mask", "0,0;1,1"});
  expect_refused(2, {"--continue"}, {"--continue", "any.sacmap"});
  expect_refused(2, {"--distortion", "4 to 8 numbers"}, {"--distortion", "0.1,0.2"});
}

TEST_F(BadInput, NoDepthWithinTheRange) {
  expect_refused(5, {"--min-range", "--max-range"}, {"--min-range", "100", "--max-range", "200"});
}

TEST_F(BadInput, CamerasThatSeeTooMuch) {
  expect_refused(3, {frames().string(), name(0), "too many voxels"}, {"--intrinsics", "0.2,0.2,0,0"});
  expect_refused(3, {"focal lengths must be from"}, {"--intrinsics", "1e-6,1e-6,0,0"});
}

TEST_F(BadInput, AMapIsNotReplacedByAResult) {
  ASSERT_EQ(fused().status, 0);
  const fs::path map = run() / "map.sacmap";
  const std::string whole = text_of(map);
  const Outcome outcome = run_program({"nbv", map.string(), "--poi", "0,0,0", "--quiet", "--json", map.string()});
  expect_failure(outcome, 3, "nbv", {map.string(), "name another file"});
  EXPECT_EQ(text_of(map), whole);
}

class FullDisk : public BadInput {};

TEST_F(FullDisk, ShowsBeforeTheWork) {
  const Outcome outcome = run_program(fuse(frames(), run()), rlim_t{1} << 16U);
  expect_failure(outcome, 3, "fuse", {run().string(), std::strerror(EFBIG)});
  EXPECT_FALSE(fs::exists(run()));
}

TEST_F(FullDisk, LaterLeavesNoHalfFiles) {
  const Outcome outcome = run_program(
      {"fuse", frames().string(), "--out", run().string(), "--quiet", "--voxel-size", "0.003", "--no-pictures"},
      rlim_t{1100} << 10U);
  expect_failure(outcome, 3, "fuse", {run().string(), std::strerror(EFBIG)});
  for (const std::string& file : names_in(run())) {
    EXPECT_NE(file, "run.json");
    EXPECT_NE(file, "mesh.ply");
    EXPECT_FALSE(file.ends_with(".tmp")) << file;
  }
  if (fs::exists(run() / "map.sacmap")) {
    EXPECT_TRUE(load_map(run() / "map.sacmap"));
  }
}

TEST_F(FullDisk, OfASmallFileSystem) {
  const fs::path disk = folder_ / "disk";
  fs::create_directories(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "cannot mount a small file system: " << std::strerror(errno);
  }
  const Outcome outcome = run_program(fuse(frames(), disk / "run"));
  expect_failure(outcome, 3, "fuse", {(disk / "run").string(), std::strerror(ENOSPC)});
  EXPECT_TRUE(names_in(disk).empty());
  ::umount(disk.c_str());
}

}  // namespace
}  // namespace saccade::test
