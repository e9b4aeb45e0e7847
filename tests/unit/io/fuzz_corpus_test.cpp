// SPDX-License-Identifier: Apache-2.0
// The seeds of the fuzz targets must be valid: a seed that is refused at once teaches the fuzzer nothing.
#include <gtest/gtest.h>

#include <filesystem>

#include "saccade/io/camera_io.hpp"
#include "saccade/io/file_io.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/io/pcd_io.hpp"
#include "saccade/io/ply_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Calls accepts(content, file name) for each seed and returns how many there were.
template <class Accepts>
std::size_t check_seeds(const char* name, Accepts accepts) {
  std::size_t seeds = 0;
  for (const auto& entry : fs::directory_iterator{fs::path{SACCADE_SOURCE_DIR} / "tests/fuzz/corpus" / name}) {
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
  EXPECT_GE(check_seeds("pcd", [](const auto& content, const auto&) { return parse_pcd(as_byte_span(content)).ok(); }),
            3U);
  EXPECT_GE(check_seeds("poses", [](const auto& content, const auto&) { return parse_pose_list(content).ok(); }), 5U);
  EXPECT_GE(check_seeds("camera",
                        [](const std::string& content, const std::string& name) {
                          if (name == "cam.info.txt") return parse_cam_info(content).ok();
                          if (name == "polygons.json") return parse_polygons(content).ok();
                          return parse_intrinsics(content).ok();
                        }),
            6U);
}

}  // namespace
}  // namespace saccade
