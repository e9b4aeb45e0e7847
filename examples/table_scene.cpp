// SPDX-License-Identifier: Apache-2.0
// Writes a posed RGB-D sequence of a made-up table, what make demo starts from: example_table_scene OUT [FRAMES]
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <span>
#include <string>

#include "saccade/io/atomic_file.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/io/trajectory_io.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/noise.hpp"

namespace {

saccade::Image16 millimetres(const saccade::DepthImage& depth) {
  saccade::Image16 out{depth.width(), depth.height()};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    out.data()[i] = static_cast<std::uint16_t>(std::lround(1000.0F * depth.data()[i]));
  }
  return out;
}

saccade::Status write_sequence(const std::filesystem::path& folder, std::size_t frames) {
  const saccade::PinholeCamera camera;  // Kinect v1
  const saccade::AnalyticScene scene = saccade::sample_tabletop();
  const saccade::Executor executor = saccade::Executor::with_threads(0);
  std::size_t frame = 0;
  for (const saccade::Pose& T_world_camera : saccade::sample_trajectory(frames)) {
    SACCADE_TRY(const auto image, saccade::render(scene, camera, T_world_camera, executor));
    const auto stem = (folder / ("frame-" + std::to_string(1000000 + frame).substr(1))).string();
    const saccade::DepthImage measured = saccade::with_noise(image.depth, saccade::DepthNoise{}, frame);
    SACCADE_CHECK(saccade::write_png16(stem + ".depth.png", millimetres(measured)));
    SACCADE_CHECK(saccade::write_png(stem + ".color.png", image.color));
    SACCADE_CHECK(saccade::write_matrices(stem + ".pose.txt", std::span{&T_world_camera, 1}));
    ++frame;
  }
  return saccade::write_file_atomically(folder / "camera-intrinsics.txt",
                                        std::string_view{"525 0 319.5\n0 525 239.5\n0 0 1\n"});
}

}  // namespace

int main(int argc, char** argv) {
  const long frames = argc == 3 ? std::strtol(argv[2], nullptr, 10) : 60;
  if (argc < 2 || argc > 3 || frames < 1) {
    std::cerr << "usage: example_table_scene OUT [FRAMES]\n";
    return 2;
  }
  std::error_code error;
  std::filesystem::create_directories(argv[1], error);
  const saccade::Status written = write_sequence(argv[1], static_cast<std::size_t>(frames));
  if (!written) {
    std::cerr << written.error().to_string() << '\n';
    return 3;
  }
  std::cout << frames << " frames in " << argv[1] << '\n';
}
