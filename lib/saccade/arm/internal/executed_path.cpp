// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/executed_path.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/arm/internal/sphere_tree.hpp"
#include "saccade/arm/internal/swept_cells.hpp"
#include "saccade/arm/motion_planner.hpp"

namespace saccade {
namespace {

constexpr double kFollowed{0.01};      ///< rad or m: a controller stops within this distance of its target
constexpr double kAtRest{1e-9};        ///< rad/s or m/s
constexpr double kDepthSlack_m{1e-4};  ///< rounding slack

Trajectory::Piece backwards(const Trajectory::Piece& piece) {
  const double t_s = piece.duration_s;
  return {t_s, piece.q + t_s * piece.speed + 0.5 * t_s * t_s * piece.acceleration,
          -(piece.speed + t_s * piece.acceleration), piece.acceleration};
}

Configuration end_of(const Trajectory::Piece& piece) { return backwards(piece).q; }

/// Search for a retreat in which an arm only leaves its initial contacts.
class RetreatSearch {
 public:
  RetreatSearch(const Configuration& q, const ArmCollision& collision, const ObstacleMap& obstacles)
      : collision_{collision},
        obstacles_{obstacles},
        touched_{collision, obstacles, 0.0},
        most_m_{obstacle_depths_m(q, collision, obstacles)} {
    touched_.add(q);
  }

  [[nodiscard]] bool along(const Trajectory::Piece& piece) {
    const std::size_t touched_before = touched_.count();
    touched_.add(Trajectory{{piece}});
    if (touched_.count() > touched_before) return false;
    const Configuration last_speed = piece.speed + piece.duration_s * piece.acceleration;
    const Configuration fastest = piece.speed.cwiseAbs().cwiseMax(last_speed.cwiseAbs());
    const double travel_m = collision_.travel_bound_m(Configuration::Zero(piece.q.size()), fastest) * piece.duration_s;
    const int steps = std::max(1, static_cast<int>(std::ceil(travel_m / collision_.config().max_step_m)));
    for (int i = 1; i <= steps; ++i) {
      const double t_s = piece.duration_s * i / steps;
      if (!at(piece.q + t_s * piece.speed + 0.5 * t_s * t_s * piece.acceleration)) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] bool at(const Configuration& q) {
    const std::vector<double> depths_m = obstacle_depths_m(q, collision_, obstacles_);
    for (std::size_t link = 0; link < depths_m.size(); ++link) {
      if (depths_m[link] > most_m_[link] + kDepthSlack_m) return false;
      if (depths_m[link] == 0.0) most_m_[link] = 0.0;
    }
    return true;
  }

  const ArmCollision& collision_;
  const ObstacleMap& obstacles_;
  SweptCells touched_;
  std::vector<double> most_m_;  ///< per link
};

}  // namespace

void ExecutedPath::add(const Trajectory& motion) {
  pieces_.insert(pieces_.end(), motion.pieces().begin(), motion.pieces().end());
  if (pieces_.size() > kMostPieces) pieces_.erase(pieces_.begin(), pieces_.end() - kMostPieces);
}

std::optional<Trajectory> ExecutedPath::retreat_from(const Configuration& q, const ArmCollision& collision,
                                                     const ObstacleMap& obstacles) const {
  if (pieces_.empty()) return std::nullopt;
  const Configuration end = end_of(pieces_.back());
  if (q.size() != end.size() || !((q - end).lpNorm<Eigen::Infinity>() <= kFollowed)) return std::nullopt;
  RetreatSearch leaving{q, collision, obstacles};
  std::vector<Trajectory::Piece> back = parametrise(collision.arm(), {q, end}).pieces();
  for (const Trajectory::Piece& piece : back) {
    if (!leaving.along(piece)) return std::nullopt;
  }
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    back.push_back(backwards(*piece));
    if (!leaving.along(back.back())) return std::nullopt;
    const bool at_rest = piece->speed.lpNorm<Eigen::Infinity>() <= kAtRest;
    if (at_rest && !collision.contact(piece->q, obstacles)) return Trajectory{std::move(back)};
  }
  return std::nullopt;
}

std::vector<double> obstacle_depths_m(const Configuration& q, const ArmCollision& collision,
                                      const ObstacleMap& obstacles) {
  const ArmPoses poses = forward_kinematics(collision.arm(), q);
  std::vector<double> depths_m(static_cast<std::size_t>(collision.arm().dof()) + 1, 0.0);
  for (std::size_t link = 1; link < depths_m.size(); ++link) {
    double& depth_m = depths_m[link];
    for (const SphereTree& cover : collision.cover(static_cast<int>(link))) {
      const auto balls = cover.balls();
      for (std::uint32_t i = 0; i < balls.size();) {
        const TreeBall& ball = balls[i];
        const Eigen::Vector3d center = poses.T_world_link[link] * ball.center.cast<double>();
        const auto radius_m = static_cast<double>(ball.radius_m);
        if (obstacles.distance_bound_m(center) >= radius_m) {
          i = ball.next;
          continue;
        }
        if (ball.finest) depth_m = std::max(depth_m, radius_m - obstacles.distance_m(center));
        ++i;
      }
    }
  }
  return depths_m;
}

}  // namespace saccade
