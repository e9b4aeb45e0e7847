// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/frame_check.hpp"

#include <string>

namespace saccade {

Status check_frame(const PinholeCamera& camera, const DepthImage& depth, const Pose& T_world_camera,
                   const ColorImage* color) {
  SACCADE_CHECK(camera.validate());
  const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
  if (depth.width() != camera.width || depth.height() != camera.height) {
    return Error{Errc::size_mismatch,
                 "the depth image is " + size(depth.width(), depth.height()) + ", the camera " +
                     size(camera.width, camera.height),
                 {}};
  }
  if (color != nullptr && (color->width() != camera.width || color->height() != camera.height)) {
    return Error{Errc::size_mismatch,
                 "the colour image is " + size(color->width(), color->height()) + ", the camera " +
                     size(camera.width, camera.height),
                 {}};
  }
  if (const auto checked = pose_from_matrix(T_world_camera.matrix()); !checked) return checked.error();
  if (T_world_camera.translation().cwiseAbs().maxCoeff() > 1000.0) {
    return Error{Errc::invalid_argument, "the camera lies farther than 1000 m from the origin", {}};
  }
  return {};
}

}  // namespace saccade
