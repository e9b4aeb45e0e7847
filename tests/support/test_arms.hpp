// SPDX-License-Identifier: Apache-2.0
#pragma once
// Arms for tests, from Denavit–Hartenberg rows, and random configurations.

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/inverse_kinematics.hpp"

namespace saccade::test {

/// T = Rz(sign·q + offset) Tz(d) Tx(a) Rx(α).
struct DhRow {
  double sign;
  double offset_rad;
  double d_m;
  double a_m;
  double alpha_rad;
  double lower_rad{-std::numbers::pi};
  double upper_rad{std::numbers::pi};
};

inline Pose dh_fixed(const DhRow& row) {
  Pose T = Pose::Identity();
  T.translate(Eigen::Vector3d{row.a_m, 0.0, row.d_m});
  T.rotate(Eigen::AngleAxisd{row.alpha_rad, Eigen::Vector3d::UnitX()});
  return T;
}

inline Pose turn_z(double angle_rad) { return Pose{Eigen::AngleAxisd{angle_rad, Eigen::Vector3d::UnitZ()}}; }

/// The product of the rows, written down as in a textbook.
inline Pose dh_product(const std::vector<DhRow>& rows, const Configuration& q) {
  Pose T = Pose::Identity();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    T = T * turn_z(rows[i].sign * q[static_cast<Eigen::Index>(i)] + rows[i].offset_rad) * dh_fixed(rows[i]);
  }
  return T;
}

inline ArmDescription describe(const std::string& name, const std::vector<DhRow>& rows) {
  ArmDescription description;
  description.name = name;
  description.links.push_back({"base", {}});
  Pose T_before = Pose::Identity();
  for (const DhRow& row : rows) {
    const std::string number = std::to_string(description.links.size());
    ArmJoint joint;
    joint.name = "joint_" + number;
    joint.T_parent_joint = T_before * turn_z(row.offset_rad);
    joint.axis_joint = row.sign * Eigen::Vector3d::UnitZ();
    joint.limits = {row.lower_rad, row.upper_rad, 2.0, 10.0};
    description.joints.push_back(joint);
    description.links.push_back({"link_" + number, {}});
    T_before = dh_fixed(row);
  }
  description.T_link_flange = T_before;
  return description;
}

constexpr double kRight{std::numbers::pi / 2};

/// The Comau SMART SiX, with the signs of its URDF.
inline std::vector<DhRow> comau_rows() {
  return {{-1, 0, 0.450, 0.150, kRight}, {-1, kRight, 0, 0.590, 0}, {1, kRight, 0, 0.130, kRight},
          {-1, 0, 0.64707, 0, -kRight},  {-1, 0, 0, 0, kRight},     {-1, 2 * kRight, 0.095, 0, 0}};
}

/// An arm with its shoulder beside axis 1 and its forearm below the elbow, all turning ±185°.
inline std::vector<DhRow> offset_rows() {
  constexpr double kLimit{185.0 / 180.0 * std::numbers::pi};
  return {{1, 0.3, 0.40, 0.025, -kRight, -kLimit, kLimit}, {1, -0.4, 0.12, 0.315, 0, -kLimit, kLimit},
          {1, 0.2, -0.03, 0.035, kRight, -kLimit, kLimit}, {1, 0, 0.365, 0, -kRight, -kLimit, kLimit},
          {-1, 0, 0, 0, kRight, -kLimit, kLimit},          {1, 1.1, 0.08, 0, 0, -kLimit, kLimit}};
}

/// A UR5e: axes 2, 3 and 4 are parallel.
inline std::vector<DhRow> ur_rows() {
  return {{1, 0, 0.1625, 0, kRight}, {1, 0, 0, -0.425, 0},       {1, 0, 0, -0.3922, 0},
          {1, 0, 0.1333, 0, kRight}, {1, 0, 0.0997, 0, -kRight}, {1, 0, 0.0996, 0, 0}};
}

/// Such an arm whose axis 1 leans, whose links lie beside each other and whose wrist encloses 80° and 75°.
inline std::vector<DhRow> oblique_parallel_rows() {
  constexpr double kDegree{std::numbers::pi / 180.0};
  return {{1, 0.2, 0.2, 0.05, -70 * kDegree}, {-1, 0.5, 0.05, 0.4, 0},          {1, 0, -0.03, 0.35, std::numbers::pi},
          {-1, 0.3, 0.1, 0.04, 80 * kDegree}, {1, 0.7, 0.09, 0, -75 * kDegree}, {1, 0, 0.1, 0, 0}};
}

/// Axis 1 leans, and the wrist's neighbouring axes enclose 60° and 75° instead of right angles.
inline std::vector<DhRow> oblique_rows() {
  constexpr double kDegree{std::numbers::pi / 180.0};
  return {{1, 0, 0.5, 0.1, -70 * kDegree}, {-1, 0.5, 0.05, 0.6, 0},      {1, 0, 0.02, 0.1, 80 * kDegree},
          {1, 0, 0.55, 0, -60 * kDegree},  {1, 0.7, 0, 0, 75 * kDegree}, {1, 0, 0.1, 0, 0}};
}

