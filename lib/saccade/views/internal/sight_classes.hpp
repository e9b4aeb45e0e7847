// SPDX-License-Identifier: Apache-2.0
#pragma once
// SightClasses: a StateVolume as rays see it that look for unknown voxels of a region.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

/// Class of a voxel on a ray.
enum class SightClass : std::uint8_t {
  passes,   ///< lets the ray pass: empty, or unknown and of no interest
  promise,  ///< unknown, in the region
  surface,  ///< occupied
  blocks,   ///< unknown, outside the region, where such voxels block
};

/// Classes of the voxels of a box, two bits each, so that those around a camera fit into a cache. Immutable.
class SightClasses {
 public:
  static constexpr int kPerWord{32};

  /// O(voxels).
  SightClasses(const StateVolume& volume, const Region& region, UnknownOutside outside, const Executor& executor);

  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] double voxel_size_m() const { return voxel_size_m_; }
  /// Strides of the places of voxels along x, y and z. Rows begin with a word.
  [[nodiscard]] const std::array<std::ptrdiff_t, 3>& strides() const { return strides_; }
  [[nodiscard]] SightClass at(std::size_t place) const {
    return static_cast<SightClass>(words_[place / kPerWord] >> (2 * (place % kPerWord)) & 3U);
  }
  /// Returns the voxel at a place.
  [[nodiscard]] Index3 voxel(std::size_t place) const;
  /// Returns words of kPerWord classes, the first in the lowest bits.
  [[nodiscard]] const std::uint64_t* words() const { return words_.data(); }

 private:
  IndexBox box_;
  double voxel_size_m_;
  std::array<std::ptrdiff_t, 3> strides_;
  std::vector<std::uint64_t> words_;
};

}  // namespace saccade
