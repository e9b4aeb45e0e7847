// SPDX-License-Identifier: Apache-2.0
#pragma once
// Annotation scripts: actions on a cloud as text, one JSON object per line. docs/reference/formats.md.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/annotate/action.hpp"
#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/carried_labels.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/annotate/split_label.hpp"
#include "saccade/core/executor.hpp"

namespace saccade {

/// Point by its index, or by a nearby place (metres).
using ScriptedPoint = std::variant<std::uint32_t, Eigen::Vector3d>;

/// Default distance within which a place finds its point.
inline constexpr double kScriptedReach_m{0.05};

/// Selection by a tool in an image: select_points, select_around for a stroke with a radius in metres, or split_label.
struct ScriptedSelection {
  SelectionView view;
  ScreenShape shape;
  double below_m{0.0};             ///< behind the visible surface
  std::optional<double> radius_m;  ///< radius of balls along a ScreenStroke; below_m is then ignored
  std::optional<SplitPart> split;  ///< split_label along a ScreenStroke; below_m is then ignored
};

/// One line of a script. Its points are known once there is a cloud (resolve_action).
struct ScriptedAction {
  std::size_t line{0};                  ///< line of the script, from 1
  std::optional<std::uint64_t> client;  ///< none: the caller's client
  AnnotationChange change;              ///< without its points
  std::vector<ScriptedPoint> points;    ///< for a move: from and to
  double within_m{kScriptedReach_m};    ///< largest distance from a place
  std::optional<ScriptedSelection> selection;
  bool whole_segments{false};  ///< a paint takes all points of the segments that its points are in
  std::string cloud;           ///< file name of the cloud of a sequence that it is for; empty: that of the line before
  CarryConfig carry;           ///< for PaintLabels: labels of the cloud before
};

/// Parses a script, skipping blank lines and lines that begin with #.
/// @return corrupt_data with the line for text that is not an action. O(text).
[[nodiscard]] Result<std::vector<ScriptedAction>> parse_annotation_script(std::string_view text);
/// Reads a script from a file; also answers not_found and io_failure.
[[nodiscard]] Result<std::vector<ScriptedAction>> read_annotation_script(const std::filesystem::path& path);

/// Checks a script before its first action: check_action, for points that are named by index.
/// @return invalid_argument with the line.
[[nodiscard]] Status check_script(std::span<const ScriptedAction> script, std::size_t points, double max_path);

/// Returns the action on this cloud. A place means the nearest finite point; where a control point is removed or moved,
/// the nearest control point. A lock names all points that have its label; paint leaves out points of locked labels.
/// Several places that mean one point count once; of a selection to be removed, only the
/// control points count.
/// @param client  client of lines that name none.
/// @param offset_m  PointCloud::offset_m, subtracted from places and poses of the script, which are in the file's
/// coordinates.
/// @param segments  segment of each point, for whole_segments; 0: none. Empty: there are none.
/// @param before  cloud whose labels are carried; nullptr: there is none.
/// @return invalid_argument with the line where no point is near enough to a place, nothing is selected, the points are
/// in no segment or all locked, no point has the label to be locked, or no point takes a carried label.
/// O(points) per place; a selection as select_points.
[[nodiscard]] Result<AnnotationAction> resolve_action(
    const ScriptedAction& scripted, std::span<const Eigen::Vector3f> positions_m, const Annotation& annotation,
    std::uint64_t client, const Executor& executor, const Eigen::Vector3d& offset_m = Eigen::Vector3d::Zero(),
    std::span<const std::uint32_t> segments = {}, const CarrySource* before = nullptr);

}  // namespace saccade
