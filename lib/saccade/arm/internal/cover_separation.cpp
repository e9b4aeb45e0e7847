// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/cover_separation.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kTouching_m{1e-6};

/// Separation of two covers, from coarse to fine.
class Separation {
 public:
  Separation(const SphereTree& a, const Pose& T_a_b, const SphereTree& b, double enough_m)
      : a_{a.balls()}, b_{b.balls()}, T_a_b_{T_a_b}, enough_m_{enough_m} {
    look(0, 0);
  }
  [[nodiscard]] double metres() const { return least_m_; }

 private:
  void look(std::uint32_t i, std::uint32_t j) {
    const TreeBall& a = a_[i];
    const TreeBall& b = b_[j];
    const double gap_m = (a.center.cast<double>() - T_a_b_ * b.center.cast<double>()).norm() -
                         static_cast<double>(a.radius_m) - static_cast<double>(b.radius_m);
    if (gap_m >= least_m_) return;
    if (gap_m > enough_m_ || (a.finest && b.finest)) {
      least_m_ = gap_m;
    } else if (b.finest || (!a.finest && a.radius_m >= b.radius_m)) {
      for (std::uint32_t child = i + 1; child < a.next && least_m_ > 0.0; child = a_[child].next) look(child, j);
    } else {
      for (std::uint32_t child = j + 1; child < b.next && least_m_ > 0.0; child = b_[child].next) look(i, child);
    }
  }

  std::span<const TreeBall> a_;
  std::span<const TreeBall> b_;
  Pose T_a_b_;
  double enough_m_;
  double least_m_{std::numeric_limits<double>::infinity()};
};

/// Tells whether a side of one of two boxes separates it from the other by more than margin_m. `half_m` are half edges.
bool boxes_apart(const Pose& T_world_a, const Vector3d& a_half_m, const Pose& T_world_b, const Vector3d& b_half_m,
                 double margin_m) {
  const Eigen::Matrix3d R_a_b = T_world_a.linear().transpose() * T_world_b.linear();
  const Vector3d apart = T_world_b.translation() - T_world_a.translation();
  const Vector3d along_a = (T_world_a.linear().transpose() * apart).cwiseAbs();
  const Vector3d along_b = (T_world_b.linear().transpose() * apart).cwiseAbs();
  const Eigen::Matrix3d turned = R_a_b.cwiseAbs();
  return ((along_a - a_half_m - turned * b_half_m).array() > margin_m).any() ||
         ((along_b - b_half_m - turned.transpose() * a_half_m).array() > margin_m).any();
}

}  // namespace

double separation_m(const PlacedBody& a, const PlacedBody& b, double enough_m) {
  const TreeBall& ball_a = a.cover.balls().front();
  const TreeBall& ball_b = b.cover.balls().front();
  const double gap_m =
      (a.T_world_link * ball_a.center.cast<double>() - b.T_world_link * ball_b.center.cast<double>()).norm() -
      static_cast<double>(ball_a.radius_m) - static_cast<double>(ball_b.radius_m);
  if (gap_m > enough_m) return gap_m;
  if (boxes_apart(a.T_world_link * a.box.T_link_box, a.box.half_m, b.T_world_link * b.box.T_link_box, b.box.half_m,
                  enough_m)) {
    return enough_m + kTouching_m;
  }
  const Pose T_a_b = a.T_world_link.inverse(Eigen::Isometry) * b.T_world_link;
  return Separation{a.cover, T_a_b, b.cover, enough_m}.metres();
}

}  // namespace saccade
