// SPDX-License-Identifier: Apache-2.0
#pragma once
// RangeImage: distances along the rays of one depth image, and the pyramid that bounds them over rectangles.

#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_math.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// How far a rectangle of beams is seen. A voxel nearer than `clear_m` is seen free (sample 1) in every beam of it that
/// saw something; one farther than `reach_m` is seen in none.
struct BeamBounds {
  float clear_m{0.0F};
  float reach_m{0.0F};
  float nearest_m{0.0F};  ///< least range; 0: some beam saw nothing
};

/// Rectangle of pixels, inclusive.
struct PixelRect {
  int u0{0};
  int v0{0};
  int u1{-1};
  int v1{-1};
};

/// Depths turned into ranges ‖p − o‖ (eq. 2.1), 0 where there is no valid return, negative for "free up to", with a
/// min/max pyramid over blocks of 4×4, 8×8, … pixels. Building is O(pixels), a query looks at ≤ 49 cells.
class RangeImage {
 public:
  RangeImage(const PinholeCamera& camera, const DepthImage& depth, double truncation_m, const Executor& executor);

  [[nodiscard]] const tsdf::FusionCamera& camera() const { return camera_; }
  [[nodiscard]] const float* ranges() const { return ranges_.data(); }
  [[nodiscard]] std::size_t valid_pixels() const { return valid_pixels_; }
  /// Upper bound of the reach over the whole image.
  [[nodiscard]] float max_reach_m() const;
  /// Conservative bounds over all pixels of `rect`, which must lie within the image.
  [[nodiscard]] BeamBounds bounds(const PixelRect& rect) const;

 private:
  struct Level {
    int shift;  ///< a cell covers 2^shift pixels
    int width;
    int height;
    std::vector<BeamBounds> cells;
  };
  /// An empty level of cells of 2^shift pixels; the sizes are those of the level below it, or of the image.
  [[nodiscard]] static Level level(int shift, int fine_width, int fine_height);
  void build_pyramid();

  tsdf::FusionCamera camera_;
  std::vector<float> ranges_;
  std::size_t valid_pixels_{0};
  std::vector<Level> levels_;
};

}  // namespace saccade
