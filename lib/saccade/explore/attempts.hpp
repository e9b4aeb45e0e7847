// SPDX-License-Identifier: Apache-2.0
#pragma once
// Attempts: where the camera went, or could not go, for each region of a run.

#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/explore/view_record.hpp"

namespace saccade {

/// Remembers poses by region. Poses that differ by rounding are the same: one that was written to a file and read again
/// is still known.
class Attempts {
 public:
  Attempts() = default;
  /// Begins with the views of a run that goes on.
  explicit Attempts(std::span<const ViewRecord> views);

  void add_view(const ViewRecord& view);
  /// The robot cannot take these poses.
  void add_refused(std::size_t region, std::span<const RankedView> views, Refusal refusal);
  /// The caller does not want this pose.
  void add_skipped(std::size_t region, const Pose& T_world_camera);

  /// Whether the camera went to the pose, or tried to, for this region.
  [[nodiscard]] bool contains(std::size_t region, const Pose& T_world_camera) const;
  /// Whether the robot could not take it.
  [[nodiscard]] bool was_refused(std::size_t region, const Pose& T_world_camera) const;
  /// Views taken of the region.
  [[nodiscard]] std::size_t views_of(std::size_t region) const;
  /// Views that promised something that could be checked, in their order.
  [[nodiscard]] std::span<const CheckedView> checked() const { return checked_; }
  /// Refusals for the region since the last view.
  [[nodiscard]] RefusalCounts refusals_of(std::size_t region) const;

 private:
  struct Attempt {
    std::size_t region;
    Pose T_world_camera;
    enum class Outcome : std::uint8_t { taken, refused, skipped } outcome;
  };
  std::vector<Attempt> attempts_;
  std::vector<CheckedView> checked_;
  std::vector<std::pair<std::size_t, RefusalCounts>> refusals_;  ///< by region, since the last view
};

}  // namespace saccade
