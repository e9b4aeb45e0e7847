// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationAction: what one client does to an annotation; check_action: what can be said of one by itself;
// ActionHistory: all of them, which of them are undone, and what the others leave.

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

/// Points become control points of a label (thesis §4.2.1); those that are already take on label and start cost.
struct SetControlPoints {
  std::vector<std::uint32_t> points;
  std::uint32_t label{1};
  double start_cost{0.0};  ///< in [0, Ω_max), as in Root
  [[nodiscard]] bool operator==(const SetControlPoints&) const = default;
};

/// Points are control points no more; of those that are none nothing changes.
struct RemoveControlPoints {
  std::vector<std::uint32_t> points;
  [[nodiscard]] bool operator==(const RemoveControlPoints&) const = default;
};

/// A control point goes to another point, with its label and start cost, in place of one that may be there.
struct MoveControlPoint {
  std::uint32_t from{0};
  std::uint32_t to{0};
  [[nodiscard]] bool operator==(const MoveControlPoint&) const = default;
};

/// Points have a label whatever tree they belong to (the thesis' rectangular selection, §4.2.2).
struct PaintPoints {
  std::vector<std::uint32_t> points;
  std::uint32_t label{1};  ///< kNoLabel: they follow their trees again
  [[nodiscard]] bool operator==(const PaintPoints&) const = default;
};

/// What is known of labels becomes this.
struct DefineLabels {
  std::vector<NumberedLabel> labels;
  [[nodiscard]] bool operator==(const DefineLabels&) const = default;
};

/// No control points and no paint; definitions of labels stay.
struct ClearAnnotation {
  [[nodiscard]] bool operator==(const ClearAnnotation&) const = default;
};

/// Takes back the client's latest action that is not undone.
struct UndoAction {
  [[nodiscard]] bool operator==(const UndoAction&) const = default;
};

/// Brings back what the client undid last and did not replace by a new action.
struct RedoAction {
  [[nodiscard]] bool operator==(const RedoAction&) const = default;
};

using AnnotationChange = std::variant<SetControlPoints, RemoveControlPoints, MoveControlPoint, PaintPoints,
                                      DefineLabels, ClearAnnotation, UndoAction, RedoAction>;

struct AnnotationAction {
  std::uint64_t client{0};  ///< whose undo takes it back
  AnnotationChange change;
  [[nodiscard]] bool operator==(const AnnotationAction&) const = default;
};

/// invalid_argument unless it names points of a cloud of so many, each once and at least one; labels that are some,
/// each once, with fit text; and a start cost in [0, max_path). O(k log k) for k points.
[[nodiscard]] Status check_action(const AnnotationAction& action, std::size_t points, double max_path);

struct ControlPoint {
  std::uint32_t point{0};
  std::uint32_t label{1};
  double start_cost{0.0};
  [[nodiscard]] bool operator==(const ControlPoint&) const = default;
};

/// What may have another value now: control points and paint by point, definitions by label. In no order; some twice.
struct SlotChanges {
  std::vector<std::uint32_t> control_points;
  std::vector<std::uint32_t> painted;
  std::vector<std::uint32_t> labels;
};

/// The state is what the actions that are not undone leave, done one after the other in the order in which they came,
/// by whatever client. So an undo takes an action out of the middle, and a redo puts it back to where it was. Undo and
/// redo go by client and without limit; a new action of a client ends what it could redo. One writer.
///
/// Every action writes slots: the control point at a point, the paint on a point, the definition of a label. A slot has
/// the value that its latest writer that is not undone gave. Memory: 4 bytes per point of the cloud from the first
/// paint on, and 12 per point that an action names.
class ActionHistory {
 public:
  explicit ActionHistory(std::size_t points) : points_{points} {}

  /// Expects an action that check_action accepts. None: the client has nothing to undo or redo, and nothing is kept.
  /// O(k log n) for k slots that the actions to be done or undone write, more where control points were moved on.
  std::optional<SlotChanges> push(AnnotationAction action);
  /// Every slot that was ever written.
  [[nodiscard]] SlotChanges written() const;

  [[nodiscard]] std::optional<ControlPoint> control_point(std::uint32_t point) const { return before(point, kNone); }
  [[nodiscard]] std::uint32_t painted(std::uint32_t point) const;
  /// None: not defined.
  [[nodiscard]] const LabelInfo* definition(std::uint32_t label) const;

  [[nodiscard]] bool can_undo(std::uint64_t client) const;
  [[nodiscard]] bool can_redo(std::uint64_t client) const;
  /// Actions that were kept, undo and redo among them.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Those that are not undone, in the order in which they came; without undo and redo.
  [[nodiscard]] std::vector<AnnotationAction> active() const;

 private:
  static constexpr std::uint32_t kNone{std::numeric_limits<std::uint32_t>::max()};

  struct Entry {
    AnnotationAction action;
    bool active{false};
    std::optional<ControlPoint> moved;  ///< of an active MoveControlPoint: what it found
  };
  struct Client {
    std::vector<std::uint32_t> done;  ///< entries, ascending
    std::vector<std::uint32_t> undone;
  };
  struct PaintWrite {
    std::uint32_t entry;
    std::uint32_t previous;  ///< write on the same point
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
  std::set<std::uint32_t> clears_;  ///< active ClearAnnotation
  std::set<std::uint32_t> moves_;   ///< active MoveControlPoint
  std::set<std::uint32_t> stale_;   ///< active moves that may find another control point than they did
};

}  // namespace saccade
