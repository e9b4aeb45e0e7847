// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationAction: what one client does to an annotation. check_action: what can be said of one by itself.

#include <cstdint>
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

}  // namespace saccade
