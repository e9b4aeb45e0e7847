// SPDX-License-Identifier: Apache-2.0
#pragma once
// met_voxels: walks along rays to the unknown voxels that they promise.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/views/internal/sight_classes.hpp"

namespace saccade {

/// Ray from a camera to the end of its range.
struct SightRay {
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;

  [[nodiscard]] Eigen::Vector3d at(double share) const { return from_m + share * (to_m - from_m); }
};

/// The first voxel of class `promise` that a ray meets, before any that stops it.
struct MetVoxel {
  std::size_t place{0};  ///< in the SightClasses
  double share{0.0};     ///< along the ray
  bool returns{false};   ///< whether a surface lies behind it

  [[nodiscard]] bool operator==(const MetVoxel&) const = default;
};

/// Place on a ray, and the way to the next voxels.
class SightLine {
 public:
  /// Starts at the ray's first voxel within the box of the classes; nullopt where the ray does not pass it.
  /// @param past_region share of the ray beyond which no promise lies
  [[nodiscard]] static std::optional<SightLine> start(const SightClasses& classes, const SightRay& ray,
                                                      double past_region);
  /// Walks to the end. O(voxels).
  [[nodiscard]] std::optional<MetVoxel> walk(const SightClasses& classes);

 private:
  friend struct SightLines;
  /// Looks at the voxel; returns whether the line ends there.
  bool look(SightClass seen);
  /// Goes on to the next voxel; returns false at the end.
  bool advance();

  std::size_t place_{0};  ///< the voxel's place in the SightClasses
  double share_{0.0};     ///< share of the ray at which the voxel is entered
  double end_{0.0};       ///< share of the ray at which the box or the ray ends
  double past_region_{0.0};
  std::array<double, 3> next_{};        ///< share at which the next plane across each axis is passed
  std::array<double, 3> between_{};     ///< share between planes
  std::array<std::int64_t, 3> move_{};  ///< change of the place at the next plane
  std::array<std::int64_t, 3> left_{};  ///< voxels to the border
  std::optional<MetVoxel> met_;
};

/// Returns what rays meet, as SightLine::walk does, several rays at a time. O(voxels along them).
/// @param around_region box outside which no voxel is a promise; rays that pass it by meet nothing
[[nodiscard]] std::vector<std::optional<MetVoxel>> met_voxels(const SightClasses& classes, const Box& around_region,
                                                              std::span<const SightRay> rays);
/// As met_voxels(), one ray at a time.
[[nodiscard]] std::optional<MetVoxel> met_voxel(const SightClasses& classes, const Box& around_region,
                                                const SightRay& ray);

}  // namespace saccade
