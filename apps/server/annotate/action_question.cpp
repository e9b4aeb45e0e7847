// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/action_question.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "saccade/io/sessions/annotation_script.hpp"

namespace saccade::server {
namespace {

constexpr std::ptrdiff_t kMostPlaces{64};       // limit, since each is searched among all points
constexpr double kMostPixels{7680.0 * 4320.0};  // limit of a view
constexpr double kMostBrushed_px{4e9};          // limit over all parts of a brush
constexpr double kMostBallLine_px{20'000.0};    // limit of a brush with a radius in metres

Error too_much(std::string what) { return {Errc::invalid_argument, std::move(what), "action"}; }

/// Limits the work that a brush takes; a short message could otherwise demand much.
Status check_brush(const ScreenStroke& stroke, const ScriptedSelection& selection) {
  double length_px{0.0};
  double brushed_px{0.0};
  for (std::size_t i = 0; i < stroke.line.size(); ++i) {
    const ScreenPoint way_px = i == 0 ? ScreenPoint{0.0, 0.0} : ScreenPoint{stroke.line[i] - stroke.line[i - 1]};
    const ScreenPoint size_px = way_px.cwiseAbs().array() + 2.0 * stroke.radius_px + 1.0;
    length_px += way_px.norm();
    brushed_px +=
        std::min<double>(size_px.x(), selection.view.width) * std::min<double>(size_px.y(), selection.view.height);
  }
  if (selection.radius_m && length_px > kMostBallLine_px) {
    return too_much("a brush with radius_m may be 20000 px long; draw it in several parts");
  }
  if (!selection.radius_m && brushed_px > kMostBrushed_px) {
    return too_much("the brush is too large for so long a line; draw it in several parts");
  }
  return {};
}

Status check_work(const ScriptedAction& scripted) {
  const auto places = std::count_if(scripted.points.begin(), scripted.points.end(), [](const ScriptedPoint& point) {
    return std::holds_alternative<Eigen::Vector3d>(point);
  });
  if (places > kMostPlaces) return too_much("an action may name 64 places; name points by their index");
  if (!scripted.selection) return {};
  const SelectionView& view = scripted.selection->view;
  if (static_cast<double>(view.width) * view.height > kMostPixels) {
    return too_much("a view may have 7680 × 4320 pixels");
  }
  const auto* stroke = std::get_if<ScreenStroke>(&scripted.selection->shape);
  return stroke == nullptr ? Status{} : check_brush(*stroke, *scripted.selection);
}

/// Returns the control points whose trees contain the points.
Result<AnnotationAction> roots_of(const std::vector<std::uint32_t>& points, const Annotation& annotation,
                                  std::uint64_t client) {
  std::vector<std::uint32_t> roots;
  for (const std::uint32_t point : points) {
    if (point >= annotation.labels().size()) {
      return Error{Errc::invalid_argument, "there is no point " + std::to_string(point), "action"};
    }
    if (const auto root = annotation.forest().root_of(point)) roots.push_back(*root);
  }
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  if (roots.empty()) return Error{Errc::invalid_argument, "no control point reaches these points", "action"};
  return AnnotationAction{client, RemoveControlPoints{std::move(roots)}};
}

Result<ScriptedAction> parsed_action(const nlohmann::json& head) {
  const auto action = head.find("action");
  if (action == head.end() || !action->is_object()) return too_much("action is an object: {\"do\": ...}");
  if (action->contains("client")) return too_much("the client of an action is that of hello");
  const auto text = action->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  auto script = parse_annotation_script(text);
  if (!script) return Error{Errc::invalid_argument, script.error().message, "action"};
  if (script->size() != 1) return too_much("action is one action");
  if (!script->front().cloud.empty()) return too_much("an action is on the cloud that is open");
  return std::move(script->front());
}

Result<bool> asks_for_trees(const nlohmann::json& head) {
  const auto trees = head.find("trees");
  if (trees == head.end()) return false;
  if (!trees->is_boolean()) return too_much("trees is true or false");
  return trees->get<bool>();
}

/// Returns the hidden labels in ascending order.
Result<std::vector<std::uint32_t>> hidden_labels(const nlohmann::json& head) {
  std::vector<std::uint32_t> hidden;
  const auto list = head.find("hidden");
  if (list == head.end()) return hidden;
  if (!list->is_array()) return too_much("hidden is a list of labels");
  for (const auto& label : *list) {
    const bool fits = label.is_number_unsigned() && label.get<std::uint64_t>() <= kMaxLabel;
    if (!fits) return too_much("hidden is a list of labels, 0 to " + std::to_string(kMaxLabel));
    hidden.push_back(label.get<std::uint32_t>());
  }
  std::sort(hidden.begin(), hidden.end());
  return hidden;
}

/// Removes points with hidden labels: they are not selected, and hide nothing.
std::vector<Eigen::Vector3f> without_hidden(std::span<const Eigen::Vector3f> positions_m, const Annotation& annotation,
                                            const std::vector<std::uint32_t>& hidden) {
  std::vector<Eigen::Vector3f> shown_m(positions_m.begin(), positions_m.end());
  const std::span<const std::uint32_t> labels = annotation.labels();
  for (std::size_t i = 0; i < shown_m.size(); ++i) {
    if (std::binary_search(hidden.begin(), hidden.end(), labels[i])) {
      shown_m[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
  }
  return shown_m;
}

}  // namespace

Result<AnnotationAction> asked_action(const nlohmann::json& head, const AskedOn& subject, std::uint64_t client,
                                      const Executor& executor) {
  const Annotation& annotation = subject.annotation;
  std::span<const Eigen::Vector3f> positions_m = subject.positions_m;
  SACCADE_TRY(ScriptedAction scripted, parsed_action(head));
  SACCADE_TRY(const bool trees, asks_for_trees(head));
  SACCADE_TRY(const std::vector<std::uint32_t> hidden, hidden_labels(head));
  SACCADE_CHECK(check_work(scripted));
  const auto in_action = [](Error error) {
    error.context = "action";  // there are no lines
    return error;
  };
  const bool removes = std::holds_alternative<RemoveControlPoints>(scripted.change);
  if (trees && !removes) return too_much("trees goes with remove");
  if (trees) scripted.change = PaintPoints{};  // all selected points count, not only control points
  const double max_path = annotation.forest().neighbourhood().config().max_path;
  if (const Status fits = check_script({&scripted, 1}, positions_m.size(), max_path); !fits) {
    return in_action(fits.error());
  }
  std::vector<Eigen::Vector3f> shown_m;
  if (scripted.selection && !hidden.empty()) {
    shown_m = without_hidden(positions_m, annotation, hidden);
    positions_m = shown_m;
  }
  auto action = resolve_action(scripted, positions_m, annotation, client, executor, Eigen::Vector3d::Zero(),
                               subject.segments, subject.before);
  if (!action) return in_action(action.error());
  if (trees) return roots_of(std::get<PaintPoints>(action->change).points, annotation, client);
  return action;
}

}  // namespace saccade::server
