// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmModel: a serial arm that holds a camera: joints with their limits, links with their collision bodies, the mounts;
// arm_hash: tells whether two arms are the same to a planner.

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

/// rad, rad/s, rad/s², for prismatic joints m, m/s, m/s².
struct JointLimits {
  double lower{0.0};
  double upper{0.0};
  double speed{0.0};
  double acceleration{0.0};
};

/// A joint and the link behind it. With q = 0 the link's frame is the joint's; with another q it is turned by q about
/// the axis, or moved by q along it.
struct ArmJoint {
  std::string name;
  JointKind kind{JointKind::revolute};
  Pose T_parent_joint{Pose::Identity()};                 ///< in the frame of the link before
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

/// Around the z axis.
struct CylinderBody {
  double radius_m{0.0};
  double length_m{0.0};
};

/// Triangles, open or closed. Whoever needs a solid takes their convex hull.
struct MeshBody {
  TriangleMesh mesh;
};

struct CollisionBody {
  std::string name;  ///< of the link in the robot's description
  Pose T_link_body{Pose::Identity()};
  std::variant<BoxBody, SphereBody, CylinderBody, MeshBody> shape;
};

/// "box", "sphere", "cylinder", "mesh".
[[nodiscard]] std::string_view kind_of(const CollisionBody& body);

struct ArmLink {
  std::string name;
  std::vector<CollisionBody> bodies;  ///< with those of everything that is fixed to the link, the camera's own too
};

/// What an arm is made of, before anything is checked. Joint i moves link i + 1; link 0 stands still.
struct ArmDescription {
  std::string name;
  Pose T_world_base{Pose::Identity()};     ///< frame of link 0
  std::vector<ArmJoint> joints;            ///< base first
  std::vector<ArmLink> links;              ///< one more than joints
  std::string flange_name;                 ///< the frame that tools and the camera are screwed to
  Pose T_link_flange{Pose::Identity()};    ///< in the frame of the last link
  std::string camera_name;                 ///< the camera's optical frame
  Pose T_flange_camera{Pose::Identity()};  ///< hand-eye transform; optical frame: x right, y down, z forward
};

/// An arm that has been checked. Immutable; safe for concurrent use.
class ArmModel {
 public:
  /// invalid_argument, with the joint or link at fault, for no joint or more than kMaxJoints, numbers of links and
  /// joints that disagree, an axis shorter than 1e-6, transforms that are not rigid or longer than 1 km, limits that
  /// are not finite (but for the positions of continuous joints, which become infinite), lower ≥ upper, speeds or
  /// accelerations that are not positive, sizes of bodies that are not, and meshes without triangles or with bad
  /// indices.
  [[nodiscard]] static Result<ArmModel> create(ArmDescription description);

  [[nodiscard]] const std::string& name() const { return description_.name; }
  /// Number of joints.
  [[nodiscard]] int dof() const { return static_cast<int>(description_.joints.size()); }
  [[nodiscard]] const std::vector<ArmJoint>& joints() const { return description_.joints; }
  [[nodiscard]] const std::vector<ArmLink>& links() const { return description_.links; }
  [[nodiscard]] const ArmJoint& joint(int i) const { return description_.joints[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Pose& T_world_base() const { return description_.T_world_base; }
  /// In the frame of the last link.
  [[nodiscard]] const Pose& T_link_camera() const { return T_link_camera_; }
  /// Everything, as it was checked; to change something, change a copy and create() again.
  [[nodiscard]] const ArmDescription& description() const { return description_; }

  /// Middle of the limits; 0 for continuous joints.
  [[nodiscard]] const Configuration& middle() const { return middle_; }
  /// Whether every joint is within its limits, by `tolerance` beyond them too.
  [[nodiscard]] bool within_limits(const Configuration& q, double tolerance = 0.0) const;

 private:
  explicit ArmModel(ArmDescription description);
  ArmDescription description_;
  Pose T_link_camera_;
  Configuration middle_;
};

/// The same arm with this share of its speeds, and accelerations such that every path takes 1 / share as long. Expects
/// a share in (0, 1].
[[nodiscard]] ArmModel slowed(const ArmModel& arm, double share);

/// Draws a configuration within the limits, continuous joints within ±π.
[[nodiscard]] Configuration sample_configuration(const ArmModel& arm, SeededRandom& random);
/// 16 hexadecimal digits from all that changes how an arm moves and what it touches: joints, limits, mounts and
/// bodies. Names do not. Fnv1a. O(vertices).
[[nodiscard]] std::string arm_hash(const ArmModel& arm);

}  // namespace saccade
