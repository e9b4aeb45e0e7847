// SPDX-License-Identifier: Apache-2.0
#pragma once
// Strategy: where to look next; GainFunction: what a view is worth. Those of the library, and the seams for one's own.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/robot/refusal.hpp"
#include "saccade/view/view_gain.hpp"
#include "saccade/view/view_sphere.hpp"

namespace saccade {

struct ObjectAttention;

/// Expected gain of each pose in a region, in a unit of its own; larger is better. One value per pose, none of them
/// NaN.
using GainFunction = std::function<Result<std::vector<double>>(
    const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera, const Executor& executor)>;

/// Counts rays as evaluate_views does.
[[nodiscard]] GainFunction ray_gain(const GainConfig& config);

/// The same field of view and range with `width_px` pixels across: choosing among views needs fewer rays than seeing.
/// Expects 1 ≤ width_px ≤ the camera's width.
[[nodiscard]] PinholeCamera coarser(const PinholeCamera& camera, int width_px);

/// A view to be tried.
struct Proposal {
  Pose T_world_camera{Pose::Identity()};
  double gain{0.0};  ///< as predicted; NaN: not evaluated
};

/// Views in the order in which they are to be tried.
struct Proposals {
  std::vector<Proposal> views;
  bool by_gain{true};              ///< false: chosen without regard to gain, so that no threshold applies
  bool complete{true};             ///< false: the strategy has more to propose once all of these were attempted
  std::size_t candidates{0};       ///< poses that were thought of, those that the robot cannot take included
  std::size_t evaluated{0};        ///< of those, the ones whose gain was determined, or bounded by less than the best
  RefusalCounts refused{};         ///< of those that the robot was asked about
  std::optional<Region> gained{};  ///< what gains are of; nullopt: the situation's region
  std::optional<std::uint32_t> segment{};              ///< of `attention`, that the views are of
  std::shared_ptr<const ObjectAttention> attention{};  ///< what drew it, of a strategy that looks for objects
  double candidates_ms{0.0};                           ///< spent on making candidates,
  double segmentation_ms{0.0};                         ///< on the surface in segments,
  double saliency_ms{0.0};                             ///< on what these are worth,
  double reachability_ms{0.0};  ///< on asking the robot; the rest of the time was spent on judging candidates
};

/// For each pose why the robot cannot take it, nullopt where it may: Robot::test.
using PoseTest = std::function<std::vector<std::optional<Refusal>>(std::span<const Pose> T_world_camera)>;

/// What a strategy decides on.
struct Situation {
  const TsdfSnapshot& map;
  const Region& region;
  std::size_t region_index{0};
  std::size_t views_of_region{0};  ///< taken so far
  const Executor& executor;
  /// Asking costs microseconds per pose, less than casting its rays. Empty: every pose may be taken. A strategy need
  /// not ask: what the robot cannot take is passed over later too.
  PoseTest test{};
  /// Whether the pose was gone to, or tried, for this region. Empty: none was.
  std::function<bool(const Pose& T_world_camera)> attempted{};
  double min_gain{0.0};  ///< below which no view is worth going to

  /// Whether the robot would go to this view if it found a way.
  [[nodiscard]] bool is_worth_trying(const Proposal& view) const {
    return view.gain >= min_gain && !(attempted && attempted(view.T_world_camera));
  }
};

/// Decides where to look next. Asked again after every view; views that were taken or could not be reached are passed
/// over by the one who asks. What it proposes depends on the situation alone, so that a run can be resumed.
class Strategy {
 public:
  virtual ~Strategy() = default;
  /// @return views of the region, the best first; none: there is nothing more to see in it.
  [[nodiscard]] virtual Result<Proposals> propose(const Situation& situation) const = 0;
};

/// Candidates on a view sphere around the region's centre that the robot may take, by decreasing gain, ties by index:
/// NextBestView of thesis Algorithm 2.
class SphereStrategy final : public Strategy {
 public:
  SphereStrategy(ViewSphereConfig sphere, GainFunction gain) : sphere_{std::move(sphere)}, gain_{std::move(gain)} {}
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  ViewSphereConfig sphere_;
  GainFunction gain_;
};

/// The same candidates in random order, whatever they gain: what choosing is worth. A region is left after
/// `views_per_region` views. One seed gives one order, whatever was asked before. Gains are only told of the views
/// that come next.
class RandomStrategy final : public Strategy {
 public:
  RandomStrategy(ViewSphereConfig sphere, GainFunction gain, std::size_t views_per_region, std::uint64_t seed)
      : sphere_{std::move(sphere)}, gain_{std::move(gain)}, views_per_region_{views_per_region}, seed_{seed} {}
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  ViewSphereConfig sphere_;
  GainFunction gain_;
  std::size_t views_per_region_;
  std::uint64_t seed_;
};

}  // namespace saccade
