// SPDX-License-Identifier: Apache-2.0
#pragma once
// UrdfTree: links and joints of a URDF, and what is asked about them.

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

[[nodiscard]] inline bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

/// Expects a tree, as parse_urdf_document() makes sure; the model must outlive it.
class UrdfTree {
 public:
  explicit UrdfTree(const urdf::ModelInterface& model);

  [[nodiscard]] bool has(const std::string& link) const { return model_.links_.count(link) > 0; }
  [[nodiscard]] std::string root() const { return model_.root_link_->name; }
  [[nodiscard]] urdf::LinkConstSharedPtr link(const std::string& name) const { return model_.links_.at(name); }
  /// All names, in alphabetical order.
  [[nodiscard]] std::vector<std::string> links() const;
  /// Joints whose parent the link is, in alphabetical order.
  [[nodiscard]] const std::vector<urdf::JointSharedPtr>& below(const std::string& link) const;

  /// Joints from base to link, base first; nullopt where link is not below base.
  [[nodiscard]] std::optional<std::vector<urdf::JointSharedPtr>> path(const std::string& base,
                                                                      const std::string& link) const;
  /// The link behind the last joint that moves on the way to `link`; base where none does.
  [[nodiscard]] std::string last_moving(const std::string& base, const std::string& link) const;

  /// The joint that `joint` follows (<mimic>), through others that follow; nullptr where that is no joint of the file,
  /// or itself in the end.
  [[nodiscard]] urdf::JointConstSharedPtr master(const urdf::Joint& joint) const;
  /// Where a joint stands that is not moved: at 0, or at the limit next to it; one that follows another, where that
  /// one puts it.
  [[nodiscard]] double standing_value(const urdf::Joint& joint) const;

  /// The links whose names are the most like this one, three at most; none where no name is like it.
  [[nodiscard]] std::vector<std::string> nearest(const std::string& name) const;

 private:
  [[nodiscard]] urdf::JointConstSharedPtr followed(const urdf::Joint& joint) const;

  const urdf::ModelInterface& model_;
  std::map<std::string, urdf::JointSharedPtr> above_;
  std::map<std::string, std::vector<urdf::JointSharedPtr>> below_;
};

/// In small letters, without regard to the locale.
[[nodiscard]] std::string in_small_letters(std::string text);

}  // namespace saccade
