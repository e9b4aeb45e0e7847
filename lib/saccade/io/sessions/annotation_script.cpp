// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/annotation_script.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "saccade/annotate/selection.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/sessions/label_presets.hpp"

namespace saccade {
namespace {

using nlohmann::json;

/// Exception while a line is read, turned into an Error at its end.
struct ScriptProblem {
  std::string what;
};

[[noreturn]] void problem(std::string what) { throw ScriptProblem{std::move(what)}; }

void require_valid(const Status& status) {
  if (!status) problem(status.error().message);
}

/// Object that is read key by key.
class KeyedValues {
 public:
  KeyedValues(const json& object, std::string what) : object_{object}, what_{std::move(what)} {
    if (!object.is_object()) problem(what_ + " is an object: {...}");
  }
  [[nodiscard]] const json* find(const std::string& key) {
    asked_.insert(key);
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  [[nodiscard]] const json& need(const std::string& key) {
    const json* value = find(key);
    if (value == nullptr) problem(what_ + " needs the key " + key);
    return *value;
  }
  /// Rejects keys that were not read.
  void finish() const {
    for (const auto& item : object_.items()) {
      if (asked_.contains(item.key())) continue;
      problem("unknown key " + in_quotes(item.key()) + "; " + what_ + " may have " + joined(asked_));
    }
  }

 private:
  const json& object_;
  std::string what_;
  std::set<std::string> asked_;
};

double number_of(const json& value, const std::string& key) {
  if (!value.is_number()) problem(key + " is a number");
  return value.get<double>();
}

template <class T>
T whole_number_of(const json& value, const std::string& key) {
  const bool fits = value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<T>::max();
  if (!fits) problem(key + " is a whole number from 0 to " + std::to_string(std::numeric_limits<T>::max()));
  return static_cast<T>(value.get<std::uint64_t>());
}

template <int N>
Eigen::Matrix<double, N, 1> vector_of(const json& value, const std::string& key) {
  if (!value.is_array() || value.size() != N) problem(key + " is a list of " + std::to_string(N) + " numbers");
  Eigen::Matrix<double, N, 1> vector;
  for (int i = 0; i < N; ++i) vector[i] = number_of(value[static_cast<std::size_t>(i)], "each number of " + key);
  return vector;
}

std::vector<ScreenPoint> line_of(const json& value, const std::string& key) {
  if (!value.is_array()) problem(key + " is a list of pixels: [[u, v], ...]");
  std::vector<ScreenPoint> line;
  for (const json& point : value) line.push_back(vector_of<2>(point, "each pixel of " + key));
  return line;
}

/// Returns the view of a camera at T_world_camera (x right, y down, z forward) of everything at least 1 mm in front of
/// it.
Eigen::Matrix4d clip_of(const Pose& T_world_camera, double fov_rad, int width, int height) {
  constexpr double kNear_m{0.001};
  const double focal = 1.0 / std::tan(0.5 * fov_rad);  // in half heights
  Eigen::Matrix4d clip_camera{Eigen::Matrix4d::Zero()};
  clip_camera(0, 0) = focal * height / width;
  clip_camera(1, 1) = -focal;
  clip_camera(2, 2) = 1.0;
  clip_camera(2, 3) = -2.0 * kNear_m;
  clip_camera(3, 2) = 1.0;
  return clip_camera * T_world_camera.inverse(Eigen::Isometry).matrix();
}

Eigen::Matrix4d matrix_of(const json& value, const std::string& key) {
  if (!value.is_array() || value.size() != 4) problem(key + " is a list of four rows of four numbers");
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 4; ++i) matrix.row(i) = vector_of<4>(value[static_cast<std::size_t>(i)], "each row of " + key);
  return matrix;
}

SelectionView view_of(const json& value) {
  KeyedValues keys{value, "a view"};
  SelectionView view;
  const Eigen::Vector2d size = vector_of<2>(keys.need("size"), "size");
  constexpr double kMost_px{1e6};  // keeps it an int; the view has its own limits
  if ((size.array() != size.array().round()).any() || size.cwiseAbs().maxCoeff() > kMost_px) {
    problem("size is [width, height] in whole pixels");
  }
  view.width = static_cast<int>(size.x());
  view.height = static_cast<int>(size.y());
  if (const json* point_size = keys.find("point_size_px")) {
    view.point_size_px = static_cast<int>(whole_number_of<std::uint16_t>(*point_size, "point_size_px"));
  }
  if (const json* clip = keys.find("clip_world")) {
    view.clip_world = matrix_of(*clip, "clip_world");
  } else {
    const auto pose = pose_from_json(keys.need("T_world_camera"));
    if (!pose) problem("T_world_camera: " + pose.error().message);
    const double fov_deg = number_of(keys.need("fov_deg"), "fov_deg");
    if (!(fov_deg > 0.0 && fov_deg < 180.0)) problem("fov_deg is more than 0 and less than 180");
    view.clip_world = clip_of(*pose, fov_deg * 1_deg, view.width, view.height);
  }
  if (const json* planes = keys.find("clip_planes")) {
    if (!planes->is_array()) problem("clip_planes is a list of planes: [[a, b, c, d], ...]");
    for (const json& plane : *planes) view.planes.emplace_back(vector_of<4>(plane, "each of clip_planes"));
  }
  keys.finish();
  require_valid(view.validate());
  return view;
}

double depth_of(const json& value) {
  if (value == "any") return kAnyDepth_m;
  const double below_m = value.is_number() ? value.get<double>() : -1.0;
  if (!(below_m >= 0.0)) problem("below_m is \"any\" or a number of metres that is not negative");
  return below_m;
}

ScreenShape brush_of(const json& value, std::optional<double>& radius_m) {
  KeyedValues keys{value, "a brush"};
  ScreenStroke stroke{line_of(keys.need("line"), "line")};
  const json* px = keys.find("radius_px");
  const json* m = keys.find("radius_m");
  keys.finish();
  if ((px == nullptr) == (m == nullptr)) problem("a brush has either radius_px or radius_m");
  if (px != nullptr) stroke.radius_px = number_of(*px, "radius_px");
  if (m != nullptr) {
    radius_m = number_of(*m, "radius_m");
    if (!(*radius_m > 0.0)) problem("radius_m is positive");
  }
  return stroke;
}

ScreenShape split_of(const json& value, std::optional<SplitPart>& part) {
  KeyedValues keys{value, "a split"};
  ScreenStroke stroke{line_of(keys.need("line"), "line")};
  const json* which = keys.find("part");
  keys.finish();
  if (which != nullptr && *which != "smaller" && *which != "larger") problem("part is \"smaller\" or \"larger\"");
  part = which != nullptr && *which == "larger" ? SplitPart::larger : SplitPart::smaller;
  return stroke;
}

/// Returns the selection of a line's keys; nullopt where it has none of them.
std::optional<ScriptedSelection> selection_of(KeyedValues& line, const std::optional<SelectionView>& view) {
  const json* rectangle = line.find("rectangle");
  const json* lasso = line.find("lasso");
  const json* polyline = line.find("polyline");
  const json* brush = line.find("brush");
  const json* split = line.find("split");
  const json* below = line.find("below_m");
  const int shapes =
      (rectangle != nullptr) + (lasso != nullptr) + (polyline != nullptr) + (brush != nullptr) + (split != nullptr);
  if (shapes == 0) {
    if (below != nullptr) problem("below_m goes with a rectangle, lasso, polyline or brush");
    return std::nullopt;
  }
  if (shapes > 1) problem("one rectangle, lasso, polyline, brush or split is selected with, not several");
  if (!view) problem("a selection needs a view, in its line or in one before");
  ScriptedSelection selection{*view, {}, kOnSurface_m, {}, {}};
  if (rectangle != nullptr) {
    const Eigen::Vector4d corners = vector_of<4>(*rectangle, "rectangle");
    selection.shape = ScreenRectangle{corners.head<2>(), corners.tail<2>()};
  } else if (split != nullptr) {
    selection.shape = split_of(*split, selection.split);
  } else if (brush != nullptr) {
    selection.shape = brush_of(*brush, selection.radius_m);
  } else {
    selection.shape =
        lasso != nullptr ? ScreenPolygon{line_of(*lasso, "lasso")} : ScreenPolygon{line_of(*polyline, "polyline")};
  }
  if (below != nullptr) {
    if (selection.radius_m) problem("a brush with radius_m selects balls; below_m says nothing more");
    if (selection.split) problem("a split cuts however deep; below_m says nothing more");
    selection.below_m = depth_of(*below);
  }
  require_valid(validate(selection.shape));
  return selection;
}

ScriptedPoint point_of(const json& value, const std::string& key) {
  if (value.is_array()) return vector_of<3>(value, key);
  if (!value.is_number_unsigned()) problem(key + " is the index of a point, or a place [x, y, z] in metres");
  return whole_number_of<std::uint32_t>(value, key);
}

std::vector<NumberedLabel> labels_of(const json& list) {
  const auto labels = parse_label_presets(json{{"labels", list}}.dump());
  if (!labels) problem(labels.error().message);
  return *labels;
}

/// Reader of a script line by line; a view also applies to the lines after it.
class ScriptReader {
 public:
  ScriptedAction read(const json& value) {
    KeyedValues line{value, "an action"};
    ScriptedAction action;
    const json& kind = line.need("do");
    if (!kind.is_string()) problem("do is a word, such as \"set\"");
    if (const json* client = line.find("client")) action.client = whole_number_of<std::uint64_t>(*client, "client");
    if (const json* cloud = line.find("cloud")) {
      if (!cloud->is_string() || cloud->get<std::string>().empty()) problem("cloud is the name of a cloud's file");
      action.cloud = cloud->get<std::string>();
    }
    read_kind(kind.get<std::string>(), line, action);
    line.finish();
    return action;
  }

