// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmFront: coarse balls around all of an arm, laid out for vectors, so that most configurations need only them.

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
  std::uint32_t index;  ///< in the body's cover
};

/// The covers of the links that move, each down to balls that are small enough, below each of these some finer ones,
/// and boxes around all bodies along the axes of their links. Immutable.
class ArmFront {
 public:
  static constexpr std::size_t kFinerBalls{16};

  /// No coordinate that a ball is given in float is off by more than slack_m, which is added to the radii.
  ArmFront(const ArmModel& arm, const std::vector<std::vector<SphereTree>>& covers,
           const std::vector<std::vector<Eigen::AlignedBox3d>>& boxes,
           const std::vector<std::pair<int, int>>& self_pairs, double slack_m);

  [[nodiscard]] double slack_m() const { return slack_m_; }
  /// In blocks of arm::kBlock of one link, the last ball of a link repeated; the hand first.
  [[nodiscard]] std::span<const FrontBall> balls() const { return coarse_.balls; }
  /// Balls that cover what ball i of balls() covers.
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
    std::vector<std::uint8_t> links;  ///< per block

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
  Level fine_;  ///< kFinerBalls for each of coarse_
  std::vector<arm::FrameBox> boxes_;
  std::vector<arm::BoxesAndBlocks> pairs_;
};

/// The balls in the world.
class PlacedFront {
 public:
  PlacedFront(const ArmFront& front, const ArmPoses& poses);
  /// By forward kinematics in float.
  PlacedFront(const ArmFront& front, const Configuration& q);
  PlacedFront(const PlacedFront&) = delete;
  PlacedFront& operator=(const PlacedFront&) = delete;

  /// Off by slack_m() at most, anywhere along the link.
  [[nodiscard]] Pose T_world_link(std::size_t link) const;
  /// `count` balls from `first` on.
  [[nodiscard]] SphereSpans spheres(std::size_t first, std::size_t count) const;
  /// Bit k: ball k of finer(i) is not known to be clear.
  [[nodiscard]] std::uint64_t perhaps_touching_finer(std::size_t i, const ObstacleMap& obstacles) const;
  /// The first pair from `first` on, in the order of self_pairs, whose links are not known to be farther apart than
  /// margins_m[pair], one for each pair; their number when all are.
  [[nodiscard]] std::size_t first_near_pair(std::size_t first, std::span<const float> margins_m) const;

 private:
  static constexpr std::size_t kFew{256};
  void place();
  [[nodiscard]] arm::BallArrays arrays() const { return {x_m_, y_m_, z_m_, front_.coarse_.radius_m.data()}; }

  const ArmFront& front_;
  std::array<arm::Frame, kMaxJoints + 1> frames_;
  alignas(64) std::array<float, 3 * kFew> few_;
  std::vector<float> many_;  ///< where there are more
  float* x_m_;
  float* y_m_;
  float* z_m_;
};

}  // namespace saccade
