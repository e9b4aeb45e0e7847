// SPDX-License-Identifier: Apache-2.0
#pragma once
// update_environment: what a user may have changed is forgotten and looked at again. Thesis §2.2, Algorithm 1.

#include <optional>
#include <span>
#include <vector>

#include "saccade/attention/region_of_interest.hpp"
#include "saccade/explore/exploration.hpp"

namespace saccade {

/// When frames are fused. Thesis §2.2.
enum class FuseWhen : std::uint8_t {
  viewpoints,  ///< KFOVP: while the camera oscillates at a view
  motion,      ///< KFOM: on the way to a view as well, for which the arm moves more slowly
};
[[nodiscard]] std::string_view to_string(FuseWhen when);

/// Share of its speed that an arm has while frames are fused on the way. The thesis' arm took about four times as long
/// (Table 2.8).
constexpr double kSpeedWhileFusing{0.25};
/// Between frames that are fused on the way, seconds.
constexpr double kFrameOnWay_s{0.1};
/// IncTh of Algorithm 1 for regions as small as those of a hand: from 0.8 m a ball of 0.2 m fills about 3500 of the 160
/// × 120 rays that views are chosen with.
constexpr double kUpdateMinGain{50.0};
/// The three regions of the thesis' second experiment took five.
constexpr int kUpdateMaxViews{30};

/// Unknown voxels of each region.
using UnknownOfRegions = std::vector<std::size_t>;

/// How the robot came back to its stand-by.
struct Return {
  bool at_stand_by{false};
  std::optional<Refusal> refusal{};  ///< why not, where there was no way
  double motion_s{0.0};              ///< what the way takes a real arm
};

struct UpdateResult {
  double forgetting_ms{0.0};            ///< of all regions
  UnknownOfRegions unknown_after_task;  ///< as soon as they were forgotten
  ExplorationResult exploration;
  std::vector<UnknownOfRegions> unknown_after_view;
  Return back;
};

/// As explore() takes them.
[[nodiscard]] std::vector<Region> bounds_of(std::span<const RegionOfInterest> regions);

/// Of every region. O(their voxels).
[[nodiscard]] UnknownOfRegions count_unknown(const TsdfSnapshot& map, std::span<const RegionOfInterest> regions);

/// Lines 1 to 3 of Algorithm 1. Errors: invalid_argument for a bad region; those before it were forgotten then.
[[nodiscard]] Status forget_around(TsdfMap& map, std::span<const RegionOfInterest> regions);

/// Robots without a stand-by stay where they are. Errors: those of the robot.
[[nodiscard]] Result<Return> return_to_stand_by(const TsdfMap& map, Robot& robot, const Executor& executor);

/// Algorithm 1: forgets around every region, explores one after the other, and returns to stand-by. What was seen of a
/// region on the way to others is not looked at again. An update that a hook or progress stops leaves the robot where
/// it stands.
/// @return errors of explore() and of the robot; invalid_argument for a bad region.
[[nodiscard]] Result<UpdateResult> update_environment(TsdfMap& map, ExplorationCell& cell,
                                                      std::span<const RegionOfInterest> regions,
                                                      const Strategy& strategy, const ExplorationConfig& config,
                                                      const Executor& executor, const ExplorationHooks& hooks = {},
                                                      const Progress& progress = {});

}  // namespace saccade
