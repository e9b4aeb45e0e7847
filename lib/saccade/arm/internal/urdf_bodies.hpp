// SPDX-License-Identifier: Apache-2.0
#pragma once
// UrdfBodies: collision bodies from a URDF's links, and what stands in for missing ones.

#include <urdf_model/link.h>

#include <filesystem>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/internal/urdf_packages.hpp"
#include "saccade/arm/urdf.hpp"

namespace saccade {

/// Reader of bodies. A link without <collision> gets the bodies of its <visual>, meshes as the convex hull of each. One
/// thread.
class UrdfBodies {
 public:
  UrdfBodies(const std::filesystem::path& folder, const UrdfConfig& config) : packages_{folder, config} {}

  /// Appends the bodies of a link. Answers corrupt_data, not_found or unsupported for <collision> that cannot be read,
  /// and for lengths beyond sense; a <visual> that cannot be read is a remark.
  [[nodiscard]] Status add(const urdf::Link& link, const Pose& T_link_frame, std::vector<CollisionBody>& bodies);

  /// Returns what is to be said about all links together, one sentence each: stand-ins, missing bodies, improbable
  /// sizes.
  [[nodiscard]] std::vector<std::string> remarks() const;

 private:
  [[nodiscard]] Status add_visuals(const urdf::Link& link, const Pose& T_link_frame,
                                   std::vector<CollisionBody>& bodies);
  [[nodiscard]] Result<CollisionBody> body_of(const urdf::Geometry* geometry, const urdf::Pose& origin,
                                              const std::string& link);
  [[nodiscard]] Result<TriangleMesh> mesh_of(const urdf::Mesh& mesh, const std::string& where);
  /// Compares a body's size with that of arms; `scaled`: its mesh has a scale.
  [[nodiscard]] Status check_size(const CollisionBody& body, bool scaled, const std::string& where);

  UrdfPackages packages_;
  std::size_t bodies_{0};
  std::vector<std::string> stand_ins_;  ///< links whose <visual> is taken
  std::vector<std::string> lost_;       ///< reasons why a link's <visual> is not
  std::vector<std::string> sizes_;      ///< links with improbable sizes
};

/// Returns the number with at most six decimals: "0.5".
[[nodiscard]] std::string short_number(double value);

}  // namespace saccade