 private:
  void read_kind(const std::string& kind, KeyedValues& line, ScriptedAction& action) {
    if (kind == "set") {
      SetControlPoints set;
      set.label = whole_number_of<std::uint32_t>(line.need("label"), "label");
      if (const json* cost = line.find("start_cost")) set.start_cost = number_of(*cost, "start_cost");
      action.change = set;
      read_points(line, action, false);
    } else if (kind == "remove") {
      action.change = RemoveControlPoints{};
      read_points(line, action, true);
    } else if (kind == "move") {
      action.change = MoveControlPoint{};
      action.points = {point_of(line.need("from"), "from"), point_of(line.need("to"), "to")};
      read_reach(line, action);
    } else if (kind == "paint") {
      action.change = PaintPoints{{}, whole_number_of<std::uint32_t>(line.need("label"), "label")};
      read_points(line, action, true);
      read_segments(line, action);
    } else if (kind == "labels") {
      action.change = DefineLabels{labels_of(line.need("labels"))};
    } else if (kind == "lock" || kind == "unlock") {
      action.change = LockLabel{whole_number_of<std::uint32_t>(line.need("label"), "label"), kind == "lock", {}};
    } else if (kind == "carry") {
      action.change = PaintLabels{};
      if (const json* spacings = line.find("spacings")) action.carry.spacings = number_of(*spacings, "spacings");
      require_valid(action.carry.validate());
    } else if (kind == "clear") {
      action.change = ClearAnnotation{};
    } else if (kind == "undo") {
      action.change = UndoAction{};
    } else if (kind == "redo") {
      action.change = RedoAction{};
    } else {
      problem("unknown action " + in_quotes(kind) +
              "; there are set, remove, move, paint, carry, labels, lock, unlock, clear, undo and redo");
    }
  }

