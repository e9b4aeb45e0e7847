// SPDX-License-Identifier: Apache-2.0
#pragma once
// project_discs: projects surfels into an image. fill_row: fills a row of the index image, in the camera's frame. For
// surfel_fusion.cpp.

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

/// Surfel that faces the camera, with the cell that its centre projects into.
struct ProjectedSurfel {
  std::uint32_t cell;  ///< row-major
  SurfelId id;
  float z;  ///< metres along the camera's axis
};

constexpr std::size_t kMaxProjected{64};

/// Projects up to kMaxProjected discs with consecutive ids from `first`. Returns the number that fall inside the image.
[[nodiscard]] std::size_t project_discs(const FloatView& view, std::span<const SurfelDisc> discs, SurfelId first,
                                        std::span<ProjectedSurfel, kMaxProjected> landings);

/// Fills row v of `cells` from the ids of its surfels, kNoSurfel where there is none. Neighbours in the image are far
/// apart in the map, so the row gathers them.
void fill_row(const FloatView& view, const SurfelMap& map, const SurfelId* ids, int v, SurfelCells& cells);

}  // namespace saccade
