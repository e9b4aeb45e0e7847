// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationAction: an action of a client on an annotation. check_action: checks one on its own. ActionHistory: all
// actions, which of them are undone, and the state that the others leave.

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <variant>
#include <vector>

#include "saccade/annotate/label_table.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Makes points control points of a label (thesis §4.2.1); existing ones change label and start cost.
struct SetControlPoints {
  std::vector<std::uint32_t> points;
  std::uint32_t label{1};
  double start_cost{0.0};  ///< in [0, Ω_max), as in Root
  [[nodiscard]] bool operator==(const SetControlPoints&) const = default;
};

/// Removes control points; other points stay unchanged.
struct RemoveControlPoints {
  std::vector<std::uint32_t> points;
  [[nodiscard]] bool operator==(const RemoveControlPoints&) const = default;
};

/// Moves a control point with its label and start cost to another point, replacing one that may be there.
struct MoveControlPoint {
  std::uint32_t from{0};
  std::uint32_t to{0};
  [[nodiscard]] bool operator==(const MoveControlPoint&) const = default;
};

/// Paints points with a label, whatever tree they belong to (the thesis' rectangular selection, §4.2.2).
struct PaintPoints {
  std::vector<std::uint32_t> points;
  std::uint32_t label{1};  ///< kNoLabel: they follow their trees again
  [[nodiscard]] bool operator==(const PaintPoints&) const = default;
};

/// Replaces the definitions of labels.
struct DefineLabels {
  std::vector<NumberedLabel> labels;
  [[nodiscard]] bool operator==(const DefineLabels&) const = default;
};

/// Removes all control points and paint; definitions and locks of labels stay.
struct ClearAnnotation {
  [[nodiscard]] bool operator==(const ClearAnnotation&) const = default;
};

/// Undoes the client's latest action that is not undone.
struct UndoAction {
  [[nodiscard]] bool operator==(const UndoAction&) const = default;
};

/// Redoes the client's last undone action, unless a new action replaced it.
struct RedoAction {
  [[nodiscard]] bool operator==(const RedoAction&) const = default;
};

/// Locks a label: from now on these points, which have it, keep it, whatever is painted and whichever control points
/// are set, moved or removed; and nothing may be set or painted with it. Or unlocks it.
struct LockLabel {
  std::uint32_t label{1};
  bool locked{true};
  std::vector<std::uint32_t> points;  ///< all with the label at that time; none to unlock
  [[nodiscard]] bool operator==(const LockLabel&) const = default;
};

/// Paints points with several labels, one each (labels that are carried from another cloud).
struct PaintLabels {
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<std::uint32_t> labels;  ///< one per point
  [[nodiscard]] bool operator==(const PaintLabels&) const = default;
};

using AnnotationChange = std::variant<SetControlPoints, RemoveControlPoints, MoveControlPoint, PaintPoints,
                                      DefineLabels, ClearAnnotation, UndoAction, RedoAction, LockLabel, PaintLabels>;

struct AnnotationAction {
  std::uint64_t client{0};  ///< client whose undo takes it back
  AnnotationChange change;
  [[nodiscard]] bool operator==(const AnnotationAction&) const = default;
};

/// Answers invalid_argument unless the action names at least one point of a cloud of `points` points, each once; valid
/// labels, each definition once, with valid text; and a start cost in [0, max_path). O(k log k) for k points.
[[nodiscard]] Status check_action(const AnnotationAction& action, std::size_t points, double max_path);

struct ControlPoint {
  std::uint32_t point{0};
  std::uint32_t label{1};
  double start_cost{0.0};
  [[nodiscard]] bool operator==(const ControlPoint&) const = default;
};

/// Slots that may have changed: control points and paint by point, definitions and locks by label. Unordered, with some
/// duplicates.
struct SlotChanges {
  std::vector<std::uint32_t> control_points;
  std::vector<std::uint32_t> painted;
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> locks;
};

