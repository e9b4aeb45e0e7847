// SPDX-License-Identifier: Apache-2.0
#pragma once
// SphereTree: a body covered by balls, coarse ones over fine ones, so that most questions end at a coarse one.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

struct SphereTreeConfig {
  /// No ball of the finest level reaches farther out of the body. The smaller, the more balls.
  double max_excess_m{0.005};
};

/// A ball, metres, in the body's frame. The balls below ball i are i + 1 … next − 1: together they cover what it covers
/// of the body. None: it is of the finest level.
struct TreeBall {
  Eigen::Vector3f center;
  float radius_m;
  std::uint32_t next;
  bool finest;
};

/// Every point of the body lies in a ball of the finest level, and in each ball above that one. Immutable.
class SphereTree {
 public:
  /// `body` is a closed surface, not necessarily convex; where it has holes, what counts as inside is where it subtends
  /// more than half of the full solid angle (generalised winding number, Jacobson et al. 2013).
  /// invalid_argument: no triangles, indices or coordinates that make no sense, more than 2¹⁶ balls.
  /// O(balls · triangles), and for convex bodies about thirty times faster than for others.
  [[nodiscard]] static Result<SphereTree> build(const TriangleMesh& body, const SphereTreeConfig& config = {});

  /// In depth-first order; the first one covers the whole body.
  [[nodiscard]] std::span<const TreeBall> balls() const { return balls_; }

  /// Whether `is_clear(ball)` holds for balls that cover what ball `from` covers, the coarsest that will do.
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
