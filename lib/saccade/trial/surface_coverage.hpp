// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfaceCoverage: the share of an object's surface that a sequence of views has measured, as published protocols
// count it: by voxels, or by the distance of surface points from measured points.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/scene/ray_scene.hpp"

namespace saccade {

/// Rule for what counts as measured.
struct CoverageRule {
  enum class Kind {
    voxels,    ///< a voxel that holds surface, once it holds a measured point
    distance,  ///< a point of the surface, once a view from its outer side measured a point at most this far from it
  };
  Kind kind{Kind::distance};
  double size_m{0.005};     ///< edge of a voxel, or the distance
  double spacing_m{0.002};  ///< distance between points of the surface: one per spacing_m²

  /// Answers invalid_argument for lengths that are not positive, and voxels smaller than the spacing.
  [[nodiscard]] Status validate() const;
};

/// Shares of the parts (voxels or points) of the surface that were measured, within [0, 1].
struct CoverageShares {
  double of_visible{0.0};  ///< share of those that some candidate view sees
  double of_all{0.0};
};

/// The surface of a scene's objects, supports excluded, and which of its parts a set of candidate views can see.
/// Immutable, cheap to copy. Measurements are exact: the depth of every pixel of a view, without noise, so that a view
/// is known by its pose alone.
class SurfaceCoverage {
 public:
  /// Samples the surface. Points inside another object do not count. A point is visible when it lies in the image and
  /// the range of a candidate view and no surface is between; a voxel, when one of its points is. Without candidates
  /// the visible points are those of observable(). Answers invalid_argument for a bad rule, and for a scene without
  /// objects. O(points · candidates · log triangles) at most.
  [[nodiscard]] static Result<SurfaceCoverage> build(const RayScene& scene, const PinholeCamera& camera,
                                                     std::span<const Pose> candidates, const CoverageRule& rule,
                                                     const Executor& executor);

  /// Returns the number of parts, and of those that can be seen.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t visible() const;

  /// Returns the shares after the first view, the first two, and so on. O(views · pixels · log triangles). The thread
  /// count changes no bit.
  [[nodiscard]] std::vector<CoverageShares> along(std::span<const Pose> views, const Executor& executor) const;

 private:
  struct Data;
  explicit SurfaceCoverage(std::shared_ptr<const Data> data) : data_{std::move(data)} {}
  std::shared_ptr<const Data> data_;
};

}  // namespace saccade
