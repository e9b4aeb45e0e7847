// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/rgbd_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

constexpr const char* kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
constexpr const char* kIntrinsics = "10 0 3.5\n0 10 2.5\n0 0 1\n";
constexpr int kWidth{8};
constexpr int kHeight{6};

Image16 depth_image(std::uint16_t value = 1000) { return {kWidth, kHeight, value}; }

/// 7-Scenes layout with three frames at 1, 2 and 3 m.
void write_seven_scenes(const TempFolder& folder) {
  folder.write("camera-intrinsics.txt", kIntrinsics);
  for (int i = 0; i < 3; ++i) {
    const std::string stem = "frame-00000" + std::to_string(i);
    ASSERT_TRUE(write_png16(folder / (stem + ".depth.png"), depth_image(static_cast<std::uint16_t>(1000 * (i + 1)))));
    ASSERT_TRUE(write_png(folder / (stem + ".color.png"), ColorImage{kWidth, kHeight, Rgb8{1, 2, 3}}));
    folder.write(stem + ".pose.txt", kIdentity);
  }
}

void truncate_file(const fs::path& path) { fs::resize_file(path, fs::file_size(path) - 1); }

/// Returns the results of next() until the end: the depth of pixel (0, 0), or the error's text.
std::vector<std::string> outcomes(CameraSource& source) {
  std::vector<std::string> all;
  while (true) {
    auto frame = source.next();
    if (!frame) {
      all.push_back(frame.error().to_string());
    } else if (*frame) {
      all.push_back(std::to_string((*frame)->depth(0, 0)).substr(0, 3));
    } else {
      return all;
    }
  }
}

std::vector<std::string> outcomes(const fs::path& folder, const RgbdFolderConfig& config = {}) {
  auto source = open_rgbd_folder(folder, config);
  if (!source) return {source.error().to_string()};
  return outcomes(**source);
}

TEST(RgbdFolder, GivesAnyFrameAndItsPoseWithoutMovingOn) {
  const TempFolder folder;
  write_seven_scenes(folder);
  folder.write("frame-000002.pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  RgbdFolderConfig config;
  config.first = 1;
  auto source = open_rgbd_folder(folder.path(), config);
  ASSERT_TRUE(source) << source.error().to_string();
  ASSERT_EQ((*source)->size(), 2U);
  const auto last = (*source)->at(1);
  ASSERT_TRUE(last) << last.error().to_string();
  EXPECT_EQ(last->index, 2U);
  EXPECT_EQ(last->depth(0, 0), 3.0F);
  EXPECT_EQ((*source)->pose_at(1).value().translation().x(), 0.5);
  EXPECT_EQ(outcomes(**source), (std::vector<std::string>{"2.0", "3.0"}));  // from the first one on
  truncate_file(folder / "frame-000002.depth.png");
  EXPECT_TRUE((*source)->pose_at(1));  // its images are not read
  EXPECT_FALSE((*source)->at(1));
  fs::remove(folder / "frame-000001.pose.txt");
  const auto gone = (*source)->pose_at(0);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().to_string().find("frame-000001"), std::string::npos) << gone.error().to_string();
}

TEST(RgbdFolder, ReadsSevenScenes) {
  const TempFolder folder;
  write_seven_scenes(folder);
  auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->info().layout, RgbdLayout::seven_scenes);
  EXPECT_TRUE((*source)->info().has_poses);
  EXPECT_TRUE((*source)->info().has_color);
  EXPECT_EQ((*source)->size(), 3U);
  const PinholeCamera& camera = (*source)->camera();
  EXPECT_EQ(camera.width, kWidth);
  EXPECT_EQ(camera.height, kHeight);
  EXPECT_EQ(camera.fx, 10.0);
  EXPECT_EQ(camera.cy, 2.5);
  EXPECT_EQ(camera.min_range_m, 0.2);
  EXPECT_EQ(camera.max_range_m, 6.0);
  auto frame = (*source)->next();
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->name, "frame-000000");
  EXPECT_EQ((*frame)->color, (ColorImage{kWidth, kHeight, Rgb8{1, 2, 3}}));
  ASSERT_TRUE((*frame)->T_world_camera);
  EXPECT_TRUE((*frame)->T_world_camera->isApprox(Pose::Identity()));
  EXPECT_EQ(outcomes(**source), (std::vector<std::string>{"2.0", "3.0"}));
  folder.write("._frame-000000.depth.png", "hidden");
  fs::copy_file(folder / "frame-000002.depth.png", folder / "frame-000002 (1).depth.png");
  EXPECT_NE(outcomes(folder.path()).at(3).find("no pose"), std::string::npos);  // a copy is no frame of its number
}

