// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_mesh, mesh_picture: a triangle mesh through a software depth buffer.

#include "saccade/core/executor.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/report/viewpoint.hpp"

namespace saccade {

class Canvas;

struct MeshPictureConfig {
  bool use_colors{true};  ///< the mesh's own, where it has them
  int samples{2};         ///< per pixel and direction
  Rgb8 background{236, 239, 243};
};

/// Adds the mesh to the canvas, shaded by its normals (by its faces where it has none). Triangles that reach behind the
/// camera are left out. The thread count does not change the picture. O(triangles + covered pixels).
void draw_mesh(Canvas& canvas, const TriangleMesh& mesh, const Executor& executor,
               const MeshPictureConfig& config = {});

/// The mesh alone.
[[nodiscard]] ColorImage mesh_picture(const TriangleMesh& mesh, const Viewpoint& view, const Executor& executor,
                                      const MeshPictureConfig& config = {});

}  // namespace saccade
