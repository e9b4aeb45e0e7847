// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphereTree: a body covered by balls, coarse ones above fine ones, so that most tests end at a coarse one.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

struct SphereTreeConfig {
  /// Largest distance by which a ball of the finest level exceeds the body. Smaller values need more balls.
  double max_excess_m{0.005};
};

/// Ball in metres in the body's frame. The balls below ball i are i + 1 … next − 1; together they cover its part of the
/// body. None: it is of the finest level.
struct TreeBall {
  Eigen::Vector3f center;
  float radius_m;
  std::uint32_t next;
  bool finest;
};

/// Cover of a body: every point of the body lies in a ball of the finest level, and in each ball above that one.
/// Immutable.
class SphereTree {
 public:
  /// Builds the tree. `body` is a closed surface, not necessarily convex. Where it has holes, a point is inside where
  /// the surface subtends more than half of the full solid angle (generalised winding number, Jacobson et al. 2013).
  /// Answers invalid_argument for no triangles, invalid indices or coordinates, or more than 2¹⁶ balls. O(balls ·
  /// triangles); convex bodies are about thirty times faster than others.
  [[nodiscard]] static Result<SphereTree> build(const TriangleMesh& body, const SphereTreeConfig& config = {});

  /// Returns the balls in depth-first order; the first one covers the whole body.
  [[nodiscard]] std::span<const TreeBall> balls() const { return balls_; }

  /// Tells whether `is_clear(ball)` holds for balls that cover ball `from`, using balls as coarse as possible.
  template <class IsClear>
  bool clear(const IsClear& is_clear, std::uint32_t from = 0) const {
    for (std::uint32_t i = from; i < balls_[from].next;) {
      const TreeBall& ball = balls_[i];
      if (is_clear(ball)) {
        i = ball.next;
      } else if (ball.finest) {
        return false;
      } else {
        ++i;
      }
    }
    return true;
  }

 private:
  explicit SphereTree(std::vector<TreeBall> balls) : balls_{std::move(balls)} {}
  std::vector<TreeBall> balls_;
};

}  // namespace saccade
