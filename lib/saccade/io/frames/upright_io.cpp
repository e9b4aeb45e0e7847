// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/upright_io.hpp"

#include <sstream>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"

namespace saccade {
namespace {

Result<Eigen::Vector3d> read_gravity(const std::filesystem::path& path) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  std::istringstream words{text};
  words.imbue(std::locale::classic());
  Eigen::Vector3d gravity;
  std::string more;
  const bool three = static_cast<bool>(words >> gravity.x() >> gravity.y() >> gravity.z()) && !(words >> more);
  if (!three || !gravity.allFinite() || gravity.norm() < 1e-9) {
    return Error{Errc::corrupt_data, "is no direction: three numbers that point down, such as 0 0 -1", path.string()};
  }
  return gravity;
}

}  // namespace

Result<UprightFiles> read_upright_files(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::is_directory(path, ignored) ? path : path.parent_path();
  const auto is_there = [&](const char* name) { return std::filesystem::is_regular_file(folder / name, ignored); };
  UprightFiles files;
  if (is_there("gravity-direction.txt")) {
    SACCADE_TRY(files.gravity, read_gravity(folder / "gravity-direction.txt"));
  }
  if (is_there("trajectory.txt")) {
    SACCADE_TRY(const std::vector<StampedPose> trajectory, read_tum_trajectory(folder / "trajectory.txt"));
    for (const StampedPose& stamped : trajectory) files.T_world_cameras.push_back(stamped.T_world_camera);
  }
  return files;
}

}  // namespace saccade
