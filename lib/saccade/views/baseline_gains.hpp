// SPDX-License-Identifier: Apache-2.0
#pragma once
// BaselineGainConfig, volumetric_gain, surface_edge_gain, projection_gain: gains of other authors, to compare with.
// Sources, equations and deviations: docs/baselines.md.

#include <memory>

#include "saccade/core/names.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/views/gain.hpp"

namespace saccade {

/// What a voxel along a ray is worth: the metrics that Delmerico, Isler, Sabzevari and Scaramuzza compare (2018), and
/// the area factor of Vasquez-Gomez et al. (2014).
enum class VolumetricInformation : std::uint8_t {
  occlusion_aware,    ///< entropy times the likelihood that the voxel is visible
  unobserved_voxel,   ///< entropy of unknown voxels times that likelihood
  rear_side_voxel,    ///< rays that meet an occupied voxel right behind an unknown one: a surface from its rear
  rear_side_entropy,  ///< visible entropy of the unknown voxels in front of such a rear side
  proximity_count,    ///< unknown voxels, the more the nearer they are to an occupied one
  average_entropy,    ///< mean entropy of the voxels along rays that end on a surface
  area_factor,        ///< how near the shares of occupied and of unknown voxels seen are to those wished for
};
inline constexpr auto kVolumetricInformationNames = make_names<VolumetricInformation>({
    {VolumetricInformation::occlusion_aware, "occlusion-aware"},
    {VolumetricInformation::unobserved_voxel, "unobserved-voxel"},
    {VolumetricInformation::rear_side_voxel, "rear-side-voxel"},
    {VolumetricInformation::rear_side_entropy, "rear-side-entropy"},
    {VolumetricInformation::proximity_count, "proximity-count"},
    {VolumetricInformation::average_entropy, "average-entropy"},
    {VolumetricInformation::area_factor, "area-factor"},
});

struct BaselineGainConfig {
  PinholeCamera sensor{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0};  ///< field of view and range
  double tilt_rad{0.0};          ///< the real sensor is tilted by ± this angle: see widened_vertically
  int columns_px{64};            ///< rays, or pixels of projections, across the field of view
  double object_margin_m{0.05};  ///< voxels count up to this far from the box around the objects seen so far

  /// invalid_argument for a bad sensor, tilt, number of columns or margin.
  [[nodiscard]] Status validate() const;
};

/// Sums information along rays. A ray goes to the first occupied voxel and no farther than the box in which voxels
/// count; the space outside the workspace is transparent. A camera sees nothing in a voxel that is not empty, nor from
/// below the objects. best() looks closely at the most promising poses alone.
/// Expects a valid configuration. Its evaluate() returns invalid_argument for a pose that is not finite, with its
/// index, and for too large a workspace; the thread count never changes a bit. O(voxels of the workspace + rays).
[[nodiscard]] std::shared_ptr<Gain> volumetric_gain(VolumetricInformation information,
                                                    const BaselineGainConfig& config);

/// Counts the frontier points that a view shows: where the density of observed surface falls off beside unknown space.
/// After the Surface Edge Explorer (Border and Gammell 2024). Errors and threads: volumetric_gain.
/// O(surface voxels + camera centres · frontier points · voxels between).
[[nodiscard]] std::shared_ptr<Gain> surface_edge_gain(const BaselineGainConfig& config);

/// Pixels in which an ellipsoid around frontier voxels is nearer than all around occupied ones. After PB-NBV (Jia, Li,
/// Hao and Zhang 2025). Errors and threads: volumetric_gain. O(voxels of the workspace + poses · pixels covered).
[[nodiscard]] std::shared_ptr<Gain> projection_gain(const BaselineGainConfig& config);

}  // namespace saccade
