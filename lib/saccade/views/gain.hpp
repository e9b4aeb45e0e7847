// SPDX-License-Identifier: Apache-2.0
#pragma once
// Gain: evaluates views. RayGain counts rays; RandomOrder ranks views at random.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/attention/region_of_interest.hpp"
#include "saccade/views/promise.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// View pose and its predicted gain.
struct RankedView {
  Pose T_world_camera{Pose::Identity()};
  double gain{std::numeric_limits<double>::quiet_NaN()};  ///< NaN: not evaluated
};

/// Views in the order in which to try them. Attempted ones may be among them.
struct RankedViews {
  std::vector<RankedView> views;
  std::size_t evaluated{0};  ///< poses whose gain was computed, or bounded by less than the best
  bool complete{true};       ///< false: more views remain once all of these were attempted
  bool by_gain{true};        ///< false: ordered otherwise, so that no threshold applies to gains
  double least_gain{0.0};    ///< views with a smaller gain are never worth taking, whatever the planner's threshold
  /// Voxels that a view is expected to make known, each with its share of the gain. Empty: unknown.
  std::function<Promise(const Pose& T_world_camera)> promise{};
};

/// Evaluation of views. One caller at a time. Gains depend on the context alone.
class Gain {
 public:
  virtual ~Gain() = default;
  /// Returns the expected gain of each pose in a region, in the unit of the implementation; larger is better.
  /// @return one value per pose, none of them NaN.
  [[nodiscard]] virtual Result<std::vector<double>> evaluate(const PlanningContext& context,
                                                             const RegionOfInterest& region,
                                                             std::span<const Pose> T_world_camera) = 0;
  /// Returns the best poses that were not attempted, at least `count` of them. This implementation sorts those of
  /// evaluate() by decreasing gain, ties in their order. Where the context knows the sensor, it first subtracts what
  /// CredibleRays does not believe. Answers size_mismatch when evaluate() returns a wrong number of values.
  [[nodiscard]] virtual Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                                 std::span<const Pose> T_world_camera, std::size_t count);
};

/// Returns where the poses of each camera centre begin, and finally the number of poses. Rolls of one direction follow
/// each other and share a centre, hence their visibility.
[[nodiscard]] std::vector<std::size_t> starts_of_centers(std::span<const Pose> T_world_camera);

/// Sorts by decreasing gain, ties in their order.
void order_by_gain(std::span<RankedView> views);

/// Whether promises are checked before they are believed.
enum class Trust : std::uint8_t {
  credible,  ///< reduces gains for failures of earlier views, and for rays that will give no return
  blind,     ///< leaves gains unchanged, as in the thesis
};

/// Gain that counts rays as evaluate_views does, on the context's device where that can.
class RayGain final : public Gain {
 public:
  explicit RayGain(const GainConfig& config, Trust trust = Trust::credible) : config_{config}, trust_{trust} {}
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// Returns the best poses that were not attempted, found by bounds first (docs/decisions/0010-footprints.md), and
  /// those that were attempted. Subtracts what CredibleRays does not believe, except with Trust::blind.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  /// Returns the gains that the context's device computes; nullopt: there is none, or it cannot.
  [[nodiscard]] std::optional<std::vector<double>> on_device(const PlanningContext& context,
                                                             const RegionOfInterest& region,
                                                             std::span<const Pose> T_world_camera) const;
  [[nodiscard]] Result<RankedViews> by_rays(const PlanningContext& context, const RegionOfInterest& region,
                                            std::span<const Pose> T_world_camera, std::size_t count);

  GainConfig config_;
  Trust trust_;
};

struct RandomOrderConfig {
  std::uint64_t seed{1};
  bool anew{false};  ///< true: a new order for every view; false: one for all views of a region
};

/// Poses in random order, whatever their gain: a baseline for choosing. A seed gives one order on every platform.
class RandomOrder final : public Gain {
 public:
  /// @param told  computes the gains to report for the next views
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
