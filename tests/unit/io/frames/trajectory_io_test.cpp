// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/trajectory_io.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

constexpr const char* kMatrix = "1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 0 1\n";

std::vector<Pose> random_poses(std::size_t n, std::uint32_t seed) {
  std::mt19937 random{seed};
  std::normal_distribution<double> normal;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < n; ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond{normal(random), normal(random), normal(random), normal(random)}
                        .normalized()
                        .toRotationMatrix();
    pose.translation() = Eigen::Vector3d{normal(random), normal(random), normal(random)};
    poses.push_back(pose);
  }
  return poses;
}

TEST(Trajectory, EveryFormatRoundTrips) {
  constexpr std::uint32_t kSeed{9};
  const TempFolder folder;
  const auto poses = random_poses(50, kSeed);
  std::vector<StampedPose> stamped;
  for (std::size_t i = 0; i < poses.size(); ++i) stamped.push_back({1.5e9 + 0.03 * static_cast<double>(i), poses[i]});
  ASSERT_TRUE(write_tum_trajectory(folder / "tum.txt", stamped));
  ASSERT_TRUE(write_matrices(folder / "matrices.txt", poses));
  ASSERT_TRUE(write_open3d_log(folder / "open3d.log", poses));
  nlohmann::json plain = nlohmann::json::array();
  nlohmann::json views = nlohmann::json::array();
  for (const Pose& pose : poses) {
    plain.push_back(pose_to_json(pose));
    views.push_back({{"gain", 1}, {"T_world_camera", pose_to_json(pose)}});
  }
  ASSERT_TRUE(write_json(folder / "plain.json", plain));
  ASSERT_TRUE(write_json(folder / "nbv.json", {{"schema", 1}, {"result", {{"views", views}}}}));
  std::size_t compared = 0;
  for (const char* name : {"tum.txt", "matrices.txt", "open3d.log", "plain.json", "nbv.json"}) {
    const auto read = read_poses(folder / name);
    ASSERT_TRUE(read) << read.error().to_string();
    ASSERT_EQ(read->size(), poses.size()) << name;
    for (std::size_t i = 0; i < poses.size(); ++i, ++compared) {
      EXPECT_LT(((*read)[i].matrix() - poses[i].matrix()).cwiseAbs().maxCoeff(), 2e-15) << name;
    }
  }
  const auto tum = read_tum_trajectory(folder / "tum.txt");
  ASSERT_TRUE(tum);
  EXPECT_EQ((*tum)[7].time_s, stamped[7].time_s);
  EXPECT_FALSE(read_tum_trajectory(folder / "matrices.txt"));
  std::cout << "seed " << kSeed << ", poses compared " << compared << "\n";
  EXPECT_EQ(compared, 250U);
}

TEST(Trajectory, OneJsonPoseIsAList) {
  const auto one = parse_pose_list("[[1,0,0,4],[0,1,0,5],[0,0,1,6],[0,0,0,1]]");
  ASSERT_TRUE(one) << one.error().to_string();
  ASSERT_EQ(one->size(), 1U);
  EXPECT_EQ(one->front().T_world_camera->translation(), Eigen::Vector3d(4, 5, 6));
}

TEST(Trajectory, CommentsBlankLinesAndCommasAreSkipped) {
  const auto entries = parse_pose_list("# title\n\n1, 0, 0, 4 # first row\n0,1,0,5\r\n0 0 1 6\n\n0 0 0 1\n# end");
  ASSERT_TRUE(entries) << entries.error().to_string();
  ASSERT_EQ(entries->size(), 1U);
  EXPECT_EQ(entries->front().line, 3U);
  const auto flat = parse_pose_list("1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n");
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->front().T_world_camera->translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(parse_pose_list("")->empty());
}

