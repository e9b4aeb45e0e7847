// SPDX-License-Identifier: Apache-2.0
#pragma once
// Credit: belief in a promise, based on how earlier views of that place kept theirs.

#include <span>
#include <vector>

#include "saccade/attention/attention_source.hpp"
#include "saccade/views/internal/state_volume.hpp"

namespace saccade {

/// Belief in promises. A voxel that is still unknown although an earlier view looks right at it was promised by that
/// view and not made known. A view from a similar direction would fail likewise: the promise gets at most the share
/// that the earlier view kept of its own. From elsewhere, where the voxel may be visible after all, half of the missed
/// share is subtracted. Immutable; safe for concurrent use.
class Credit {
 public:
  static constexpr double kSameSide{0.86602540378443865};  // cosine of 30°, at the voxel
  static constexpr double kElsewhere{0.5};                 // credit from elsewhere where the earlier view kept nothing
  static constexpr double kKept{0.9};                      // views that kept this share cause no discount

  /// The volume must outlive it. @param through_m unknown length with which lines of sight may begin.
  Credit(std::span<const CheckedView> checked, const PinholeCamera& sensor, const StateVolume& volume,
         double through_m);

  /// Tells whether no promise was broken.
  [[nodiscard]] bool is_full() const { return broken_.empty(); }

  /// Earlier views that have a voxel in sight, one bit each.
  using InSight = std::uint64_t;
  [[nodiscard]] InSight seen_from(std::size_t voxel) const;
  /// Returns the credit, in [0, 1], of the promise to show a place from a camera.
  [[nodiscard]] double of(const Eigen::Vector3d& place_m, InSight seen_from, const Eigen::Vector3d& camera_m) const;

 private:
  struct Broken {
    Pose T_camera_world;
    Eigen::Vector3d center_m;
    double kept_share;
  };
  std::vector<Broken> broken_;  ///< the latest 64
  PinholeCamera sensor_;
  const StateVolume* volume_;
  double through_m_;
};

}  // namespace saccade
