// SPDX-License-Identifier: Apache-2.0
#include "server/show/stand_upright.hpp"

#include "saccade/io/frames/upright_io.hpp"

namespace saccade::server {

Status stand_upright(SceneDocument& document, const std::filesystem::path& path,
                     std::span<const Eigen::Vector3f> points, UprightHints hints, bool may_guess) {
  SACCADE_TRY(const UprightFiles files, read_upright_files(path));
  if (!hints.gravity) hints.gravity = files.gravity;
  if (hints.T_world_cameras.empty()) hints.T_world_cameras = files.T_world_cameras;
  const bool has_hints = hints.up || hints.gravity || hints.is_organized || !hints.T_world_cameras.empty();
  if (!has_hints && !may_guess) return {};
  const Upright upright = find_upright(points, hints);
  document.up = upright.up;
  document.towards_viewer = upright.towards_viewer;
  return {};
}

}  // namespace saccade::server