/// History of actions. The state results from the actions that are not undone, performed one after the other in order
/// of arrival, whatever their client. An undo takes an action out of the middle, and a redo puts it back in its place.
/// Undo and redo are per client and unlimited; a new action of a client discards what it could redo. One writer.
///
/// Every action writes slots: the control point at a point, the paint on a point, the definition or lock of a label. A
/// slot has the value given by its latest writer that is not undone. Memory: 4 bytes per point of the cloud from the
/// first paint on, and 12 per point that an action names.
class ActionHistory {
 public:
  explicit ActionHistory(std::size_t points) : points_{points} {}

  /// Adds an action. Expects one that check_action accepts. nullopt: the client has nothing to undo or redo, and
  /// nothing is recorded. O(k log n) for k slots written by the actions to be done or undone, more where control points
  /// were moved on.
  std::optional<SlotChanges> push(AnnotationAction action);
  /// Returns every slot that was ever written.
  [[nodiscard]] SlotChanges written() const;

  [[nodiscard]] std::optional<ControlPoint> control_point(std::uint32_t point) const { return before(point, kNone); }
  [[nodiscard]] std::uint32_t painted(std::uint32_t point) const;
  /// Returns nullptr for a label that is not defined.
  [[nodiscard]] const LabelInfo* definition(std::uint32_t label) const;

  /// Returns the locks that hold, in order of arrival: where two name a point, the later one counts.
  [[nodiscard]] std::vector<const LockLabel*> locks() const;

  [[nodiscard]] bool can_undo(std::uint64_t client) const;
  [[nodiscard]] bool can_redo(std::uint64_t client) const;
  /// Returns the number of recorded actions, including undo and redo.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns the actions that are not undone, in order of arrival; without undo and redo.
  [[nodiscard]] std::vector<AnnotationAction> active() const;

 private:
  static constexpr std::uint32_t kNone{std::numeric_limits<std::uint32_t>::max()};

  struct Entry {
    AnnotationAction action;
    bool active{false};
    std::optional<ControlPoint> moved;  ///< control point found by an active MoveControlPoint
  };
  struct Client {
    std::vector<std::uint32_t> done;  ///< entries, ascending
    std::vector<std::uint32_t> undone;
  };
  struct PaintWrite {
    std::uint32_t entry;
    std::uint32_t previous;  ///< previous write on this point
  };
  struct LabelWrite {
    std::uint32_t entry;
    std::size_t index;  ///< in DefineLabels
  };

  void keep(AnnotationAction action, SlotChanges& changes);
  void set_active(std::uint32_t entry, bool active, SlotChanges& changes);
  void set_move_active(std::uint32_t entry, bool active, SlotChanges& changes);
  void set_clear_active(std::uint32_t entry, bool active, SlotChanges& changes);
  void follow_moves(SlotChanges& changes);
  void ripple(std::uint32_t point, std::uint32_t entry, SlotChanges& changes);
  [[nodiscard]] std::optional<ControlPoint> before(std::uint32_t point, std::uint32_t entry) const;
  [[nodiscard]] std::optional<std::uint32_t> clear_before(std::uint32_t entry) const;

  std::size_t points_;
  std::uint64_t size_{0};
  std::vector<Entry> entries_;
  std::map<std::uint64_t, Client> clients_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> control_writers_;  ///< entries by point, ascending
  std::vector<PaintWrite> paint_writes_;
  std::vector<std::uint32_t> paint_heads_;  ///< latest write by point; empty before the first
  std::map<std::uint32_t, std::vector<LabelWrite>> label_writers_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> lock_writers_;  ///< entries by label, ascending
  std::set<std::uint32_t> clears_;                                    ///< active ClearAnnotation
  std::set<std::uint32_t> moves_;                                     ///< active MoveControlPoint
  std::set<std::uint32_t> stale_;  ///< active moves that may find another control point than before
};

}  // namespace saccade
