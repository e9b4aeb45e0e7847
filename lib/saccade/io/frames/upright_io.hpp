// SPDX-License-Identifier: Apache-2.0
#pragma once
// UprightFiles, read_upright_files: what files beside a scene tell about which way is up. docs/reference/formats.md.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct UprightFiles {
  std::optional<Eigen::Vector3d> gravity{};  ///< gravity-direction.txt: three numbers, pointing down
  std::vector<Pose> T_world_cameras{};       ///< trajectory.txt: TUM lines
};

/// Looks in a folder, or in the folder that a file lies in. A file that is not there tells nothing.
/// @return corrupt_data for a gravity-direction.txt that is not three finite numbers, not all zero; the errors of
///         read_tum_trajectory.
[[nodiscard]] Result<UprightFiles> read_upright_files(const std::filesystem::path& path);

}  // namespace saccade
