// SPDX-License-Identifier: Apache-2.0
#pragma once
// GainConfig, GainResult and evaluate_views: the expected information gain of view poses in a region; NoGain: why all
// of them gain nothing; order_views: poses by decreasing gain.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Quantity that a gain counts.
enum class GainCount : std::uint8_t {
  rays,             ///< rays that end in an unknown voxel of the region: the thesis' knowledge map
  distinct_voxels,  ///< the unknown voxels in which these rays end, each once
};
inline constexpr auto kGainCountNames =
    make_names<GainCount>({{GainCount::rays, "rays"}, {GainCount::distinct_voxels, "voxels"}});

/// Effect of unknown voxels outside the region on a ray.
enum class UnknownOutside : std::uint8_t {
  blocks,       ///< they stop it, as in the thesis
  transparent,  ///< it continues: an upper bound of what the view may show
};
inline constexpr auto kUnknownOutsideNames =
    make_names<UnknownOutside>({{UnknownOutside::blocks, "blocks"}, {UnknownOutside::transparent, "transparent"}});

/// Savings of work. None of them changes a gain; each can be switched off to check that.
struct GainSavings {
  bool region_rays{true};     ///< cast only rays that meet the region's unknown voxels
  bool region_exit{true};     ///< stop a ray where it leaves the region
  bool empty_bricks{true};    ///< skip empty bricks
  bool blocked_camera{true};  ///< reject a pose at once when its camera is in a voxel that is not empty
  bool shared_lattice{true};  ///< cast rays that several poses have in common only once (rolls; latitude 90°)
  bool exposed_voxels{true};  ///< consider only voxels that a ray can reach: with a neighbour that does not stop it
  bool tiles{true};           ///< traverse empty, solid and entirely unknown space with whole tiles of rays
  bool packets{true};         ///< walk many of the rays that tiles leave over at a time; requires all of the above
  bool footprints{true};      ///< cast only rays through a face by which a scoring voxel can be entered

  [[nodiscard]] static GainSavings none() { return {false, false, false, false, false, false, false, false, false}; }
};

struct GainConfig {
  /// Virtual sensor; 640×480, f = 525 px, 0.5–6 m.
  PinholeCamera sensor{640, 480, 525.0, 525.0, 319.5, 239.5, 0.5, 6.0};
  double tilt_rad{0.0};  ///< the real sensor is tilted by ± this angle: see widened_vertically
  GainCount count{GainCount::rays};
  UnknownOutside unknown_outside{UnknownOutside::blocks};
  GainSavings savings{};

  /// Answers invalid_argument for a bad sensor, or a tilt that is negative or opens the view to 180°.
  [[nodiscard]] Status validate() const;
};

/// Why no pose of an evaluation gains anything.
enum class NoGain : std::uint8_t {
  some_gain,           ///< at least one pose gains something
  no_poses,            ///< there was no pose to evaluate
  outside_workspace,   ///< the region lies outside the map's workspace, where nothing counts as unknown
  nothing_unknown,     ///< every voxel of the region is known
  out_of_range,        ///< every camera is farther from the region than its longest ray
  cameras_in_unknown,  ///< every camera within range stands in an unknown voxel, where its rays end
  cameras_blocked,     ///< every camera within range stands in a voxel that is not empty, some of them occupied
  out_of_sight,        ///< rays end at other voxels, or pass the region by
};

/// Says what a reason means and what to do about it, in one sentence without a full stop.
[[nodiscard]] std::string_view advice(NoGain reason);

struct GainResult {
  std::vector<std::uint64_t> gains;   ///< one per pose, in their order
  NoGain no_gain{NoGain::some_gain};  ///< the reason where every gain is 0
  std::uint64_t rays_total{0};        ///< pixels of all poses
  std::uint64_t rays_cast{0};         ///< rays walked one by one
  double prepare_ms{0.0};             ///< time to prepare the map for ray casting
  double evaluate_ms{0.0};
  std::string backend;  ///< back end of the executor that ran the loops
};

/// Computes the gain of each view pose in a region: the rays of the virtual sensor whose first non-empty voxel is
/// unknown and inside the region. Thesis §2.2.3, eq. (2.6), (2.10), (2.11), Algorithm 2 lines 4–12; design §4.
///
/// A voxel is inside when contains(region, its centre): strictly within a sphere, half-open in a box. A ray starts at
/// the camera's centre and ends at the sensor's maximum range along z; the depth of a voxel is where the ray enters it.
/// A voxel met nearer than the minimum range blocks the ray and scores nothing; a camera in a voxel that is not empty
/// sees nothing. Voxels outside the map's workspace are transparent. Rays: see SensorRays.
/// @param T_world_camera camera → world, rigid.
/// @return one gain per pose; invalid_argument for a bad region, sensor or pose (with its index), or when range and
/// region hold too many voxels to tabulate; cancelled when progress requests it.
/// O(bricks between cameras and region + rays that meet it · bricks along them). The map is only read. The thread count
/// never changes a gain.
[[nodiscard]] Result<GainResult> evaluate_views(const TsdfSnapshot& map, const Region& region,
                                                std::span<const Pose> T_world_camera, const GainConfig& config,
                                                const Executor& executor, const Progress& progress = {});

/// A view pose, its gain, and its index among the candidates.
struct OrderedView {
  std::size_t index{0};
  std::uint64_t gain{0};
  Pose T_world_camera{Pose::Identity()};
};

/// Sorts all poses by decreasing gain, ties by increasing index (OrderViewpointsAndGains, thesis Algorithm 2 line 13).
/// `gains` and `T_world_camera` have equal lengths. O(n log n).
[[nodiscard]] std::vector<OrderedView> order_views(std::span<const std::uint64_t> gains,
                                                   std::span<const Pose> T_world_camera);

}  // namespace saccade