TEST(Trajectory, BadPosesKeepTheirPlace) {
  const auto entries =
      parse_pose_list(std::string{kMatrix} + "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" +
                      "1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n" + "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + kMatrix);
  ASSERT_TRUE(entries) << entries.error().to_string();
  ASSERT_EQ(entries->size(), 5U);
  EXPECT_TRUE((*entries)[0].T_world_camera);
  for (const std::size_t i : {1U, 2U, 3U}) {
    ASSERT_FALSE((*entries)[i].T_world_camera);
    EXPECT_NE((*entries)[i].T_world_camera.error().context.find("line " + std::to_string(4 * i + 1)),
              std::string::npos);
  }
  EXPECT_TRUE((*entries)[4].T_world_camera);
  const TempFolder folder;
  const auto path = folder.write("p.txt", "1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n");
  const auto strict = read_poses(path);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().to_string().rfind(path.string(), 0), 0U);
  EXPECT_EQ(read_poses(folder.write("e.txt", "#\n")).error().code, Errc::not_found);
}

TEST(Trajectory, BrokenTextIsAnErrorWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"1 2\n", "line 1"},
      {"1 0 0 0\n0 1 0 x\n", "line 2"},
      {"1 0 0 0\n0 1 0\n", "line 2"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n", "cut"},
      {"1 0 0 0\n1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n", "cut"},
      {"0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 1\n", "line 6"},
      {"0 0 1\n", "cut"},
      {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", "line 2"},
      {"nan 0 0 0 0 0 0 1\n", "time"},
      {"[1, 2", "JSON"},
      {"{}", "no array"},
      {"[[[1,0,0,0]]]", "4x4"},
      {"[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,\"1\"]]", "4x4"},
  };
  for (const auto& [text, message] : cases) {
    const auto entries = parse_pose_list(text);
    if (!entries) {
      EXPECT_NE(entries.error().to_string().find(message), std::string::npos) << text << entries.error().to_string();
    } else {
      ASSERT_EQ(entries->size(), 1U) << text;
      ASSERT_FALSE(entries->front().T_world_camera) << text;
      EXPECT_NE(entries->front().T_world_camera.error().to_string().find(message), std::string::npos) << text;
    }
  }
}

TEST(Trajectory, RealFilesAreRead) {
  const fs::path data = test::shared_data();
  if (!fs::exists(data)) GTEST_SKIP() << "no " << data;
  EXPECT_EQ(read_poses(data / "rgbd_eyeinhand_shelfA/cam.poses.A.txt")->size(), 15U);
  EXPECT_EQ(read_poses(data / "rgbd_open3d5/RGBD/trajectory.log")->size(), 5U);
  EXPECT_EQ(read_poses(data / "rgbd_redkitchen/frame-000000.pose.txt")->size(), 1U);
}

TEST(Intrinsics, EveryFormIsRead) {
  for (const char* text :
       {"525,526,319.5,239.5", "525 526 319.5 239.5\n", "525 0 319.5\n0 526 239.5\n0 0 1\n",
        "# K\n525 0 319.5 0 526 239.5 0 0 1",
        R"({"width": 640, "height": 480, "intrinsic_matrix": [525, 0, 0, 0, 526, 0, 319.5, 239.5, 1]})",
        R"({"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5})"}) {
    const auto intrinsics = parse_intrinsics(text);
    ASSERT_TRUE(intrinsics) << text << intrinsics.error().to_string();
    EXPECT_EQ(intrinsics->fx, 525.0) << text;
    EXPECT_EQ(intrinsics->fy, 526.0) << text;
    EXPECT_EQ(intrinsics->cx, 319.5) << text;
    EXPECT_EQ(intrinsics->cy, 239.5) << text;
    EXPECT_TRUE(intrinsics->camera(640, 480)) << text;
  }
  const auto full = parse_intrinsics(
      R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 32, "cy": 24, "min_range_m": 0.3, "max_range_m": 2.5,
          "distortion": {"k1": -0.1, "p2": 0.01}})");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->distortion->k1, -0.1);
  EXPECT_EQ(full->distortion->p2, 0.01);
  EXPECT_EQ(full->camera(64, 48)->max_range_m, 2.5);
  EXPECT_EQ(full->camera(65, 48).error().code, Errc::size_mismatch);
  const auto again = parse_intrinsics(camera_to_json(*full->camera(64, 48)).dump());
  ASSERT_TRUE(again);
  EXPECT_EQ(*again->camera(64, 48), *full->camera(64, 48));
}

