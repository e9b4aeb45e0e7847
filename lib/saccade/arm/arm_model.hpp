// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmModel: a serial arm that holds a camera: joints with their limits, links with their collision bodies, the mounts.
// arm_hash: equal for arms that a planner cannot tell apart.

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"
#include "saccade/core/seeded_random.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {

enum class JointKind {
  revolute,
  continuous,  ///< turns without end; its position limits are infinite
  prismatic,
};
inline constexpr auto kJointKindNames = make_names<JointKind>(
    {{JointKind::revolute, "revolute"}, {JointKind::continuous, "continuous"}, {JointKind::prismatic, "prismatic"}});
[[nodiscard]] constexpr std::string_view to_string(JointKind kind) { return kJointKindNames.of(kind); }

/// Limits in rad, rad/s, rad/s²; for prismatic joints in m, m/s, m/s².
struct JointLimits {
  double lower{0.0};
  double upper{0.0};
  double speed{0.0};
  double acceleration{0.0};
};

/// Joint and the link behind it. With q = 0 the link's frame is the joint's; otherwise it is turned by q about the
/// axis, or moved by q along it.
struct ArmJoint {
  std::string name;
  JointKind kind{JointKind::revolute};
  Pose T_parent_joint{Pose::Identity()};                 ///< in the frame of the previous link
  Eigen::Vector3d axis_joint{Eigen::Vector3d::UnitZ()};  ///< in the joint's frame; create() makes it a unit vector
  JointLimits limits;
};

// Primitives lie with their centre in the origin of their frame, as in URDF.

struct BoxBody {
  Eigen::Vector3d size_m{Eigen::Vector3d::Zero()};
};

struct SphereBody {
  double radius_m{0.0};
};

/// Cylinder around the z axis.
struct CylinderBody {
  double radius_m{0.0};
  double length_m{0.0};
};

/// Triangles, open or closed. Collision checks use their convex hull.
struct MeshBody {
  TriangleMesh mesh;
};

struct CollisionBody {
  std::string name;  ///< name of the link in the robot's description
  Pose T_link_body{Pose::Identity()};
  std::variant<BoxBody, SphereBody, CylinderBody, MeshBody> shape;
};

/// Returns "box", "sphere", "cylinder" or "mesh".
[[nodiscard]] std::string_view kind_of(const CollisionBody& body);

struct ArmLink {
  std::string name;
  std::vector<CollisionBody> bodies;  ///< including bodies of everything fixed to the link, also the camera's own
};

/// Parts of an arm before validation. Joint i moves link i + 1; link 0 stands still.
struct ArmDescription {
  std::string name;
  Pose T_world_base{Pose::Identity()};     ///< frame of link 0
  std::vector<ArmJoint> joints;            ///< base first
  std::vector<ArmLink> links;              ///< one more than joints
  std::string flange_name;                 ///< frame that tools and the camera are mounted on
  Pose T_link_flange{Pose::Identity()};    ///< in the frame of the last link
  std::string camera_name;                 ///< the camera's optical frame
  Pose T_flange_camera{Pose::Identity()};  ///< hand-eye transform; optical frame: x right, y down, z forward
};

/// Validated arm. Immutable; safe for concurrent use.
class ArmModel {
 public:
  /// Validates an arm. Answers invalid_argument, naming the joint or link at fault, for: no joint or more than
  /// kMaxJoints; numbers of links and joints that disagree; an axis shorter than 1e-6; transforms that are not rigid or
  /// longer than 1 km; limits that are not finite (except positions of continuous joints, which become infinite); lower
  /// ≥ upper; speeds, accelerations or sizes of bodies that are not positive; meshes without triangles or with bad
  /// indices.
  [[nodiscard]] static Result<ArmModel> create(ArmDescription description);

  [[nodiscard]] const std::string& name() const { return description_.name; }
  /// Returns the number of joints.
  [[nodiscard]] int dof() const { return static_cast<int>(description_.joints.size()); }
  [[nodiscard]] const std::vector<ArmJoint>& joints() const { return description_.joints; }
  [[nodiscard]] const std::vector<ArmLink>& links() const { return description_.links; }
  [[nodiscard]] const ArmJoint& joint(int i) const { return description_.joints[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Pose& T_world_base() const { return description_.T_world_base; }
  /// Returns the camera's pose in the frame of the last link.
  [[nodiscard]] const Pose& T_link_camera() const { return T_link_camera_; }
  /// Returns the validated description. To change the arm, change a copy and call create() again.
  [[nodiscard]] const ArmDescription& description() const { return description_; }

  /// Returns the middle of the limits; 0 for continuous joints.
  [[nodiscard]] const Configuration& middle() const { return middle_; }
  /// Tells whether every joint is within its limits, widened by `tolerance`.
  [[nodiscard]] bool within_limits(const Configuration& q, double tolerance = 0.0) const;

 private:
  explicit ArmModel(ArmDescription description);
  ArmDescription description_;
  Pose T_link_camera_;
  Configuration middle_;
};

/// Returns the arm with speeds multiplied by `share`, and with accelerations such that every path takes 1 / share as
/// long. Expects a share in (0, 1].
[[nodiscard]] ArmModel slowed(const ArmModel& arm, double share);

/// Draws a configuration within the limits, continuous joints within ±π.
[[nodiscard]] Configuration sample_configuration(const ArmModel& arm, SeededRandom& random);
/// Returns 16 hexadecimal digits, a Fnv1a hash of everything that affects the arm's motions and collisions: joints,
/// limits, mounts and bodies, but not names. O(vertices).
[[nodiscard]] std::string arm_hash(const ArmModel& arm);

}  // namespace saccade
