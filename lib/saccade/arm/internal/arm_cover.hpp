// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmCover: coarse balls around the whole arm, laid out for vectors, which suffice for most configurations.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "saccade/arm/internal/arm_kernels.hpp"
#include "saccade/arm/internal/sphere_tree.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/obstacle_map.hpp"

namespace saccade {

struct FrontBall {
  std::size_t link;
  std::size_t body;
  std::uint32_t index;  ///< index in the body's cover
};

/// Covers of the moving links, each down to sufficiently small balls with some finer ones below each, and boxes around
/// all bodies along the axes of their links. Immutable.
class ArmCover {
 public:
  static constexpr std::size_t kFinerBalls{16};

  /// Builds the cover. slack_m bounds the float rounding of a ball's coordinates and is added to the radii.
  ArmCover(const ArmModel& arm, const std::vector<std::vector<SphereTree>>& covers,
           const std::vector<std::vector<Eigen::AlignedBox3d>>& boxes,
           const std::vector<std::pair<int, int>>& self_pairs, double slack_m);

  [[nodiscard]] double slack_m() const { return slack_m_; }
  /// Balls in blocks of arm::kBlock of one link, padded with the link's last ball; the hand first.
  [[nodiscard]] std::span<const FrontBall> balls() const { return coarse_.balls; }
  /// Returns the balls that cover ball i of balls().
  [[nodiscard]] std::span<const FrontBall> finer(std::size_t i) const {
    return std::span{fine_.balls}.subspan(i * kFinerBalls, kFinerBalls);
  }

 private:
  friend class PlacedFront;
  /// Balls in the frames of their links, in blocks of one link.
  struct Level {
    std::vector<FrontBall> balls;
    std::vector<float> x_m;
    std::vector<float> y_m;
    std::vector<float> z_m;
    std::vector<float> radius_m;
    std::vector<std::uint8_t> links;  ///< link of each block

    void add(const FrontBall& ball, const TreeBall& of_cover, float slack_m);
    [[nodiscard]] arm::BallArrays arrays(std::size_t first) const {
      return {x_m.data() + first, y_m.data() + first, z_m.data() + first, radius_m.data() + first};
    }
  };

  double slack_m_;
  arm::Frame base_;
  std::vector<arm::JointTerms> joints_;
  std::vector<bool> slides_;  ///< per joint
  Level coarse_;
  Level fine_;  ///< kFinerBalls for each ball of coarse_
  std::vector<arm::FrameBox> boxes_;
  std::vector<arm::BoxesAndBlocks> pairs_;
};

/// Balls placed in the world.
class PlacedFront {
 public:
  PlacedFront(const ArmCover& front, const ArmPoses& poses);
  /// Places the balls by forward kinematics in float.
  PlacedFront(const ArmCover& front, const Configuration& q);
  PlacedFront(const PlacedFront&) = delete;
  PlacedFront& operator=(const PlacedFront&) = delete;

  /// Returns a link's pose, with an error of at most slack_m() anywhere along the link.
  [[nodiscard]] Pose T_world_link(std::size_t link) const;
  /// Returns `count` balls from `first` on.
  [[nodiscard]] SphereSpans spheres(std::size_t first, std::size_t count) const;
  /// Returns a mask: bit k is set when ball k of finer(i) is not known to be clear.
  [[nodiscard]] std::uint64_t perhaps_touching_finer(std::size_t i, const ObstacleMap& obstacles) const;
  /// Returns the first pair from `first` on, in the order of self_pairs, whose links are not known to be farther apart
  /// than margins_m[pair]; the number of pairs when all are.
  [[nodiscard]] std::size_t first_near_pair(std::size_t first, std::span<const float> margins_m) const;

 private:
  static constexpr std::size_t kFew{256};
  void place();
  [[nodiscard]] arm::BallArrays arrays() const { return {x_m_, y_m_, z_m_, front_.coarse_.radius_m.data()}; }

  const ArmCover& front_;
  std::array<arm::Frame, kMaxJoints + 1> frames_;
  alignas(64) std::array<float, 3 * kFew> few_;
  std::vector<float> many_;  ///< storage for larger arms
  float* x_m_;
  float* y_m_;
  float* z_m_;
};

}  // namespace saccade