TEST(Intrinsics, BadOnesAreRefused) {
  for (const char* text :
       {"", "1,2,3", "0,5,1,1", "nan,5,1,1", "5 1 1\n0 5 1\n0 0 1\n", "5 0 1\n0 5 1\n0 0 2\n", "5 0 1 0 5 1 0 0", "{}",
        "{", "five", R"({"intrinsic_matrix": [1,2,3]})", R"({"fx": "a", "fy": 1, "cx": 1, "cy": 1})",
        R"({"fx": 1, "fy": 1, "cx": 1, "cy": 1, "width": 0})", R"({"fx": 1, "fy": 1, "cx": 1, "cy": 1, "width": 1e9})",
        R"({"fx": 1, "fy": 1, "cx": 1, "cy": 1, "distortion": 3})"}) {
    EXPECT_FALSE(parse_intrinsics(text)) << text;
  }
}

TEST(CamInfo, RealFileIsRead) {
  const fs::path path = test::shared_data() / "rgbd_eyeinhand_shelfA/cam.info.txt";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const auto info = parse_cam_info(*read_text_file(path));
  ASSERT_TRUE(info) << info.error().to_string();
  EXPECT_NEAR(info->color.fx, 611.6857, 1e-3);
  EXPECT_NEAR(info->depth.fx, 477.4254, 1e-3);
  EXPECT_EQ(info->T_world_camera.size(), 15U);
  EXPECT_NEAR(info->T_world_camera.at("frame-000001").T_world_camera->translation().x(), 1.12788705, 1e-9);
}

TEST(CamInfo, BadOnesSayWhere) {
  const std::string color = "# Color camera intrinsic matrix\n5 0 1\n0 5 1\n0 0 1\n";
  EXPECT_NE(parse_cam_info("").error().message.find("Color camera"), std::string::npos);
  EXPECT_NE(parse_cam_info("# Color camera intrinsic matrix\n5 0 1\n").error().context.find("line 1"),
            std::string::npos);
  EXPECT_NE(parse_cam_info(color + "# pose for frame-000000\n1 0 0\n").error().context.find("line 5"),
            std::string::npos);
  EXPECT_FALSE(parse_cam_info(color + "# pose for frame-000000\n" + kMatrix + kMatrix));
  const auto bad_pose = parse_cam_info(color + "# pose for frame-000000\n2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_TRUE(bad_pose);
  EXPECT_FALSE(bad_pose->T_world_camera.at("frame-000000").T_world_camera);
}

TEST(Polygons, AreReadFromJson) {
  const auto polygons = parse_polygons("[[[0, 0], [4, 0.5], [4, 4]], []]");
  ASSERT_TRUE(polygons);
  ASSERT_EQ(polygons->size(), 2U);
  EXPECT_EQ((*polygons)[0][1], Eigen::Vector2d(4, 0.5));
  for (const char* text : {"", "3", "[3]", "[[3]]", "[[[1]]]", "[[[1, \"2\"]]]"})
    EXPECT_FALSE(parse_polygons(text)) << text;
}

TEST(Json, ErrorsNameFileAndByte) {
  const TempFolder folder;
  const auto path = folder.write("x.json", "{\"a\": }");
  const auto value = read_json(path);
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().code, Errc::corrupt_data);
  EXPECT_NE(value.error().context.find(path.string() + ", byte 7"), std::string::npos) << value.error().context;
  EXPECT_EQ(value.error().message.find("json.exception"), std::string::npos);
  EXPECT_FALSE(parse_json(std::string(100000, '[')));
  ASSERT_TRUE(write_json(folder / "y.json", {{"name", "\xFF not UTF-8"}}));
  EXPECT_TRUE(read_json(folder / "y.json"));
  EXPECT_FALSE(pose_from_json(nlohmann::json{1, 2, 3, 4}));
}

}  // namespace
}  // namespace saccade
