// SPDX-License-Identifier: Apache-2.0
#pragma once
// Gain: what views are worth; RayGain counts rays, RandomOrder goes by chance.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/views/promise.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// A view pose and what it is predicted to gain.
struct RankedView {
  Pose T_world_camera{Pose::Identity()};
  double gain{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not evaluated
};

/// Views in the order in which they are to be tried. Attempted ones may be among them.
struct RankedViews {
  std::vector<RankedView> views;
  std::size_t evaluated{0};  ///< poses whose gain was determined, or bounded by less than the best
  bool complete{true};       ///< false: there are more once all of these were attempted
  bool by_gain{true};        ///< false: in another order, so that no threshold applies to gains
  double least_gain{0.0};    ///< views that gain less are not worth going to, whatever the planner asks for
  /// What a view is expected to make known; its worth is in proportion to the gain. Empty: that cannot be told.
  std::function<Promise(const Pose& T_world_camera)> promise{};
};

/// One caller at a time. Gains depend on the context alone.
class Gain {
 public:
  virtual ~Gain() = default;
  /// Expected gain of each pose in a region, in a unit of its own; larger is better.
  /// @return one value per pose, none of them NaN.
  [[nodiscard]] virtual Result<std::vector<double>> evaluate(const PlanningContext& context,
                                                             const RegionOfInterest& region,
                                                             std::span<const Pose> T_world_camera) = 0;
  /// The best poses that were not attempted, `count` of them or more. As it is here: those of evaluate() by decreasing
  /// gain, ties in their order, once what CredibleRays does not believe was taken off, if the context knows the sensor.
  /// size_mismatch when evaluate() returns another number of values than it got poses.
  [[nodiscard]] virtual Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                                 std::span<const Pose> T_world_camera, std::size_t count);
};

/// Returns where poses of another camera centre begin, and at last the number of poses: rolls of one direction follow
/// each other and share a centre, from which the same can be seen.
[[nodiscard]] std::vector<std::size_t> starts_of_centers(std::span<const Pose> T_world_camera);

/// The largest gain first, ties in their order.
void order_by_gain(std::span<RankedView> views);

/// Whether promises are looked into before they are believed.
enum class Trust : std::uint8_t {
  credible,  ///< gains shrink by what earlier views failed to show, and by rays from which no return will come
  blind,     ///< gains are what they are, as the thesis has it
};

/// Counts rays as evaluate_views does.
class RayGain final : public Gain {
 public:
  explicit RayGain(const GainConfig& config, Trust trust = Trust::credible) : config_{config}, trust_{trust} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// The best that were not attempted, found by bounds first (docs/decisions/0010-footprints.md), and those that were
  /// attempted. What CredibleRays does not believe is taken off, unless it is told to trust blindly.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] Result<RankedViews> by_rays(const PlanningContext& context, const RegionOfInterest& region,
                                            std::span<const Pose> T_world_camera, std::size_t count);

  GainConfig config_;
  Trust trust_;
};

struct RandomOrderConfig {
  std::uint64_t seed{1};
  bool anew{false};  ///< true: another order for every view; false: one for all views of a region
};

/// Poses in random order, whatever they gain: what choosing is worth. One seed gives one order, on every platform.
class RandomOrder final : public Gain {
 public:
  /// @param told  tells the gains of the views that come next
  RandomOrder(std::shared_ptr<Gain> told, RandomOrderConfig config) : told_{std::move(told)}, config_{config} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  std::shared_ptr<Gain> told_;
  RandomOrderConfig config_;
};

}  // namespace saccade
