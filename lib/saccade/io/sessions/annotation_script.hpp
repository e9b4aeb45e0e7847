// SPDX-License-Identifier: Apache-2.0
#pragma once
// Annotation scripts: actions on a cloud as text, one JSON object per line. docs/formats.md.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// A point by its index, or the place (metres) that it is near.
using ScriptedPoint = std::variant<std::uint32_t, Eigen::Vector3d>;

/// Farther from a place there is no point that it means, unless a script says otherwise.
inline constexpr double kScriptedReach_m{0.05};

/// What a tool selects in a picture: select_points, or select_around for a stroke with a radius in metres.
struct ScriptedSelection {
  SelectionView view;
  ScreenShape shape;
  double below_m{0.0};             ///< behind the visible surface
  std::optional<double> radius_m;  ///< of balls along a ScreenStroke; then below_m plays no part
};

/// One line. Which points it is about is known once there is a cloud (resolve_action).
struct ScriptedAction {
  std::size_t line{0};                  ///< of the script, from 1
  std::optional<std::uint64_t> client;  ///< none: whoever runs the script
  AnnotationChange change;              ///< without its points
  std::vector<ScriptedPoint> points;    ///< of a move: from and to
  double within_m{kScriptedReach_m};    ///< from a place
  std::optional<ScriptedSelection> selection;
};

/// Blank lines and lines that begin with # are passed over.
/// @return corrupt_data with the line for what is no action. O(text).
[[nodiscard]] Result<std::vector<ScriptedAction>> parse_annotation_script(std::string_view text);
/// The same of a file; not_found and io_failure.
[[nodiscard]] Result<std::vector<ScriptedAction>> read_annotation_script(const std::filesystem::path& path);

/// What can be said of a script before its first action is done: check_action, for points that are named by index.
/// @return invalid_argument with the line.
[[nodiscard]] Status check_script(std::span<const ScriptedAction> script, std::size_t points, double max_path);

/// The action on this cloud. A place means the nearest point that is finite; where a control point is removed or moved
/// from, the nearest control point. Of several places that mean one point, one counts; of what is selected to be
/// removed, the control points.
/// @param client  of lines that name none.
/// @return invalid_argument with the line where a place has no point near enough, or nothing is selected.
/// O(points) per place; a selection as select_points.
[[nodiscard]] Result<AnnotationAction> resolve_action(const ScriptedAction& scripted,
                                                      std::span<const Eigen::Vector3f> positions_m,
                                                      const Annotation& annotation, std::uint64_t client,
                                                      const Executor& executor);

}  // namespace saccade
