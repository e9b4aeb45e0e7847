// SPDX-License-Identifier: Apache-2.0
#pragma once
// UrdfTree: links and joints of a URDF, and queries about them.

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

[[nodiscard]] inline bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

/// Tree of links and joints. Expects a tree, as parse_urdf_document() ensures; the model must outlive it.
class UrdfTree {
 public:
  explicit UrdfTree(const urdf::ModelInterface& model);

  [[nodiscard]] bool has(const std::string& link) const { return model_.links_.count(link) > 0; }
  [[nodiscard]] std::string root() const { return model_.root_link_->name; }
  [[nodiscard]] urdf::LinkConstSharedPtr link(const std::string& name) const { return model_.links_.at(name); }
  /// Returns all names, in alphabetical order.
  [[nodiscard]] std::vector<std::string> links() const;
  /// Returns the joints whose parent is the link, in alphabetical order.
  [[nodiscard]] const std::vector<urdf::JointSharedPtr>& below(const std::string& link) const;

  /// Returns the joints from base to link, base first; nullopt where link is not below base.
  [[nodiscard]] std::optional<std::vector<urdf::JointSharedPtr>> path(const std::string& base,
                                                                      const std::string& link) const;
  /// Returns the link behind the last moving joint on the path to `link`; base where none moves.
  [[nodiscard]] std::string last_moving(const std::string& base, const std::string& link) const;

  /// Returns the joint that `joint` follows (<mimic>), through others that follow; nullptr where that is not a joint of
  /// the file, or a cycle.
  [[nodiscard]] urdf::JointConstSharedPtr master(const urdf::Joint& joint) const;
  /// Returns the value of a joint that is not moved: 0, or the nearest limit; for one that follows another, the value
  /// set by that one.
  [[nodiscard]] double standing_value(const urdf::Joint& joint) const;

  /// Returns the links with the most similar names, three at most; none where no name is similar.
  [[nodiscard]] std::vector<std::string> nearest(const std::string& name) const;

 private:
  [[nodiscard]] urdf::JointConstSharedPtr followed(const urdf::Joint& joint) const;

  const urdf::ModelInterface& model_;
  std::map<std::string, urdf::JointSharedPtr> above_;
  std::map<std::string, std::vector<urdf::JointSharedPtr>> below_;
};

/// Converts to lower case, independent of the locale.
[[nodiscard]] std::string in_small_letters(std::string text);

}  // namespace saccade