  static void read_segments(KeyedValues& line, ScriptedAction& action) {
    const json* segments = line.find("segments");
    if (segments == nullptr) return;
    if (!segments->is_boolean()) problem("segments is true or false");
    action.whole_segments = segments->get<bool>();
  }

  static void read_reach(KeyedValues& line, ScriptedAction& action) {
    const json* within = line.find("within_m");
    if (within == nullptr) return;
    action.within_m = number_of(*within, "within_m");
    if (!(action.within_m > 0.0)) problem("within_m is positive");
  }

  void read_points(KeyedValues& line, ScriptedAction& action, bool may_select) {
    const json* points = line.find("points");
    const json* at = line.find("at");
    read_reach(line, action);
    if (points != nullptr) {
      if (!points->is_array()) problem("points is a list of indices");
      for (const json& point : *points) {
        action.points.emplace_back(whole_number_of<std::uint32_t>(point, "each of points"));
      }
    }
    if (at != nullptr) {
      const bool several = at->is_array() && !at->empty() && at->front().is_array();
      if (!several) action.points.emplace_back(vector_of<3>(*at, "at"));
      if (several) {
        for (const json& place : *at) action.points.emplace_back(vector_of<3>(place, "each place of at"));
      }
    }
    if (may_select) {
      if (const json* view = line.find("view")) view_ = view_of(*view);
      action.selection = selection_of(line, view_);
    }
    const bool splits = action.selection && action.selection->split;
    if (splits && !std::holds_alternative<PaintPoints>(action.change)) problem("a split goes with paint");
    if (!action.points.empty() && action.selection) problem("points are named or selected, not both in one line");
    if (action.points.empty() && !action.selection) {
      problem(std::string{"say which points: points, at"} +
              (may_select ? ", rectangle, lasso, polyline, brush or split" : ""));
    }
  }

  std::optional<SelectionView> view_;
};

}  // namespace

Result<std::vector<ScriptedAction>> parse_annotation_script(std::string_view text) {
  std::vector<ScriptedAction> script;
  ScriptReader reader;
  LineScanner lines{without_byte_order_mark(text)};
  while (const auto line = lines.next()) {
    const std::string_view words = trimmed(*line);
    if (words.empty() || words.front() == '#') continue;
    const auto value = parse_json(words);
    if (!value) return bad_line(lines.line(), value.error().message);
    try {
      script.push_back(reader.read(*value));
    } catch (const ScriptProblem& problem) {
      return bad_line(lines.line(), problem.what);
    }
    script.back().line = lines.line();
  }
  return script;
}

Result<std::vector<ScriptedAction>> read_annotation_script(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes{std::uintmax_t{256} << 20U};
  SACCADE_TRY(const std::string text, read_text_file(path, kMaxBytes));
  return in_file(parse_annotation_script(text), path);
}

}  // namespace saccade