TEST(RgbdFolder, SelectsFrames) {
  const TempFolder folder;
  write_seven_scenes(folder);
  EXPECT_EQ(outcomes(folder.path(), {.every_nth = 2}), (std::vector<std::string>{"1.0", "3.0"}));
  EXPECT_EQ(outcomes(folder.path(), {.first = 1, .count = 1}), (std::vector<std::string>{"2.0"}));
  EXPECT_NE(outcomes(folder.path(), {.first = 3}).front().find("only 3 frames"), std::string::npos);
  EXPECT_NE(outcomes(folder.path(), {.every_nth = 0}).front().find("step"), std::string::npos);
  auto source = open_rgbd_folder(folder.path(), {.first = 1, .every_nth = 5});
  ASSERT_TRUE(source);
  auto frame = (*source)->next();
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->index, 1U);
}

TEST(RgbdFolder, DamagedFramesAreNamedAndSkipped) {
  struct Case {
    const char* what;
    std::function<void(const TempFolder&)> damage;
    const char* message;
  };
  const std::vector<Case> cases{
      {"cut depth", [](const TempFolder& f) { truncate_file(f / "frame-000001.depth.png"); }, "PNG"},
      {"cut colour", [](const TempFolder& f) { truncate_file(f / "frame-000001.color.png"); }, "PNG"},
      {"missing depth", [](const TempFolder& f) { fs::remove(f / "frame-000001.depth.png"); },
       "depth image is missing"},
      {"missing pose", [](const TempFolder& f) { fs::remove(f / "frame-000001.pose.txt"); }, "no pose"},
      {"NaN pose",
       [](const TempFolder& f) { f.write("frame-000001.pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"); }, ""},
      {"no rotation",
       [](const TempFolder& f) { f.write("frame-000001.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"); }, ""},
      {"cut pose", [](const TempFolder& f) { f.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n"); }, "cut"},
      {"other depth size",
       [](const TempFolder& f) {
         ASSERT_TRUE(write_png16(f / "frame-000001.depth.png", Image16{4, 6}));
       },
       "4x6"},
      {"other colour size",
       [](const TempFolder& f) {
         ASSERT_TRUE(write_png(f / "frame-000001.color.png", ColorImage{8, 5}));
       },
       "8x5"},
      {"8-bit depth",
       [](const TempFolder& f) {
         ASSERT_TRUE(write_png(f / "frame-000001.depth.png", MaskImage{8, 6}));
       },
       "--depth-scale N"},
  };
  for (const Case& c : cases) {
    const TempFolder folder;
    write_seven_scenes(folder);
    c.damage(folder);
    const auto all = outcomes(folder.path());
    ASSERT_EQ(all.size(), 3U) << c.what << ": " << all.front();
    EXPECT_EQ(all[0], "1.0") << c.what;
    EXPECT_EQ(all[1].rfind("frame frame-000001", 0), 0U) << c.what << ": " << all[1];
    EXPECT_NE(all[1].find(c.message), std::string::npos) << c.what << ": " << all[1];
    EXPECT_EQ(all[1].find('\n'), std::string::npos) << c.what;
    EXPECT_EQ(all[2], "3.0") << c.what;
  }
}

TEST(RgbdFolder, PosesAreOptional) {
  const TempFolder folder;
  write_seven_scenes(folder);
  folder.write("frame-000001.pose.txt", "nonsense");
  EXPECT_EQ(outcomes(folder.path(), {.require_poses = false}), (std::vector<std::string>{"1.0", "2.0", "3.0"}));
  for (int i = 0; i < 3; ++i) fs::remove(folder / ("frame-00000" + std::to_string(i) + ".pose.txt"));
  auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source);
  EXPECT_FALSE((*source)->info().has_poses);
  EXPECT_EQ(outcomes(**source), (std::vector<std::string>{"1.0", "2.0", "3.0"}));
}

TEST(RgbdFolder, SeparatePosesFile) {
  const TempFolder folder;
  write_seven_scenes(folder);
  const auto poses =
      folder.write("poses.txt", std::string{kIdentity} + "# second\n1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  auto source = open_rgbd_folder(folder.path(), {.poses_file = poses});
  ASSERT_TRUE(source) << source.error().to_string();
  ASSERT_TRUE((*source)->next());
  auto second = (*source)->next();
  ASSERT_TRUE(second && *second);
  EXPECT_EQ((*second)->T_world_camera->translation().x(), 0.5);
  EXPECT_FALSE((*source)->next());  // the file has no third pose
  EXPECT_NE(outcomes(folder.path(), {.poses_file = folder / "none.txt"}).front().find("no such file"),
            std::string::npos);
  folder.write("empty.txt", "# nothing\n");
  EXPECT_NE(outcomes(folder.path(), {.poses_file = folder / "empty.txt"}).front().find("no pose"), std::string::npos);
}

TEST(RgbdFolder, FolderErrorsSayWhatToDo) {
  const TempFolder folder;
  EXPECT_NE(outcomes(folder / "none").front().find("no such folder"), std::string::npos);
  EXPECT_NE(outcomes(folder.path()).front().find("no depth frames"), std::string::npos);
  EXPECT_NE(outcomes(folder.write("file", "x")).front().find("not a folder"), std::string::npos);
  write_seven_scenes(folder);
  fs::remove(folder / "camera-intrinsics.txt");
  EXPECT_NE(outcomes(folder.path()).front().find("--intrinsics fx,fy,cx,cy"), std::string::npos);
  folder.write("camera-intrinsics.txt", "10 0 3.5\n0 0 2.5\n0 0 1\n");
  EXPECT_NE(outcomes(folder.path()).front().find("focal lengths"), std::string::npos);
  folder.write("camera-intrinsics.txt", "10 0 3.5 0 x");
  EXPECT_NE(outcomes(folder.path()).front().find("'x' is not a number"), std::string::npos);
  fs::remove(folder / "camera-intrinsics.txt");
  folder.write("camera.json", R"({"width": 640, "height": 480, "fx": 525, "fy": 525, "cx": 320, "cy": 240})");
  EXPECT_NE(outcomes(folder.path()).front().find("640x480"), std::string::npos);
  auto given = parse_intrinsics("10,10,3.5,2.5");
  ASSERT_TRUE(given);
  EXPECT_EQ(outcomes(folder.path(), {.intrinsics = *given}).size(), 3U);
  for (int i = 0; i < 3; ++i) fs::resize_file(folder / ("frame-00000" + std::to_string(i) + ".depth.png"), 20);
  EXPECT_NE(outcomes(folder.path(), {.intrinsics = *given}).front().find("no depth image here can be read"),
            std::string::npos);
}

TEST(RgbdFolder, MaskRangeAndDistortionApply) {
  const TempFolder folder;
  write_seven_scenes(folder);
  RgbdFolderConfig config{.max_range_m = 2.5};
  config.mask_polygons = {{{-0.5, -0.5}, {3.5, -0.5}, {3.5, 5.5}, {-0.5, 5.5}}};
  auto source = open_rgbd_folder(folder.path(), config);
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->camera().max_range_m, 2.5);
  auto first = (*source)->next();
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->depth(3, 2), 0.0F);
  EXPECT_EQ((*first)->depth(4, 2), 1.0F);
  ASSERT_TRUE((*source)->next());
  auto third = (*source)->next();  // at 3 m: beyond the range
  ASSERT_TRUE(third && *third);
  EXPECT_EQ((*third)->depth(4, 2), 0.0F);

  MaskImage image{kWidth, kHeight, 255};
  image(5, 5) = 0;
  ASSERT_TRUE(write_png(folder / "mask.png", image));
  source = open_rgbd_folder(folder.path(), {.mask_file = folder / "mask.png"});
  ASSERT_TRUE(source);
  auto masked = (*source)->next();
  ASSERT_TRUE(masked && *masked);
  EXPECT_EQ((*masked)->depth(5, 5), 0.0F);
  EXPECT_EQ((*masked)->depth(4, 5), 1.0F);
  folder.write("mask.json", "[[[4.5, 4.5], [6, 4.5], [6, 6], [4.5, 6]]]");
  source = open_rgbd_folder(folder.path(), {.mask_file = folder / "mask.json"});
  ASSERT_TRUE(source);
  masked = (*source)->next();
  ASSERT_TRUE(masked && *masked);
  EXPECT_EQ((*masked)->depth(5, 5), 0.0F);
  ASSERT_TRUE(write_png(folder / "small.png", MaskImage{2, 2}));
  EXPECT_NE(outcomes(folder.path(), {.mask_file = folder / "small.png"}).front().find("2x2"), std::string::npos);

  // A strong pincushion: the corners of the ideal image come from outside of the raw one.
  source = open_rgbd_folder(folder.path(), {.distortion = Distortion{.k1 = 2.0}});
  ASSERT_TRUE(source) << source.error().to_string();
  auto undistorted = (*source)->next();
  ASSERT_TRUE(undistorted && *undistorted);
  EXPECT_EQ((*undistorted)->depth(0, 0), 0.0F);
  EXPECT_EQ((*undistorted)->depth(4, 3), 1.0F);
}

