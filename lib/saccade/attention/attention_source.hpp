// SPDX-License-Identifier: Apache-2.0
#pragma once
// AttentionSource: regions to look at. WholeWorkspace and RegionsInTurn: sources that do not depend on what was seen.
// PlanningContext: the input of attention, view generators and gains while a view is chosen.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "saccade/attention/region_of_interest.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/phase_times.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

struct ExpectedSurface;
class ViewDevice;

/// View that was taken, and the share of its promise that it kept.
struct CheckedView {
  Pose T_world_camera{Pose::Identity()};
  double kept_share{1.0};  ///< in [0, 1]
};

struct PlanningContext {
  const TsdfSnapshot& map;
  const Executor& executor;
  PhaseTimes* times{nullptr};  ///< nullptr: times are not measured
  std::size_t region{0};       ///< RegionOfInterest::index of the region being explored
  std::size_t views_taken{0};  ///< views of that region so far
  /// Tells whether the camera went to the pose, or tried to, for this region. Empty: to none.
  std::function<bool(const Pose& T_world_camera)> attempted{};
  std::span<const CheckedView> checked{};  ///< views of the run that had a promise, of any region
  /// Field of view and range of a view, tilts included; nullopt: unknown, so promises cannot be computed.
  std::optional<PinholeCamera> sensor{};
  /// Renders the robot's own body in the image of a sensor. Empty: there is none, or it is unknown.
  std::function<Result<OwnBody>(const PinholeCamera& sensor)> own_body{};
  /// Place where parts of one choice share the expected surface of the map; nullptr: each computes it.
  std::shared_ptr<const ExpectedSurface>* expected{nullptr};
  ViewDevice* device{nullptr};  ///< computes gains and expected surface; nullptr: the CPU does

  [[nodiscard]] bool was_attempted(const Pose& T_world_camera) const { return attempted && attempted(T_world_camera); }

  /// Calls PhaseTimes::measure, where there are times.
  template <class Work>
  decltype(auto) measure(Phase phase, const Work& work) const {
    return times != nullptr ? times->measure(phase, work) : work();
  }
};

/// Source of regions worth exploring. One caller at a time. Its result depends on the context alone, so that a run can
/// be resumed.
class AttentionSource {
 public:
  virtual ~AttentionSource() = default;
  /// @return the regions, most salient first; empty where nothing draws attention.
  [[nodiscard]] virtual Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) = 0;
};

/// The map's workspace as one region.
class WholeWorkspace final : public AttentionSource {
 public:
  /// @return invalid_argument for a map without a workspace.
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;
};

/// Given regions, one after the other. Each is left when none of its views is worth taking, and not visited again.
class RegionsInTurn final : public AttentionSource {
 public:
  explicit RegionsInTurn(std::span<const RegionOfInterest> regions);
  explicit RegionsInTurn(std::span<const Region> bounds);
  [[nodiscard]] Result<std::vector<RegionOfInterest>> regions(const PlanningContext& context) override;

 private:
  std::vector<RegionOfInterest> regions_;
};

}  // namespace saccade
