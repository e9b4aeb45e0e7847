// SPDX-License-Identifier: Apache-2.0
#pragma once
// reading_of: options of a device's program for reading an arm's description, named as in saccade.

#include <algorithm>
#include <string>
#include <vector>

#include "protocol.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/angle.hpp"

namespace saccade::devices {

inline UrdfConfig reading_of(const devices::Options& options) {
  UrdfConfig config;
  config.base = options.text("--base");
  config.tip = options.text("--tip");
  config.camera = options.text("--camera-frame");
  if (const std::string package = options.text("--package"); !package.empty()) {
    const std::size_t equals = std::min(package.find('='), package.size() - 1);
    config.packages[package.substr(0, equals)] = package.substr(equals + 1);
  }
  if (const std::vector<double> at = options.numbers("--base-at"); at.size() >= 3) {
    config.T_world_base = Eigen::Translation3d{at[0], at[1], at[2]} *
                          Eigen::AngleAxisd{to_rad(at.size() > 3 ? at[3] : 0.0), Eigen::Vector3d::UnitZ()};
  }
  return config;
}

}  // namespace saccade::devices
