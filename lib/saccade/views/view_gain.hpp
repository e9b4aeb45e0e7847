// SPDX-License-Identifier: Apache-2.0
#pragma once
// GainConfig, GainResult and evaluate_views: the expected information gain of view poses in a region; order_views:
// poses by decreasing gain.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// What is counted.
enum class GainCount : std::uint8_t {
  rays,             ///< rays that end in an unknown voxel of the region: the thesis' knowledge map
  distinct_voxels,  ///< the unknown voxels in which they end, each once
};
inline constexpr auto kGainCountNames =
    make_names<GainCount>({{GainCount::rays, "rays"}, {GainCount::distinct_voxels, "voxels"}});

/// What unknown voxels outside the region do to a ray.
enum class UnknownOutside : std::uint8_t {
  blocks,       ///< they stop it, as in the thesis
  transparent,  ///< it goes on: an upper bound of what the view may show
};
inline constexpr auto kUnknownOutsideNames =
    make_names<UnknownOutside>({{UnknownOutside::blocks, "blocks"}, {UnknownOutside::transparent, "transparent"}});

/// Work that need not be done. None of these changes a gain; each can be switched off to check that.
struct GainSavings {
  bool region_rays{true};     ///< cast only rays that meet the region's unknown voxels
  bool region_exit{true};     ///< stop a ray where it leaves the region
  bool empty_bricks{true};    ///< pass over empty bricks
  bool blocked_camera{true};  ///< decide a pose at once when its camera is in a voxel that is not empty
  bool shared_lattice{true};  ///< cast the rays that several poses have in common once (rolls; latitude 90°)
  bool exposed_voxels{true};  ///< heed only voxels that a ray can come to: with a neighbour that does not stop it
  bool tiles{true};           ///< go through empty, solid and wholly unknown space with whole tiles of rays
  bool packets{true};         ///< walk the rays that tiles leave over many at a time; only with all of the above
  bool footprints{true};      ///< cast only rays that pass a face by which a voxel that scores can be entered

  [[nodiscard]] static GainSavings none() { return {false, false, false, false, false, false, false, false, false}; }
};

struct GainConfig {
  /// The virtual sensor; 640×480, f = 525 px, 0.5–6 m.
  PinholeCamera sensor{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0};
  double tilt_rad{0.0};  ///< the real sensor is tilted by ± this angle: see widened_vertically
  GainCount count{GainCount::rays};
  UnknownOutside unknown_outside{UnknownOutside::blocks};
  GainSavings savings{};

  /// invalid_argument for a bad sensor, or a tilt that is negative or opens the view to 180°.
  [[nodiscard]] Status validate() const;
};

struct GainResult {
  std::vector<std::uint64_t> gains;  ///< one per pose, in their order
  std::uint64_t rays_total{0};       ///< pixels of all poses
  std::uint64_t rays_cast{0};        ///< rays walked one by one
  double prepare_ms{0.0};            ///< turning the map into what rays meet
  double evaluate_ms{0.0};
  std::string backend;  ///< of the executor: what ran the loops
};

/// Gain of each view pose in a region: the rays of the virtual sensor whose first non-empty voxel is unknown and inside
/// the region.  Thesis §2.2.3, eq. (2.6), (2.10), (2.11), Algorithm 2 lines 4–12; design §4.
///
/// A voxel is inside when contains(region, its centre): strictly within a sphere, half-open in a box. A ray starts at
/// the camera's centre and ends at the sensor's maximum range along z; the depth of a voxel is where the ray enters
/// it. What a ray meets nearer than the minimum range blocks it and scores nothing; a camera in a voxel that is not
/// empty sees nothing. Voxels outside the map's workspace are transparent. Rays: see SensorRays.
/// @param T_world_camera camera → world, rigid.
/// @return one gain per pose; invalid_argument for a bad region, sensor or pose (with its index), or when range and
///         region hold too many voxels to tabulate; cancelled when progress says so.
/// O(bricks between cameras and region + rays that meet it · bricks along them). The map is only read. The same gains
/// for every thread count.
[[nodiscard]] Result<GainResult> evaluate_views(const TsdfSnapshot& map, const Region& region,
                                                std::span<const Pose> T_world_camera, const GainConfig& config,
                                                const Executor& executor, const Progress& progress = {});

/// A view pose, its gain, and its index among the candidates.
struct OrderedView {
  std::size_t index{0};
  std::uint64_t gain{0};
  Pose T_world_camera{Pose::Identity()};
};

/// All poses by decreasing gain, ties by increasing index (OrderViewpointsAndGains, thesis Algorithm 2 line 13).
/// `gains` and `T_world_camera` have the same length. O(n log n).
[[nodiscard]] std::vector<OrderedView> order_views(std::span<const std::uint64_t> gains,
                                                   std::span<const Pose> T_world_camera);

}  // namespace saccade
