// SPDX-License-Identifier: Apache-2.0
#pragma once
// JointAxes: where the axes of an arm with six or seven joints that turn lie at q = 0; the angles that closed forms
// need.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/kinematics.hpp"

namespace saccade {

/// The solutions of one pose: at most two shoulders, two elbows and two wrists.
template <int joints>
struct FormSolutions {
  std::array<Eigen::Matrix<double, joints, 1>, 8> q;  ///< rad; the first `count` are set
  std::size_t count{0};
};
using ClosedFormSolutions = FormSolutions<6>;
using SevenSolutions = FormSolutions<7>;

/// World frame, with q = 0.
struct JointAxes {
  static constexpr std::size_t kMost{7};
  static constexpr double kTolerance{1e-4};  ///< axes of a rounded description meet or are parallel within this
  static constexpr double kExact{1e-12};     ///< axes that meet or are parallel to the last digits
  static constexpr double kOblique{1e-3};    ///< axes that must not be parallel differ by more, rad

  std::array<Eigen::Vector3d, kMost> axis;   ///< unit
  std::array<Eigen::Vector3d, kMost> point;  ///< on each axis
  std::array<double, kMost> lower{};         ///< limits, rad
  std::array<double, kMost> upper{};

  /// @param zero the arm's poses with q = 0. unsupported for other joints than six, or seven, that turn.
  [[nodiscard]] static Result<JointAxes> of(const ArmModel& arm, const ArmPoses& zero, int joints = 6);

  [[nodiscard]] bool are_parallel(std::size_t i, std::size_t k) const { return off_parallel(i, k) < kOblique; }
  /// The sine of the angle between two axes.
  [[nodiscard]] double off_parallel(std::size_t i, std::size_t k) const { return axis[i].cross(axis[k]).norm(); }
  /// 1: axis k points as axis i does; −1: the other way.
  [[nodiscard]] double sign(std::size_t i, std::size_t k) const { return axis[i].dot(axis[k]) > 0.0 ? 1.0 : -1.0; }
  /// Whether an angle, give or take whole turns, is within the joint's limits.
  [[nodiscard]] bool allow(std::size_t joint, double angle_rad) const;
};

/// Why an arm has no closed form.
[[nodiscard]] Error no_closed_form(const ArmModel& arm, const std::string& why);

/// In [−π, π].
[[nodiscard]] double wrapped(double angle_rad);
/// Angle between unit vectors, in [0, π].
[[nodiscard]] double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// Angle of the turn about a unit axis that takes a's part across it to b's.
[[nodiscard]] double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// r turned about a unit axis, without a matrix.
[[nodiscard]] Eigen::Vector3d turned(const Eigen::Vector3d& axis, double angle_rad, const Eigen::Vector3d& r);

/// How far p lies from the line along a unit axis through q.
[[nodiscard]] double distance_to_line(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& axis);

/// Point nearest to two lines that are not parallel (the middle of their shortest connection), and how far apart they
/// are.
struct Meeting {
  Eigen::Vector3d p;
  double distance_m{0.0};
};
[[nodiscard]] Meeting meeting_of(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& q,
                                 const Eigen::Vector3d& b);

/// Angles x at which A cos x + B sin x = C.
struct AnglePair {
  std::array<double, 2> rad{};
  std::size_t count{0};  ///< 0: none; 1: they fall together
  bool is_free{false};   ///< A, B and C vanish: any angle will do
};
/// @param slack how far |C| may lie beyond the most by rounding.
[[nodiscard]] AnglePair angles_with(double A, double B, double C, double slack);

/// Turns of c about b, from where it lies in one plane with a, that bring it to an angle theta from a; alpha and beta
/// are the angles between a and b and between b and c. The angle across a side of a spherical triangle: sin²(x/2) =
/// sin((θ + α − β)/2) sin((θ − α + β)/2) / (sin α sin β).
[[nodiscard]] AnglePair angles_across(double alpha_rad, double beta_rad, double theta_rad);

/// Middles of `count` equal parts of a range, in an order in which the first few are spread already.
[[nodiscard]] std::vector<double> spread_over(double lower, double upper, int count);

/// Two links that turn in a plane: the first from the origin, the second from the first one's end.
class TwoLinks {
 public:
  TwoLinks() = default;
  /// Expects links of some length. The links as they lie with both angles 0.
  TwoLinks(const Eigen::Vector2d& upper, const Eigen::Vector2d& fore);

  struct Angles {
    double first{0.0};   ///< turn of both links about the origin
    double second{0.0};  ///< turn of the second link about the first one's end
  };
  struct Solutions {
    std::array<Angles, 2> angles{};
    std::size_t count{0};  ///< 0: out of reach; 1: they fall together
  };
  /// What brings the end to a point. Where that is the origin, `first` is `first_if_free`. Law of cosines by half
  /// angles.
  [[nodiscard]] Solutions reach(const Eigen::Vector2d& point, double first_if_free) const;
  [[nodiscard]] double reach_m() const { return upper_m_ + fore_m_; }

 private:
  Eigen::Vector2d upper_{Eigen::Vector2d::UnitX()};
  Eigen::Vector2d fore_{Eigen::Vector2d::UnitX()};
  double upper_m_{1.0};
  double fore_m_{1.0};
  double zero_{0.0};  ///< angle from the first link to the second as they lie
};

}  // namespace saccade