/// The Franka Panda with its limits: seven joints, offsets at elbow and wrist.
inline std::vector<DhRow> panda_rows() {
  return {{1, 0, 0.333, 0, -kRight, -2.8973, 2.8973},
          {1, 0, 0, 0, kRight, -1.7628, 1.7628},
          {1, 0, 0.316, 0.0825, kRight, -2.8973, 2.8973},
          {1, 0, 0, -0.0825, -kRight, -3.0718, -0.0698},
          {1, 0, 0.384, 0, kRight, -2.8973, 2.8973},
          {1, 0, 0, 0.088, kRight, -0.0175, 3.7525},
          {1, 0, 0.107, 0, 0, -2.8973, 2.8973}};
}

/// Such an arm whose axes enclose other angles than right ones, and whose axis 5 passes beside axis 4.
inline std::vector<DhRow> oblique_panda_rows() {
  constexpr double kDegree{std::numbers::pi / 180.0};
  return {{1, 0.2, 0.3, 0, -75 * kDegree},
          {-1, 0, 0, 0, 80 * kDegree},
          {1, 0.4, 0.35, 0.08, 70 * kDegree},
          {1, 0, 0.05, -0.06, -80 * kDegree},
          {1, 0.1, 0.4, 0, 75 * kDegree},
          {-1, 0, 0, 0.09, 60 * kDegree},
          {1, 0, 0.1, 0, 0}};
}

/// The KUKA iiwa 14 with its limits: a spherical shoulder and a spherical wrist.
inline std::vector<DhRow> iiwa_rows() {
  return {{1, 0, 0.36, 0, -kRight, -2.967, 2.967}, {1, 0, 0, 0, kRight, -2.094, 2.094},
          {1, 0, 0.42, 0, kRight, -2.967, 2.967},  {1, 0, 0, 0, -kRight, -2.094, 2.094},
          {1, 0, 0.40, 0, -kRight, -2.967, 2.967}, {1, 0, 0, 0, kRight, -2.094, 2.094},
          {1, 0, 0.126, 0, 0, -3.054, 3.054}};
}

/// Such an arm with an offset at its elbow, and whose axes enclose other angles than right ones.
inline std::vector<DhRow> oblique_iiwa_rows() {
  constexpr double kDegree{std::numbers::pi / 180.0};
  return {{1, 0.2, 0.3, 0, -75 * kDegree},
          {-1, 0, 0, 0, 80 * kDegree},
          {1, 0.4, 0.4, 0.05, 70 * kDegree},
          {1, 0, 0.02, -0.04, -80 * kDegree},
          {1, 0.1, 0.4, 0, 75 * kDegree},
          {-1, 0, 0, 0, -60 * kDegree},
          {1, 0, 0.1, 0, 0}};
}

/// Six joints with a spherical shoulder, the last two of which meet.
inline std::vector<DhRow> spherical_shoulder_rows() {
  std::vector<DhRow> rows = oblique_panda_rows();
  rows.pop_back();
  return rows;
}

/// Puts one more joint under an arm, which turns or slides along its axis.
inline ArmDescription on_joint(ArmDescription arm, JointKind kind, const Eigen::Vector3d& axis, double lower,
                               double upper) {
  ArmJoint joint;
  joint.name = "joint_0";
  joint.kind = kind;
  joint.axis_joint = axis;
  joint.T_parent_joint = Pose{Eigen::Translation3d{0.1, 0.2, 0.05}};
  joint.limits = {lower, upper, 1.0, 5.0};
  arm.joints.insert(arm.joints.begin(), joint);
  arm.links.insert(arm.links.begin(), {"ground", {}});
  return arm;
}

/// A camera beside the flange, and a base somewhere in the world.
inline ArmModel with_camera(ArmDescription description) {
  description.T_world_base =
      Pose{Eigen::Translation3d{0.3, -0.7, 0.2} * Eigen::AngleAxisd{0.8, Eigen::Vector3d{1, 2, 2} / 3}};
  description.T_flange_camera =
      Pose{Eigen::Translation3d{0.02, 0.07, 0.05} * Eigen::AngleAxisd{0.5, Eigen::Vector3d{2, -1, 2} / 3}};
  return ArmModel::create(std::move(description)).value();
}

/// Within the limits; continuous joints within ±π.
inline Configuration random_configuration(const ArmModel& arm, std::mt19937_64& random) {
  Configuration q{arm.dof()};
  for (int i = 0; i < arm.dof(); ++i) {
    const JointLimits& limits = arm.joint(i).limits;
    const bool endless = std::isinf(limits.upper);
    q[i] = std::uniform_real_distribution<double>{endless ? -3.1 : limits.lower, endless ? 3.1 : limits.upper}(random);
  }
  return q;
}

/// The larger of distance (m) and angle (rad).
inline double miss(const Pose& a, const Pose& b) {
  const Pose d = a.inverse() * b;
  return std::max(d.translation().norm(), (d.linear() - Eigen::Matrix3d::Identity()).norm() / std::numbers::sqrt2);
}

/// Greatest difference of any joint; turns count.
inline double distance(const Configuration& a, const Configuration& b) { return (a - b).lpNorm<Eigen::Infinity>(); }

inline double nearest(const std::vector<Configuration>& solutions, const Configuration& q) {
  double best = std::numeric_limits<double>::infinity();
  for (const Configuration& solution : solutions) best = std::min(best, distance(solution, q));
  return best;
}

}  // namespace saccade::test
