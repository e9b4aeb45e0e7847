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

/// Look-up of true segments. Immutable, cheap to copy, safe for concurrent use.
class TruthLabels {
 public:
  /// Answers unavailable when Embree does not start. O(triangles · log triangles).
  [[nodiscard]] static Result<TruthLabels> build(const RayScene& scene);

  /// Returns the names by label (SegmentTable); label 0 is nothing.
  [[nodiscard]] const std::vector<std::string>& names() const;
  /// Returns the segment of the nearest point of the scene's surface, or 0 where none is within beyond_m. Points inside
  /// another body, such as the table under a magazine, do not count; nor, where a normal is given, do surfaces that
  /// face the other way. Expects finite numbers. O(log triangles) and one ray per candidate.
  [[nodiscard]] std::uint16_t label(const Eigen::Vector3d& p_world, double beyond_m = 0.03,
                                    const std::optional<Eigen::Vector3d>& normal_world = {}) const;

 private:
  struct Impl;
  explicit TruthLabels(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace saccade
