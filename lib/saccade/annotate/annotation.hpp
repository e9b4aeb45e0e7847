// SPDX-License-Identifier: Apache-2.0
#pragma once
// Annotation: labels of a cloud's points from control points and paint, in memory. Thesis §4.2.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/label_table.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

/// Result of an action. The spans are valid until the next action, without duplicates.
struct Applied {
  /// False: the client has nothing to undo or redo; nothing has changed, and the action does not count.
  bool done{true};
  std::uint64_t sequence{0};                      ///< number of actions so far, including this one
  std::span<const std::uint32_t> points;          ///< points with a new label
  std::span<const std::uint32_t> control_points;  ///< points that became, ceased to be, or changed as control points
  std::span<const std::uint32_t> labels;          ///< labels whose definition or lock changed
};

/// Annotation in two layers: control points, whose trees divide the points among them (ShortestPathForest), and paint
/// above, which labels points individually. A point has the label that is locked on it; without a lock that of its
/// paint; without paint that of its tree's control point; without a tree none. With several clients, actions count in
/// order of arrival, and undo is per client (ActionHistory). The state depends on the actions alone. One writer; about
/// 40 bytes per point.
class Annotation {
 public:
  /// Changes of many points use the executor's threads; their number never changes the state.
  explicit Annotation(const std::shared_ptr<const Neighbourhood>& neighbourhood, const Executor& executor = {});

  /// Answers invalid_argument as check_action, and for control points and paint on points without neighbours, such as
  /// those that are not finite; for setting, moving and painting with a locked label, and on points of one; for
  /// removing or moving a control point that does not exist.
  [[nodiscard]] Status validate(const AnnotationAction& action) const;
  /// Applies an action. Expects one that validate accepts. O(points whose tree may change), as ShortestPathForest's add
  /// and remove.
  Applied apply(AnnotationAction action);
  /// Applies actions from the start, including undo and redo, with a single build of the forest at the end. Expects
  /// that check_action accepts them and that there were none before.
  void restore(std::span<const AnnotationAction> actions);

  /// Returns the label of each point, kNoLabel where it has none.
  [[nodiscard]] std::span<const std::uint32_t> labels() const { return labels_; }
  [[nodiscard]] std::uint32_t label_of(std::uint32_t point) const { return labels_[point]; }
  /// Returns the paint of a point; kNoLabel: the point follows its tree.
  [[nodiscard]] std::uint32_t painted(std::uint32_t point) const {
    return painted_.empty() ? kNoLabel : painted_[point];
  }
  /// Returns the label that is locked on a point; kNoLabel: none.
  [[nodiscard]] std::uint32_t locked(std::uint32_t point) const { return locked_.empty() ? kNoLabel : locked_[point]; }
  [[nodiscard]] bool is_locked(std::uint32_t label) const { return locks_.contains(label); }
  /// Returns the number of points by label, for labels that have some.
  [[nodiscard]] const std::map<std::uint32_t, std::size_t>& counts() const { return counts_; }
  /// Returns the control points in ascending order of points.
  [[nodiscard]] std::vector<ControlPoint> control_points() const;
  [[nodiscard]] std::optional<ControlPoint> control_point(std::uint32_t point) const;
  [[nodiscard]] const LabelTable& label_table() const { return table_; }
  [[nodiscard]] const ActionHistory& history() const { return history_; }
  [[nodiscard]] const ShortestPathForest& forest() const { return forest_; }

 private:
  /// Points that changed from one label to another.
  struct Moved {
    std::uint32_t from{kNoLabel};
    std::uint32_t to{kNoLabel};
    std::size_t points{0};
  };

  [[nodiscard]] Status check_locks(const AnnotationAction& action) const;
  void change_locks(std::span<const std::uint32_t> slots);
  void change_slots(const SlotChanges& slots);
  void change_control_points(std::span<const std::uint32_t> slots);
  void change_forest(const std::vector<ControlPoint>& placed, const std::vector<std::uint32_t>& removed);
  void change_definitions(std::span<const std::uint32_t> slots);
  void relabel();
  void count(const Moved& moved);

  Executor executor_;
  ShortestPathForest forest_;
  ActionHistory history_;
  LabelTable table_;
  std::unordered_map<std::uint32_t, ControlPoint> control_;
  std::vector<std::uint32_t> painted_;  ///< empty before the first paint
  std::vector<std::uint32_t> locked_;   ///< empty before the first lock
  std::set<std::uint32_t> locks_;       ///< locked labels
  std::vector<std::uint32_t> labels_;
  std::map<std::uint32_t, std::size_t> counts_;
  std::vector<std::uint32_t> suspects_;    ///< points whose label may change by this action, with some duplicates
  std::vector<std::uint32_t> labels_now_;  ///< current labels of the suspects
  std::vector<std::uint32_t> changed_points_;
  std::vector<std::uint32_t> changed_control_points_;
  std::vector<std::uint32_t> changed_labels_;
};

}  // namespace saccade
