// SPDX-License-Identifier: Apache-2.0
#pragma once
// RayInformation: information gained by one ray, and by all rays of a view, in one metric of VolumetricInformation.

#include <cmath>
#include <cstddef>

#include "saccade/views/baseline_gains.hpp"

namespace saccade {

/// Probabilities of occupancy. A TSDF stores none, so each state has one. Empty voxels are certain: otherwise 0.8 m of
/// known empty space in voxels of 6 mm would hide the space behind.
constexpr double kUnknownOccupancy{0.5};
constexpr double kOccupiedOccupancy{0.97};  ///< clamping value of OctoMap

/// Returns the entropy of a voxel in nats; 0 for certain ones.
[[nodiscard]] inline double occupancy_entropy(double p) {
  if (p <= 0.0 || p >= 1.0) return 0.0;
  return -p * std::log(p) - (1.0 - p) * std::log(1.0 - p);
}

/// Rates a share x of voxels of one kind where `wished` is best: 0 at 0 and 1, 1 at `wished`, smooth and cubic on
/// either side. Vasquez-Gomez et al. 2014.
[[nodiscard]] inline double share_rating(double x, double wished) {
  const double a = wished;
  if (x <= a) return (-2.0 * x / a + 3.0) * (x / a) * (x / a);
  const double below = 1.0 / ((a - 1.0) * (a - 1.0) * (a - 1.0));
  return below * (-2.0 * x * x * x + 3.0 * (a + 1.0) * x * x - 6.0 * a * x + 3.0 * a - 1.0);
}
constexpr double kWishedOccupied{0.2};
constexpr double kWishedOccplane{0.8};
/// Share of a view's rays that must touch counted voxels, since a handful can have any shares by chance. Where no view
/// has as many, the share is of the rays through the counted box: a small object in a wide image.
constexpr double kLeastTouched{0.1};

/// Information along rays. It receives the voxels along each ray in order, without empty ones; voxels that do not count
/// only affect visibility. The metric is chosen at compile time.
template <VolumetricInformation kMetric>
class RayInformation {
 public:
  /// Begins the next ray through the counted box.
  void begin_ray() {
    in_box_ += 1.0;
    visible_ = 1.0;
    run_ = 0.0;
    entropy_ = 0.0;
    met_ = false;
  }
  /// @param counts       false: nearer than the range, or outside the counted voxels
  /// @param beside_empty the ray came from an empty voxel
  /// @param proximity    d_max − d where an occupied voxel is at d < d_max, else 0
  /// @return whether the ray can stop
  bool meet_unknown(bool counts, bool adjacent, bool beside_empty, double proximity) {
    using enum VolumetricInformation;
    if constexpr (kMetric == area_factor) {
      if (counts) ++(beside_empty ? occplane_ : unmark_);
      return true;
    }
    if constexpr (kMetric == proximity_count) sum_ += counts ? proximity : 0.0;
    if constexpr (kMetric == average_entropy) entropy_ += counts ? kUnknownEntropy : 0.0;
    if constexpr (kMetric == occlusion_aware || kMetric == unobserved_voxel) {
      sum_ += counts ? visible_ * kUnknownEntropy : 0.0;
    }
    if constexpr (kMetric == rear_side_entropy || kMetric == rear_side_voxel) {
      if (!adjacent) run_ = 0.0;
      run_ += counts ? visible_ * kUnknownEntropy : 0.0;
      met_ = counts;
    }
    visible_ *= 1.0 - kUnknownOccupancy;
    return (kMetric == occlusion_aware || kMetric == unobserved_voxel) && visible_ < kInvisible;
  }
  /// @param after_unknown  the voxel before it on the ray is unknown
  /// @param voxels         counted voxels along the ray up to this one
  void meet_occupied(bool counts, bool after_unknown, double voxels) {
    using enum VolumetricInformation;
    if (!counts) return;
    if constexpr (kMetric == area_factor) ++occupied_;
    if constexpr (kMetric == occlusion_aware) sum_ += visible_ * kOccupiedEntropy;
    if constexpr (kMetric == rear_side_voxel) sum_ += after_unknown && met_ ? 1.0 : 0.0;
    if constexpr (kMetric == rear_side_entropy) sum_ += after_unknown && met_ ? run_ : 0.0;
    if constexpr (kMetric == average_entropy) {
      sum_ += entropy_ + kOccupiedEntropy;
      voxels_ += voxels;
    }
  }
  [[nodiscard]] double rays_in_box() const { return in_box_; }
  /// Returns the information of all rays; `rays` is the number of which enough must touch counted voxels.
  [[nodiscard]] double value([[maybe_unused]] double rays) const {
    using enum VolumetricInformation;
    if constexpr (kMetric == average_entropy) return voxels_ > 0.0 ? sum_ / voxels_ : 0.0;
    if constexpr (kMetric == area_factor) {
      const double all = occupied_ + occplane_ + unmark_;
      if (all == 0.0 || all < kLeastTouched * rays) return 0.0;
      return share_rating(occupied_ / all, kWishedOccupied) + share_rating(occplane_ / all, kWishedOccplane);
    }
    return sum_;
  }

 private:
  static constexpr double kInvisible{1e-9};
  static inline const double kUnknownEntropy = occupancy_entropy(kUnknownOccupancy);
  static inline const double kOccupiedEntropy = occupancy_entropy(kOccupiedOccupancy);
  double in_box_{0.0};   ///< rays through the counted box
  double visible_{1.0};  ///< likelihood that the ray reaches this point
  double run_{0.0};      ///< visible entropy of the unknown voxels passed without a gap
  double entropy_{0.0};  ///< sum over the voxels of this ray
  bool met_{false};      ///< whether the last unknown voxel counts
  double sum_{0.0};
  double voxels_{0.0};
  double occupied_{0.0};  ///< rays that end on each kind of voxel
  double occplane_{0.0};
  double unmark_{0.0};
};

}  // namespace saccade
