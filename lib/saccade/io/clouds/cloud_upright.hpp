// SPDX-License-Identifier: Apache-2.0
#pragma once
// upright_hints_of, upright_of: which way is up in the cloud of a file.

#include "saccade/cloud/upright.hpp"
#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade {

/// Tells an organized PCD, and a PCD's viewpoint where it is turned: that of a camera that was held upright.
[[nodiscard]] UprightHints upright_hints_of(const CloudFile& file);
/// find_upright with these hints and `up`, where it is stated.
[[nodiscard]] Upright upright_of(const CloudFile& file, std::span<const Eigen::Vector3f> positions_m,
                                 const std::optional<Eigen::Vector3d>& up = {});

}  // namespace saccade
