// SPDX-License-Identifier: Apache-2.0
// The seeds of the fuzz targets must be valid: a seed that is refused at once teaches the fuzzer nothing.
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>

#include "saccade/arm/urdf.hpp"
#include "saccade/devices/internal/joint_messages.hpp"
#include "saccade/devices/internal/process_messages.hpp"
#include "saccade/io/clouds/internal/kitti_io.hpp"
#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/clouds/internal/npy_cloud.hpp"
#include "saccade/io/clouds/las_io.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/clouds/surfel_array.hpp"
#include "saccade/io/clouds/text_cloud.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/depth_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/azure_kinect.hpp"
#include "saccade/io/frames/internal/calibration.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "saccade/io/sessions/label_presets.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Calls accepts(content, file name) for each seed and returns how many there were.
template <class Accepts>
std::size_t check_seeds(const char* name, Accepts accepts) {
  std::size_t seeds = 0;
  for (const auto& entry : fs::directory_iterator{test::source_folder() / "tests/fuzz/corpus" / name}) {
    const auto content = read_text_file(entry.path());
    EXPECT_TRUE(content && accepts(*content, entry.path().filename().string())) << entry.path();
    ++seeds;
  }
  return seeds;
}

TEST(FuzzCorpus, SeedsAreAccepted) {
  EXPECT_GE(check_seeds("image",
                        [](const std::string& content, const std::string& name) {
                          return name.ends_with(".bin") || decode_color(as_byte_span(content)).ok();
                        }),
            9U);
  EXPECT_GE(check_seeds("ply", [](const auto& content, const auto&) { return parse_ply(as_byte_span(content)).ok(); }),
            3U);
  EXPECT_GE(check_seeds("stl", [](const auto& content, const auto&) { return parse_stl(content).ok(); }), 2U);
  EXPECT_GE(check_seeds("obj", [](const auto& content, const auto&) { return parse_obj(content).ok(); }), 1U);
  EXPECT_GE(check_seeds("off", [](const auto& content, const auto&) { return parse_off(content).ok(); }), 1U);
  EXPECT_GE(check_seeds("pcd", [](const auto& content, const auto&) { return parse_pcd(as_byte_span(content)).ok(); }),
            3U);
  EXPECT_GE(check_seeds("text_cloud",
                        [](const std::string& content, const auto&) {
                          const auto bytes = as_byte_span(content);
                          return parse_text_cloud({bytes.begin(), bytes.end()}).ok();
                        }),
            5U);
  EXPECT_GE(check_seeds("kitti",
                        [](const std::string& content, const std::string& name) {
                          const auto bytes = as_byte_span(content);
                          return name == "scan.bin" ? parse_kitti_scan(bytes).ok() : parse_kitti_labels(bytes).ok();
                        }),
            2U);
  EXPECT_GE(check_seeds("npy",
                        [](const auto& content, const std::string& name) {
                          const std::span<const std::byte> bytes = as_byte_span(content);
                          return name == "surfels.npy" ? decode_surfels(bytes).ok() : parse_npy(bytes).ok();
                        }),
            4U);
  EXPECT_GE(
      check_seeds(
          "las",
          [](const std::string& content, const std::string& name) {
            const auto bytes = as_byte_span(content);
            return name.ends_with(".npy") ? parse_npy_cloud(bytes).ok() : parse_las({bytes.begin(), bytes.end()}).ok();
          }),
      4U);
  EXPECT_GE(check_seeds("poses", [](const auto& content, const auto&) { return parse_pose_list(content).ok(); }), 8U);
  EXPECT_GE(check_seeds("depth_image", [](const std::string& content,
                                          const auto&) { return decode_depth_image(as_byte_span(content), {}).ok(); }),
            5U);
  EXPECT_GE(check_seeds("calibration",
                        [](const std::string& content, const std::string& name) {
                          if (name == "info.txt") return parse_sensor_info(content).ok();
                          if (name == "azure_kinect.json") return parse_azure_kinect_calibration(content).ok();
                          if (name.ends_with(".json")) return parse_bop_cameras(content).ok();
                          return parse_opencv_camera(content).ok() && parse_local_transform(content)->has_value();
                        }),
            3U);
  EXPECT_GE(check_seeds("camera",
                        [](const std::string& content, const std::string& name) {
                          if (name == "cam.info.txt") return parse_cam_info(content).ok();
                          if (name == "polygons.json") return parse_polygons(content).ok();
                          return parse_intrinsics(content).ok();
                        }),
            6U);
  EXPECT_GE(check_seeds("hand_trajectory",
                        [](const std::string& content, const std::string&) {
                          const int format = content[0] % 4;
                          const std::string text = content.substr(1);
                          if (format == 3) return parse_hand_labels(text).ok();
                          return parse_hand_trajectory(text, static_cast<HandFormat>(format)).ok();
                        }),
            5U);
  EXPECT_GE(check_seeds("scene", [](const auto& content, const auto&) { return parse_scene(content).ok(); }), 3U);
  EXPECT_GE(check_seeds("urdf", [](const auto& content, const auto&) { return parse_urdf(content).ok(); }), 3U);
  EXPECT_GE(check_seeds("annotation_journal",
                        [](const std::string& content, const std::string&) {
                          const auto saved = decode_journal(as_byte_span(content).subspan(1));
                          return saved && saved->actions.size() > 3;
                        }),
            2U);
  EXPECT_GE(
      check_seeds("label_presets", [](const auto& content, const auto&) { return parse_label_presets(content).ok(); }),
      2U);
  EXPECT_GE(check_seeds("process_message",
                        [](const std::string& content, const std::string& name) {
                          const std::string line = content.substr(0, content.find('\n'));
                          if (name.starts_with("camera")) return parse_camera_hello(line).ok();
                          if (name == "capture") return parse_capture_answer(line, 0, 16, Pose::Identity()).ok();
                          if (name == "joint") return parse_joint_answer(line, 6).ok();
                          if (name == "sample") return parse_sample_answer(line, 0).ok();
                          const auto move = parse_move_answer(line, 0, Pose::Identity());
                          return name == "error" ? move.error().code == Errc::unavailable : move.ok();
                        }),
            8U);
}

}  // namespace
}  // namespace saccade