TEST(RgbdFolder, ReadsTum) {
  const TempFolder folder;
  fs::create_directory(folder / "depth");
  fs::create_directory(folder / "rgb");
  ASSERT_TRUE(write_png16(folder / "depth/1.00.png", depth_image(5000)));
  ASSERT_TRUE(write_png16(folder / "depth/2.00.png", depth_image(10000)));
  ASSERT_TRUE(write_png(folder / "rgb/1.01.png", ColorImage{kWidth, kHeight}));
  folder.write("depth.txt", "# depth maps\n1.00 depth/1.00.png\n2.00 depth/2.00.png\n3.00 depth/3.00.png\n");
  folder.write("rgb.txt", "1.01 rgb/1.01.png\n2.05 rgb/2.05.png\n");
  folder.write("groundtruth.txt",
               "# time tx ty tz qx qy qz qw\n0.99 1 0 0 0 0 0 1\n1.015 2 0 0 0 0 0 1\n2.0 3 0 0 0 0 0 2\n");
  EXPECT_NE(outcomes(folder.path()).front().find("--intrinsics"), std::string::npos);
  folder.write("camera-intrinsics.txt", kIntrinsics);
  auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->info().layout, RgbdLayout::tum);
  auto first = (*source)->next();
  ASSERT_TRUE(first && *first) << first.error().to_string();
  EXPECT_EQ((*first)->time_s, 1.0);
  EXPECT_EQ((*first)->depth(0, 0), 1.0F);
  EXPECT_TRUE((*first)->color);
  EXPECT_EQ((*first)->T_world_camera->translation().x(), 1.0);  // 10 ms before is nearer than 15 ms after
  const auto rest = outcomes(**source);
  ASSERT_EQ(rest.size(), 2U);
  EXPECT_NE(rest[0].find("quaternion"), std::string::npos) << rest[0];
  EXPECT_NE(rest[1].find("no pose"), std::string::npos) << rest[1];
  source = open_rgbd_folder(folder.path(), {.require_poses = false});
  ASSERT_TRUE(source);
  const auto without = outcomes(**source);
  EXPECT_EQ(without[1], "2.0");
  EXPECT_NE(without[2].find("no such file"), std::string::npos) << without[2];
  folder.write("depth.txt", "1.00\n");
  EXPECT_NE(outcomes(folder.path()).front().find("line 1"), std::string::npos);
}

