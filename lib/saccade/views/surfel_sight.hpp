// SPDX-License-Identifier: Apache-2.0
#pragma once
// surfel_sight: lines of sight to expected surface among surfels, seen and unknown ones.

#include "saccade/views/lines_of_sight.hpp"
#include "saccade/views/unknown_surfels.hpp"

namespace saccade {

struct SurfelSightConfig {
  UnknownSurfelConfig unknown{};
  /// Pixels along the edges of the panorama's faces, each of which spans 90°.
  int edge_px{160};
  /// The heaviest of the seen surfels in each cell of this share of a voxel of free space is rendered, as a disc that
  /// covers the cell: surfels of neighbouring pixels hide the same.
  double cell_share{0.25};

  /// Answers invalid_argument for bad unknown surfels, an edge outside 1 to 4096, or a share outside (0, 1].
  [[nodiscard]] Status validate() const;
};

/// Returns lines of sight by rendering surfels around each place. A point is in sight if, at its pixel, the nearest
/// seen surfel lies at most a voxel of free space before it, and the nearest unknown surfel at most through_m and a
/// voxel. A point in whose voxel surfels were seen is not: there is nothing left to see. Depths are measured along the
/// axis of the panorama's face. Where views are ranked by surface_gain, this renders what Monica and Aleotti (RA-L
/// 2018) render, for a place instead of a pose.
/// @param surfels read whenever sight is made; must outlive it
/// Errors: those of SurfelSightConfig::validate. O(surfels log surfels), and O(discs towards the points) per place. The
/// thread count never changes a bit.
[[nodiscard]] MakeSight surfel_sight(const SurfelMap& surfels, const SurfelSightConfig& config = {});

}  // namespace saccade
