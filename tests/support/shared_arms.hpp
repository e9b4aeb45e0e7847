// SPDX-License-Identifier: Apache-2.0
#pragma once
// The URDFs among the recorded data, with what their meshes and roundings need.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "saccade/arm/urdf.hpp"
#include "support/places.hpp"

namespace saccade::test {

inline std::filesystem::path shared_robots() { return shared_data() / "robots"; }

inline std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

inline std::filesystem::path shared_comau_folder() { return shared_robots() / "comau_smart_six" / "data" / "urdf"; }

/// The Comau of the thesis, its meshes named where they are: convex hulls in a folder of their own.
inline std::string shared_comau_urdf() {
  std::string urdf = text_of_file(shared_comau_folder() / "comau_nolimits_nobase_chull.urdf");
  urdf = replaced(urdf, "meshes/stl/", "meshes/stl/convex_hull/");
  return replaced(urdf, "meshes/dae/axes_6.dae", "meshes/stl/convex_hull/axes_6.stl");
}

/// Its arm up to the flange; `exact` makes its 1.57 and 1.57079 the right angles that they stand for.
inline Result<UrdfArm> shared_comau(bool exact, UrdfConfig config = {}) {
  std::string urdf = shared_comau_urdf();
  if (exact) {
    urdf = replaced(urdf, "rpy=\"0 -1.57 0\"", "rpy=\"0 -1.5707963267948966 0\"");
    urdf = replaced(urdf, "rpy=\"0 1.57079 0\"", "rpy=\"0 1.5707963267948966 0\"");
  }
  if (config.tip.empty()) config.tip = "axes_6";
  return parse_urdf(urdf, shared_comau_folder(), config);
}

inline Result<UrdfArm> shared_panda() {
  return read_urdf(shared_robots() / "franka_panda" / "robots" / "panda_arm.urdf");
}

/// Reads the arm with its hand, the camera at the tool's frame.
inline Result<UrdfArm> shared_panda_hand() {
  UrdfConfig config;
  config.tip = "panda_link8";
  config.camera = "tool_link";
  return read_urdf(shared_robots() / "franka_panda" / "robots" / "panda_arm_hand.urdf", config);
}

inline Result<UrdfArm> shared_iiwa(const std::string& collision = "primitive") {
  const std::filesystem::path folder = shared_robots() / "iiwa14" / "urdf";
  const std::string urdf = text_of_file(folder / ("iiwa14_" + collision + "_collision.urdf"));
  return parse_urdf(replaced(urdf, "package://drake_models/iiwa_description/", "../"), folder);
}

}  // namespace saccade::test