TEST(RgbdFolder, LaysColorsOfAnotherCameraOnTheDepths) {
  const TempFolder folder;
  folder.write("camera-intrinsics.txt", kIntrinsics);
  ASSERT_TRUE(write_png16(folder / "frame-000000.depth.png", depth_image(1000)));
  ColorImage columns{kWidth, kHeight};
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) columns(u, v) = {static_cast<std::uint8_t>(10 * u + 10), 0, 0};
  }
  ASSERT_TRUE(write_png(folder / "frame-000000.color.png", columns));
  RgbdFolderConfig config;
  config.color_intrinsics = Intrinsics{10, 10, 3.5, 2.5, {}, {}, {}, {}, {}};
  config.T_color_depth = Pose{Eigen::Translation3d{-0.2, 0, 0}};  // 20 cm to the right: 2 pixels at 1 m
  auto source = open_rgbd_folder(folder.path(), config);
  ASSERT_TRUE(source) << source.error().to_string();
  const Frame frame = std::move(**(*source)->next());
  ASSERT_TRUE(frame.color && frame.color->width() == kWidth);
  for (int u = 0; u < kWidth; ++u) {
    EXPECT_EQ((*frame.color)(u, 3)[0], u < 2 ? 0 : 10 * (u - 2) + 10) << u;
  }
}

