// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of URDF files, and moves the arms that it accepts.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "saccade/arm/inverse_kinematics.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text{reinterpret_cast<const char*>(data), size};
  if (text.find("mesh") != std::string::npos) return 0;  // meshes are files; they have readers of their own
  const auto read = saccade::parse_urdf(text);
  if (!read) {
    if (read.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  saccade::IkConfig config;
  config.numeric.restarts = 1;
  const auto ik = saccade::InverseKinematics::create(read->arm, config);
  if (!ik) std::abort();
  const saccade::Pose T_world_camera = saccade::camera_pose(ik->arm(), ik->arm().middle());
  if (T_world_camera.matrix().allFinite()) static_cast<void>(ik->solve(T_world_camera));
  return 0;
}
