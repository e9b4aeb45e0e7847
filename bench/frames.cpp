// SPDX-License-Identifier: Apache-2.0
#include "frames.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/sensor/analytic_scene.hpp"

namespace saccade::bench {
namespace {

constexpr std::size_t kFrames{60};

bool load_recorded(const std::filesystem::path& folder, Frames& frames) {
  RgbdFolderConfig config;
  config.count = kFrames;
  config.read_color = false;
  const auto source = open_rgbd_folder(folder, config);
  if (!source) return false;
  frames.camera = (*source)->camera();
  for (std::size_t i = 0; i < kFrames; ++i) {
    const auto frame = (*source)->next();
    if (!frame || !frame->has_value() || !(*frame)->T_world_camera) return false;
    frames.depth.push_back((*frame)->depth);
    frames.T_world_camera.push_back(*(*frame)->T_world_camera);
  }
  frames.recorded = true;
  return true;
}

Frames load() {
  Frames frames;
  const char* data = std::getenv("SACCADE_DATA");
  const std::filesystem::path folder =
      std::filesystem::path{data != nullptr ? data : "../shared/data"} / "rgbd_redkitchen";
  if (load_recorded(folder, frames)) return frames;
  std::fprintf(stderr, "%s: no frames there, the sample scene is used\n", folder.c_str());
  frames = {false, {640, 480, 525.0, 525.0, 319.5, 239.5, 0.3, 6.0}, {}, sample_trajectory(kFrames)};
  for (const Pose& T_world_camera : frames.T_world_camera) {
    frames.depth.push_back(render(sample_tabletop(), frames.camera, T_world_camera).value().depth);
  }
  return frames;
}

}  // namespace

Eigen::Vector3d Frames::seen_point() const {
  const DepthImage& first = depth.front();
  for (int v = camera.height / 2; v < camera.height; ++v) {
    for (int u = camera.width / 2; u < camera.width; ++u) {
      if (first(u, v) > 0.0F) return T_world_camera.front() * (camera.ray(u, v) * static_cast<double>(first(u, v)));
    }
  }
  return T_world_camera.front().translation();
}

const Frames& frames() {
  static const Frames loaded = load();
  return loaded;
}

const TsdfSnapshot& warm_map() {
  static const TsdfSnapshot map = [] {
    TsdfMap fused = TsdfMap::create({}).value();
    for (std::size_t i = 0; i < kWarmFrames; ++i) {
      const auto done = fused.integrate(frames().camera, frames().depth[i], frames().T_world_camera[i], {});
      SACCADE_EXPECTS(done.ok());
    }
    return fused.snapshot();
  }();
  return map;
}

}  // namespace saccade::bench
