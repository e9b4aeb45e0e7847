// SPDX-License-Identifier: Apache-2.0
#pragma once
// JointAxes: the axes of an arm with six or seven revolute joints at q = 0; angles for closed forms.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade {

/// Solutions of one pose: at most two shoulders, two elbows and two wrists.
template <int joints>
struct FormSolutions {
  std::array<Eigen::Matrix<double, joints, 1>, 8> q;  ///< rad; the first `count` are set
  std::size_t count{0};
};
using ClosedFormSolutions = FormSolutions<6>;
using SevenSolutions = FormSolutions<7>;

/// Axes in the world frame, with q = 0.
struct JointAxes {
  static constexpr std::size_t kMost{7};
  static constexpr double kTolerance{1e-4};  ///< tolerance for axes of a rounded description that should meet or be
                                             ///< parallel
  static constexpr double kExact{1e-12};     ///< tolerance for axes that meet or are parallel to the last digits
  static constexpr double kOblique{1e-3};    ///< smallest angle between axes that must not be parallel, rad

  std::array<Eigen::Vector3d, kMost> axis;   ///< unit
  std::array<Eigen::Vector3d, kMost> point;  ///< on each axis
  std::array<double, kMost> lower{};         ///< limits, rad
  std::array<double, kMost> upper{};

  /// @param zero the arm's poses with q = 0. Answers unsupported unless the arm has six, or seven, revolute joints.
  [[nodiscard]] static Result<JointAxes> of(const ArmModel& arm, const ArmPoses& zero, int joints = 6);

  [[nodiscard]] bool are_parallel(std::size_t i, std::size_t k) const { return off_parallel(i, k) < kOblique; }
  /// Returns the sine of the angle between two axes.
  [[nodiscard]] double off_parallel(std::size_t i, std::size_t k) const { return axis[i].cross(axis[k]).norm(); }
  /// Returns 1 where axis k points in the direction of axis i, −1 in the opposite one.
  [[nodiscard]] double sign(std::size_t i, std::size_t k) const { return axis[i].dot(axis[k]) > 0.0 ? 1.0 : -1.0; }
  /// Tells whether an angle, up to whole turns, is within the joint's limits.
  [[nodiscard]] bool allow(std::size_t joint, double angle_rad) const;
};

/// Returns the error for an arm without a closed form.
[[nodiscard]] Error no_closed_form(const ArmModel& arm, const std::string& why);

/// Wraps an angle to [−π, π].
[[nodiscard]] double wrapped(double angle_rad);
/// Returns the angle between unit vectors, in [0, π].
[[nodiscard]] double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// Returns the angle of the rotation about a unit axis that takes a's part across it to b's.
[[nodiscard]] double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// Returns r rotated about a unit axis, without a matrix.
[[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& axis, double angle_rad, const Eigen::Vector3d& r);

/// Returns the distance of p from the line along a unit axis through q.
[[nodiscard]] double distance_to_line(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& axis);

/// Point nearest to two lines that are not parallel (the middle of their shortest connection), and the distance between
/// the lines.
struct ClosestPoint {
  Eigen::Vector3d p;
  double distance_m{0.0};
};
[[nodiscard]] ClosestPoint closest_point_of(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                            const Eigen::Vector3d& q, const Eigen::Vector3d& b);

/// Angles x at which A cos x + B sin x = C.
struct AnglePair {
  std::array<double, 2> rad{};
  std::size_t count{0};  ///< 0: none; 1: they coincide
  bool is_free{false};   ///< A, B and C vanish: any angle is a solution
};
/// @param slack rounding by which |C| may exceed its maximum.
[[nodiscard]] AnglePair angles_with(double A, double B, double C, double slack);

/// Returns the rotations of c about b, starting in one plane with a, that bring it to an angle theta from a; alpha and
/// beta are the angles between a and b and between b and c. This is the angle opposite a side of a spherical triangle:
/// sin²(x/2) = sin((θ + α − β)/2) sin((θ − α + β)/2) / (sin α sin β).
[[nodiscard]] AnglePair angles_across(double alpha_rad, double beta_rad, double theta_rad);

/// Returns the middles of `count` equal parts of a range, ordered so that the first few are already spread.
[[nodiscard]] std::vector<double> spread_over(double lower, double upper, int count);

/// Two links that turn in a plane: the first about the origin, the second about the first one's end.
class TwoLinks {
 public:
  TwoLinks() = default;
  /// Takes the links as they lie with both angles 0. Expects positive lengths.
  TwoLinks(const Eigen::Vector2d& upper, const Eigen::Vector2d& fore);

  struct Angles {
    double first{0.0};   ///< rotation of both links about the origin
    double second{0.0};  ///< rotation of the second link about the first one's end
  };
  struct Solutions {
    std::array<Angles, 2> angles{};
    std::size_t count{0};  ///< 0: out of reach; 1: they coincide
  };
  /// Returns the angles that bring the end to a point. Where that is the origin, `first` is `first_if_free`. Law of
  /// cosines by half angles.
  [[nodiscard]] Solutions reach(const Eigen::Vector2d& point, double first_if_free) const;
  [[nodiscard]] double reach_m() const { return upper_m_ + fore_m_; }

 private:
  Eigen::Vector2d upper_{Eigen::Vector2d::UnitX()};
  Eigen::Vector2d fore_{Eigen::Vector2d::UnitX()};
  double upper_m_{1.0};
  double fore_m_{1.0};
  double zero_{0.0};  ///< initial angle from the first link to the second
};

}  // namespace saccade