TEST(RgbdFolder, ReadsPrinceton) {
  const TempFolder folder;
  constexpr DepthEncoding kEncoding{10000.0, true};
  ASSERT_TRUE(
      write_png16(folder / "frame-000000.depth.png", encode_depth(DepthImage{kWidth, kHeight, 1.5F}, kEncoding)));
  ASSERT_TRUE(
      write_png16(folder / "frame-000001.depth.png", encode_depth(DepthImage{kWidth, kHeight, 1.5F}, kEncoding)));
  const std::string text =
      std::string{"# Color camera intrinsic matrix\n"} + kIntrinsics +
      "\n# Depth camera intrinsic matrix\n9 0 3\n0 9 2\n0 0 1\n\n# Camera-to-world extrinsic matrix "
      "(camera pose) for frame-000000\n" +
      kIdentity;
  folder.write("cam.info.txt", text);
  auto source = open_rgbd_folder(folder.path());
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->info().layout, RgbdLayout::princeton);
  EXPECT_EQ((*source)->info().encoding, kEncoding);
  EXPECT_EQ((*source)->camera().fx, 10.0);  // the colour camera's
  const auto all = outcomes(**source);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0], "1.5");
  EXPECT_NE(all[1].find("no pose"), std::string::npos);
  folder.write("cam.info.txt", "# Environment: shelf\n");
  EXPECT_NE(outcomes(folder.path()).front().find("Color camera"), std::string::npos);
}

std::ostream& operator<<(std::ostream& out, const struct RealFolder& folder);

struct RealFolder {
  const char* name;
  RgbdLayout layout;
  std::size_t frames;
  double fx;
};

std::ostream& operator<<(std::ostream& out, const RealFolder& folder) { return out << folder.name; }

class RealFrames : public testing::TestWithParam<RealFolder> {};

TEST_P(RealFrames, AllAreRead) {
  const fs::path folder = test::shared_data() / GetParam().name;
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  auto source = open_rgbd_folder(folder);
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_EQ((*source)->info().layout, GetParam().layout);
  EXPECT_EQ((*source)->size(), GetParam().frames);
  EXPECT_NEAR((*source)->camera().fx, GetParam().fx, 1e-3);
  std::size_t frames = 0;
  while (true) {
    auto frame = (*source)->next();
    ASSERT_TRUE(frame) << frame.error().to_string();
    if (!*frame) break;
    ++frames;
    ASSERT_TRUE((*frame)->color && (*frame)->T_world_camera);
    const auto& pixels = (*frame)->depth.pixels();
    const auto valid = std::count_if(pixels.begin(), pixels.end(), [](float d) { return d > 0.0F; });
    EXPECT_GT(valid, 640 * 480 / 10) << (*frame)->name;
  }
  EXPECT_EQ(frames, GetParam().frames);
}

INSTANTIATE_TEST_SUITE_P(Data, RealFrames,
                         testing::Values(RealFolder{"rgbd_redkitchen", RgbdLayout::seven_scenes, 200, 585.0},
                                         RealFolder{"rgbd_realsense_box", RgbdLayout::seven_scenes, 25, 615.195},
                                         RealFolder{"rgbd_eyeinhand_shelfA", RgbdLayout::princeton, 15, 611.686},
                                         RealFolder{"rgbd_open3d5/RGBD", RgbdLayout::open3d, 5, 525.0}),
                         [](const auto& folder) {
                           std::string name{folder.param.name};
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

}  // namespace
}  // namespace saccade
