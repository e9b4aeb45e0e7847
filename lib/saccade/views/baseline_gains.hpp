// SPDX-License-Identifier: Apache-2.0
#pragma once
// BaselineGainConfig, volumetric_gain, surface_edge_gain, projection_gain: gains of other authors, for comparison.
// Sources, equations and deviations: docs/design/baselines.md.

#include <memory>

#include "saccade/core/names.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/views/gain.hpp"

namespace saccade {

/// Value of a voxel along a ray: the metrics that Delmerico, Isler, Sabzevari and Scaramuzza compare (2018), and the
/// area factor of Vasquez-Gomez et al. (2014).
enum class VolumetricInformation : std::uint8_t {
  occlusion_aware,    ///< entropy times the likelihood that the voxel is visible
  unobserved_voxel,   ///< entropy of unknown voxels times that likelihood
  rear_side_voxel,    ///< rays that meet an occupied voxel directly behind an unknown one: the rear side of a surface
  rear_side_entropy,  ///< visible entropy of the unknown voxels in front of such a rear side
  proximity_count,    ///< unknown voxels, weighted by their proximity to an occupied one
  average_entropy,    ///< mean entropy of the voxels along rays that end on a surface
  area_factor,        ///< closeness of the shares of occupied and unknown voxels seen to the desired ones
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
  int columns_px{64};            ///< columns of rays, or of pixels in projections, across the field of view
  double object_margin_m{0.05};  ///< voxels count up to this far from the box around the objects seen so far

  /// Answers invalid_argument for a bad sensor, tilt, number of columns or margin.
  [[nodiscard]] Status validate() const;
};

/// Sums information along rays. A ray ends at the first occupied voxel, and at the latest where it leaves the box of
/// counted voxels; the space outside the workspace is transparent. A camera in a voxel that is not empty, or below the
/// objects, sees nothing. best() examines only the most promising poses closely. Expects a valid configuration. Its
/// evaluate() answers invalid_argument for a pose that is not finite, with its index, and for too large a workspace.
/// The thread count never changes a bit. O(voxels of the workspace + rays).
[[nodiscard]] std::shared_ptr<Gain> volumetric_gain(VolumetricInformation information,
                                                    const BaselineGainConfig& config);

/// Counts the frontier points that a view shows: points where the density of observed surface falls off beside unknown
/// space. After the Surface Edge Explorer (Border and Gammell 2024). Errors and threads: volumetric_gain.
/// O(surface voxels + camera centres · frontier points · voxels between).
[[nodiscard]] std::shared_ptr<Gain> surface_edge_gain(const BaselineGainConfig& config);

/// Counts the pixels in which an ellipsoid around frontier voxels is nearer than all around occupied ones. After PB-NBV
/// (Jia, Li, Hao and Zhang 2025). Errors and threads: volumetric_gain. O(voxels of the workspace + poses · pixels
/// covered).
[[nodiscard]] std::shared_ptr<Gain> projection_gain(const BaselineGainConfig& config);

}  // namespace saccade
