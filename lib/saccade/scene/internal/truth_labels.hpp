// SPDX-License-Identifier: Apache-2.0
#pragma once
// TruthLabels: the true segment of a point near the surfaces of a scene, such as a surfel.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Immutable, cheap to copy, safe for concurrent use.
class TruthLabels {
 public:
  /// unavailable when Embree does not start. O(triangles · log triangles).
  [[nodiscard]] static Result<TruthLabels> build(const RayScene& scene);

  /// Names by label (SegmentTable); label 0 is nothing.
  [[nodiscard]] const std::vector<std::string>& names() const;
  /// The segment of the nearest point of the scene's surface, or 0 where none is within beyond_m. What lies inside
  /// another body, such as the table under a magazine, does not count; nor, where a normal is given, what looks the
  /// other way. Expects finite numbers. O(log triangles) and a ray for each candidate.
  [[nodiscard]] std::uint16_t label(const Eigen::Vector3d& p_world, double beyond_m = 0.03,
                                    const std::optional<Eigen::Vector3d>& normal_world = {}) const;

 private:
  struct Impl;
  explicit TruthLabels(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace saccade
