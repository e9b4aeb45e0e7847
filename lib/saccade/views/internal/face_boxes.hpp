// SPDX-License-Identifier: Apache-2.0
#pragma once
// draw_face_boxes: projects many squares of faces at a time, and fills their bounding boxes in the image.

#include <array>
#include <cstdint>

#include "saccade/views/internal/entry_faces.hpp"

namespace saccade {

/// Camera for the projection of faces. Pixel column = a · pixels_per_a − first_column.
struct FaceProjection {
  Index3 origin;
  std::array<float, 3> fraction;                 ///< position of the origin in its voxel
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

/// Raster of one bit per pixel. Each row has at least eight bytes more than its pixels need.
struct BitRaster {
  std::uint8_t* bytes;
  std::size_t stride;
};

/// Sets the pixels in the bounding box of each square of a group that is entered from the camera's side and lies at
/// counted depths. Sets all pixels where a square is too close for projection.
void draw_face_boxes(const FaceProjection& camera, const EntryFaces& faces, const FaceGroup& group,
                     const BitRaster& raster);

}  // namespace saccade
