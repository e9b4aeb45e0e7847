// SPDX-License-Identifier: Apache-2.0
#pragma once
// Annotation: labels of a cloud's points from control points and paint, in memory. Thesis §4.2.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/label_table.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

/// What an action did. The spans hold until the next action; none names anything twice.
struct Applied {
  /// False: the client has nothing to undo or redo; nothing has changed, and the action does not count.
  bool done{true};
  std::uint64_t sequence{0};                      ///< how many actions there are with this one
  std::span<const std::uint32_t> points;          ///< those with another label than before
  std::span<const std::uint32_t> control_points;  ///< points that are a control point now or were one, and differ
  std::span<const std::uint32_t> labels;          ///< numbers of labels of which something else is known
};

/// Two layers: control points, whose trees share the points among them (ShortestPathForest), and paint above, which
/// labels points one by one. A point has the label of its paint; without paint that of its tree's control point;
/// without a tree none. Several clients: actions count in the order in which they come, and undo is per client
/// (ActionHistory). The state depends on the actions alone. One writer; about 40 bytes per point.
class Annotation {
 public:
  /// What changes many points uses the executor's threads; the state is the same for any number of them.
  explicit Annotation(const std::shared_ptr<const Neighbourhood>& neighbourhood, const Executor& executor = {});

  /// invalid_argument as check_action; for control points and paint on points without neighbours, as those that are not
  /// finite; for removing where no control point is, and moving from where none is.
  [[nodiscard]] Status validate(const AnnotationAction& action) const;
  /// Expects what validate accepts. O(points whose tree may change), as ShortestPathForest's add and remove.
  Applied apply(AnnotationAction action);
  /// Actions from the start, undo and redo among them, with one build of the forest at the end. Expects that
  /// check_action accepts them and that there were none before.
  void restore(std::span<const AnnotationAction> actions);

  /// Of each point, kNoLabel where it has none.
  [[nodiscard]] std::span<const std::uint32_t> labels() const { return labels_; }
  [[nodiscard]] std::uint32_t label_of(std::uint32_t point) const { return labels_[point]; }
  /// kNoLabel: the point follows its tree.
  [[nodiscard]] std::uint32_t painted(std::uint32_t point) const {
    return painted_.empty() ? kNoLabel : painted_[point];
  }
  /// Points by label, of labels that have some.
  [[nodiscard]] const std::map<std::uint32_t, std::size_t>& counts() const { return counts_; }
  /// In ascending order of points.
  [[nodiscard]] std::vector<ControlPoint> control_points() const;
  [[nodiscard]] std::optional<ControlPoint> control_point(std::uint32_t point) const;
  [[nodiscard]] const LabelTable& label_table() const { return table_; }
  [[nodiscard]] const ActionHistory& history() const { return history_; }
  [[nodiscard]] const ShortestPathForest& forest() const { return forest_; }

 private:
  /// Points that went from one label to another.
  struct Moved {
    std::uint32_t from{kNoLabel};
    std::uint32_t to{kNoLabel};
    std::size_t points{0};
  };

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
  std::vector<std::uint32_t> labels_;
  std::map<std::uint32_t, std::size_t> counts_;
  std::vector<std::uint32_t> suspects_;    ///< points whose label may change by this action, some twice
  std::vector<std::uint32_t> labels_now_;  ///< of the suspects
  std::vector<std::uint32_t> changed_points_;
  std::vector<std::uint32_t> changed_control_points_;
  std::vector<std::uint32_t> changed_labels_;
};

}  // namespace saccade
