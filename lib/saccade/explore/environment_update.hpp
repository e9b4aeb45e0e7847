// SPDX-License-Identifier: Apache-2.0
#pragma once
// Updates of an environment that a user has changed (Explorer::update): their defaults, and RegionMeter, which records
// the unknown share of each region. Thesis §2.2.

#include <span>
#include <string_view>
#include <vector>

#include "saccade/attention/region_of_interest.hpp"
#include "saccade/core/names.hpp"
#include "saccade/explore/recorder.hpp"

namespace saccade {

/// When frames are fused. Thesis §2.2.
enum class FuseWhen : std::uint8_t {
  viewpoints,  ///< KFOVP: while the camera oscillates at a view
  motion,      ///< KFOM: also on the way to a view, for which the arm moves more slowly
};
inline constexpr auto kFuseWhenNames =
    make_names<FuseWhen>({{FuseWhen::viewpoints, "viewpoints"}, {FuseWhen::motion, "motion"}});
[[nodiscard]] constexpr std::string_view to_string(FuseWhen when) { return kFuseWhenNames.of(when); }

/// Speed of an arm while frames are fused during the motion, as a share of its full speed. The thesis' arm took about
/// four times as long (Table 2.8).
constexpr double kSpeedWhileFusing{0.25};
/// Interval between frames that are fused during a motion, seconds.
constexpr double kFrameOnWay_s{0.1};
/// IncTh of Algorithm 1 for small regions around a hand: from 0.8 m a ball of 0.2 m fills about 3500 of the 160 × 120
/// rays that choose views.
constexpr double kUpdateMinGain{50.0};
/// The three regions of the thesis' second experiment took five views.
constexpr int kUpdateMaxViews{30};

/// Unknown voxels of each region.
using UnknownOfRegions = std::vector<std::size_t>;
/// Counts the unknown voxels of each region. O(voxels of the regions).
[[nodiscard]] UnknownOfRegions count_unknown(const TsdfSnapshot& map, std::span<const RegionOfInterest> regions);

/// Counts the unknown voxels of regions after each view.
class RegionMeter final : public Recorder {
 public:
  explicit RegionMeter(std::span<const RegionOfInterest> regions) : regions_{regions.begin(), regions.end()} {}
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;
  /// Returns one entry for each view so far.
  [[nodiscard]] const std::vector<UnknownOfRegions>& unknown() const { return unknown_; }

 private:
  std::vector<RegionOfInterest> regions_;
  std::vector<UnknownOfRegions> unknown_;
};

}  // namespace saccade
