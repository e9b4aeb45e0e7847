// SPDX-License-Identifier: Apache-2.0
#pragma once
// project_discs: where surfels are in an image; fill_row: what fills a row of the index image, in the camera's frame.
// For surfel_fusion.cpp.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "saccade/surfel/internal/surfel_cells.hpp"
#include "saccade/surfel/surfel_association.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Camera and pose in single precision.
struct FloatView {
  explicit FloatView(const SurfelAssociation& seen)
      : R_camera_world{seen.T_world_camera.linear().transpose().cast<float>()},
        center_world{seen.T_world_camera.translation().cast<float>()},
        fx{static_cast<float>(seen.camera.fx)},
        fy{static_cast<float>(seen.camera.fy)},
        cx{static_cast<float>(seen.camera.cx)},
        cy{static_cast<float>(seen.camera.cy)},
        width{seen.camera.width},
        height{seen.camera.height} {}

  Eigen::Matrix3f R_camera_world;
  Eigen::Vector3f center_world;
  float fx, fy, cx, cy;
  int width, height;
};

/// A surfel that faces the camera, in the cell that its centre projects into.
struct Landing {
  std::uint32_t cell;  ///< row-major
  SurfelId id;
  float z;  ///< metres along the camera's axis
};

constexpr std::size_t kMostLandings{64};

/// Of at most kMostLandings discs, whose ids are `first` and on; returns how many land in the image.
[[nodiscard]] std::size_t project_discs(const FloatView& view, std::span<const SurfelDisc> discs, SurfelId first,
                                        std::span<Landing, kMostLandings> landings);

/// Row v of `cells` from the ids of its surfels, kNoSurfel where there is none: what lies side by side in the image is
/// far apart in the map.
void fill_row(const FloatView& view, const SurfelMap& map, const SurfelId* ids, int v, SurfelCells& cells);

}  // namespace saccade
