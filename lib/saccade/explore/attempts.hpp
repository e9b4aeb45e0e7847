// SPDX-License-Identifier: Apache-2.0
#pragma once
// Attempts: poses that the camera took, or could not take, for each region of a run.

#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/explore/view_record.hpp"

namespace saccade {

/// Poses by region. Poses that differ by rounding are equal, so a pose is recognised after it was written to a file and
/// read again. They are the poses that were asked for, wherever a real robot arrived.
///
/// The promise of a view is checked by fewer rays than its gain counts. Where none of them finds what is promised,
/// Credit has nothing to go by, and every roll of the camera would promise the same again. Such a view stands for all
/// rolls.
class Attempts {
 public:
  Attempts() = default;
  /// Begins with the views of a resumed run.
  explicit Attempts(std::span<const ViewRecord> views);

  void add_view(const ViewRecord& view);
  /// Records poses that the robot cannot take.
  void add_refused(std::size_t region, std::span<const RankedView> views, Refusal refusal);
  /// Records a pose that the caller does not want.
  void add_skipped(std::size_t region, const Pose& T_world_camera);

  /// Tells whether the camera took the pose, or tried to, for this region; or took another roll of it whose promise
  /// could not be checked.
  [[nodiscard]] bool contains(std::size_t region, const Pose& T_world_camera) const;
  /// Tells whether the robot could not take it.
  [[nodiscard]] bool was_refused(std::size_t region, const Pose& T_world_camera) const;
  /// Returns the number of views taken of the region.
  [[nodiscard]] std::size_t views_of(std::size_t region) const;
  /// Returns the views with a promise that could be checked, in their order.
  [[nodiscard]] std::span<const CheckedView> checked() const { return checked_; }
  /// Returns the refusals for the region since the last view.
  [[nodiscard]] RefusalCounts refusals_of(std::size_t region) const;

 private:
  struct Attempt {
    std::size_t region;
    Pose T_world_camera;
    enum class Outcome : std::uint8_t { taken, refused, skipped } outcome;
    bool all_rolls{false};  ///< the promise could not be checked
  };
  std::vector<Attempt> attempts_;
  std::vector<CheckedView> checked_;
  std::vector<std::pair<std::size_t, RefusalCounts>> refusals_;  ///< by region, since the last view
};

}  // namespace saccade
