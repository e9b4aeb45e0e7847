// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_face_boxes: squares of faces projected many at a time, and the boxes around them in the image filled.

#include <array>
#include <cstdint>

#include "saccade/views/internal/entry_faces.hpp"

namespace saccade {

/// A camera as faces are projected into it. Pixel column = a · pixels_per_a − first_column.
struct FaceProjection {
  Index3 origin;
  std::array<float, 3> fraction;                 ///< of the origin, in its voxel
  std::array<std::array<float, 3>, 3> to_image;  ///< world → columns · depth, rows · depth, depth; depth in voxels
  float first_column;
  float first_row;
  int columns;
  int rows;
  float nearest_vox;  ///< faces count between these depths
  float farthest_vox;
  float margin_px;         ///< boxes are enlarged by this,
  float margin_px_by_vox;  ///< and by this divided by the depth
};

/// One bit per pixel. Each row has at least eight bytes more than its pixels need.
struct BitRaster {
  std::uint8_t* bytes;
  std::size_t stride;
};

/// Sets the pixels in the box around each square of a group that is entered from the camera's side, at depths that
/// count; all pixels where a square comes too close to be projected.
void draw_face_boxes(const FaceProjection& camera, const EntryFaces& faces, const FaceGroup& group,
                     const BitRaster& raster);

}  // namespace saccade
