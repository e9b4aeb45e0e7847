// SPDX-License-Identifier: Apache-2.0
#pragma once
// write_surfel_cloud: surfels as a point cloud with normals, radius, colour and confidence.

#include <filesystem>
#include <span>

#include "saccade/core/result.hpp"
#include "saccade/surfel/mode_store.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Writes one row per surfel (surfel_points), in the order of their ids: x, y, z, normal, radius (metres), confidence
/// (w_s of eq. 4.1), and 8-bit colour where any surfel has one (black for the others). PLY for names ending in .ply (nx
/// …, red …), otherwise binary PCD (normal_x …, rgb packed as in PCL).
/// @param modes  eq. 4.11 per surfel: positions and colours that replace the surfels' own where the weight is not 0.
/// Empty: the averages of eq. 4.12.
/// @param min_weight  surfels of a smaller w_s are left out.
/// Atomic. Answers size_mismatch unless there are as many modes as surfels, or none; errors as write_ply and write_pcd.
[[nodiscard]] Status write_surfel_cloud(const std::filesystem::path& path, const SurfelMap& map,
                                        std::span<const SurfelMode> modes = {}, double min_weight = 0.0);

}  // namespace saccade
