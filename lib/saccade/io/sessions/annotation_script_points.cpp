// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "saccade/annotate/selection.hpp"
#include "saccade/io/sessions/annotation_script.hpp"

namespace saccade {
namespace {

using Indices = std::vector<std::uint32_t>;

Error at_line(const ScriptedAction& scripted, std::string what) {
  return {Errc::invalid_argument, std::move(what), "line " + std::to_string(scripted.line)};
}

bool takes_points(const AnnotationChange& change) {
  return std::holds_alternative<SetControlPoints>(change) || std::holds_alternative<RemoveControlPoints>(change) ||
         std::holds_alternative<MoveControlPoint>(change) || std::holds_alternative<PaintPoints>(change);
}

void give_points(AnnotationChange& change, Indices points) {
  if (auto* set = std::get_if<SetControlPoints>(&change)) {
    set->points = std::move(points);
  } else if (auto* remove = std::get_if<RemoveControlPoints>(&change)) {
    remove->points = std::move(points);
  } else if (auto* move = std::get_if<MoveControlPoint>(&change)) {
    *move = {points.at(0), points.at(1)};
  } else if (auto* paint = std::get_if<PaintPoints>(&change)) {
    paint->points = std::move(points);
  }
}

struct NearPoint {
  std::uint32_t point{0};
  double distance_m{std::numeric_limits<double>::infinity()};
};

/// Takes a nearer point; the first at a tie.
void take_nearer(const Eigen::Vector3f& p, std::uint32_t point, const Eigen::Vector3d& place_m, NearPoint& best) {
  const double distance_m = (p.cast<double>() - place_m).norm();  // NaN is not less than anything
  if (distance_m < best.distance_m) best = {point, distance_m};
}

NearPoint nearest_point(std::span<const Eigen::Vector3f> positions_m, const Eigen::Vector3d& place_m) {
  NearPoint best;
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    take_nearer(positions_m[i], static_cast<std::uint32_t>(i), place_m, best);
  }
  return best;
}

NearPoint nearest_control_point(std::span<const Eigen::Vector3f> positions_m, const Annotation& annotation,
                                const Eigen::Vector3d& place_m) {
  NearPoint best;
  for (const ControlPoint& control : annotation.control_points()) {
    take_nearer(positions_m[control.point], control.point, place_m, best);
  }
  return best;
}

/// Data for resolve_action.
struct Resolver {
  const ScriptedAction& scripted;
  std::span<const Eigen::Vector3f> positions_m;
  const Annotation& annotation;
  const Executor& executor;
  const Eigen::Vector3d& offset_m;

  [[nodiscard]] Result<std::uint32_t> point(const ScriptedPoint& named, bool control_point) const {
    if (const auto* index = std::get_if<std::uint32_t>(&named)) return *index;
    const auto& place_m = std::get<Eigen::Vector3d>(named);
    const NearPoint near = control_point ? nearest_control_point(positions_m, annotation, place_m - offset_m)
                                         : nearest_point(positions_m, place_m - offset_m);
    if (near.distance_m <= scripted.within_m) return near.point;
    const std::string what = control_point ? "control point" : "point";
    std::ostringstream text;
    text << "no " << what << " within " << scripted.within_m << " m of (" << place_m.x() << ", " << place_m.y() << ", "
         << place_m.z() << "); ";
    if (near.distance_m < std::numeric_limits<double>::infinity()) {
      text << "the nearest, " << near.point << ", is " << near.distance_m
           << " m away: correct the place, or increase within_m";
    } else {
      text << "there is none at all";
    }
    return at_line(scripted, text.str());
  }

  [[nodiscard]] Result<Indices> selected() const {
    ScriptedSelection selection = *scripted.selection;
    selection.view.clip_world = selection.view.clip_world * Eigen::Affine3d{Eigen::Translation3d{offset_m}}.matrix();
    for (Eigen::Vector4d& plane : selection.view.planes) plane.w() += plane.head<3>().dot(offset_m);
    if (selection.split) return part_of(selection);
    auto chosen = selection.radius_m
                      ? select_around(positions_m, selection.view, std::get<ScreenStroke>(selection.shape).line,
                                      *selection.radius_m, executor)
                      : select_points(positions_m, selection.view, selection.shape, selection.below_m, executor);
    if (!chosen) return at_line(scripted, chosen.error().message);
    if (chosen->empty()) return at_line(scripted, "nothing is selected; are the view and the shape right?");
    if (!std::holds_alternative<RemoveControlPoints>(scripted.change)) return chosen;
    std::erase_if(*chosen, [&](std::uint32_t point) { return !annotation.control_point(point); });
    if (chosen->empty()) return at_line(scripted, "no control point is among what is selected");
    return chosen;
  }

  [[nodiscard]] Result<Indices> part_of(const ScriptedSelection& selection) const {
    const std::uint32_t given = std::get<PaintPoints>(scripted.change).label;
    auto split = split_label(annotation, positions_m, selection.view, std::get<ScreenStroke>(selection.shape),
                             *selection.split, given, executor);
    if (!split) return at_line(scripted, split.error().message);
    return std::move(split->points);
  }

  [[nodiscard]] Result<Indices> named() const {
    const bool moves = std::holds_alternative<MoveControlPoint>(scripted.change);
    const bool removes = std::holds_alternative<RemoveControlPoints>(scripted.change);
    Indices points;
    for (const ScriptedPoint& named : scripted.points) {
      SACCADE_TRY(const std::uint32_t found, point(named, removes || (moves && points.empty())));
      const bool is_place = std::holds_alternative<Eigen::Vector3d>(named);
      const bool is_there = is_place && !moves && std::find(points.begin(), points.end(), found) != points.end();
      if (!is_there) points.push_back(found);
    }
    return points;
  }

  /// Returns all points of the segments of `points`, without those that take no label.
  [[nodiscard]] Result<Indices> whole_segments(const Indices& points, std::span<const std::uint32_t> segments) const {
    if (segments.size() != positions_m.size()) return at_line(scripted, "there are no segments; --segments names them");
    std::vector<std::uint32_t> wanted;
    for (const std::uint32_t point : points) {
      if (segments[point] != kNoLabel) wanted.push_back(segments[point]);
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const Neighbourhood& graph = annotation.forest().neighbourhood();
    Indices whole;
    for (std::uint32_t point = 0; point < segments.size() && !wanted.empty(); ++point) {
      if (!std::binary_search(wanted.begin(), wanted.end(), segments[point])) continue;
      if (!graph.edges(graph.node_of(point)).empty()) whole.push_back(point);
    }
    if (whole.empty()) return at_line(scripted, "these points are in no segment");
    return whole;
  }
};

Result<PaintLabels> carried_paint(const ScriptedAction& scripted, const CarrySource* before,
                                  std::span<const Eigen::Vector3f> positions_m, const Annotation& annotation,
                                  const Executor& executor) {
  if (before == nullptr) return at_line(scripted, "there is no cloud before this one to carry labels from");
  auto carried = carry_labels(*before, positions_m, annotation, scripted.carry, executor);
  if (!carried) return at_line(scripted, carried.error().message);
  if (!carried->paint.points.empty()) return std::move(carried->paint);
  return at_line(scripted, "no point takes a label: " + std::to_string(carried->kept) +
                               " in reach have one already, and those of " + std::to_string(carried->locked) +
                               " others are locked");
}

}  // namespace

Status check_script(std::span<const ScriptedAction> script, std::size_t points, double max_path) {
  for (const ScriptedAction& scripted : script) {
    AnnotationAction action{0, scripted.change};
    Indices indices;
    for (const ScriptedPoint& point : scripted.points) {
      if (const auto* index = std::get_if<std::uint32_t>(&point)) indices.push_back(*index);
    }
    const bool known = indices.size() == scripted.points.size() && !scripted.selection;
    if (std::holds_alternative<MoveControlPoint>(scripted.change) && !known) {
      action.change = RemoveControlPoints{};  // stands for the check of its points
    }
    if (indices.empty()) indices.push_back(0);  // a point that every cloud has
    if (auto* lock = std::get_if<LockLabel>(&action.change)) {
      lock->points.resize(lock->locked ? 1 : 0);  // stands for those that have the label by then
    }
    if (std::holds_alternative<PaintLabels>(action.change)) action.change = PaintLabels{{0}, {1}};
    if (takes_points(action.change)) give_points(action.change, std::move(indices));
    if (const Status valid = check_action(action, points, max_path); !valid) {
      return at_line(scripted, valid.error().message);
    }
  }
  return {};
}

Result<AnnotationAction> resolve_action(const ScriptedAction& scripted, std::span<const Eigen::Vector3f> positions_m,
                                        const Annotation& annotation, std::uint64_t client, const Executor& executor,
                                        const Eigen::Vector3d& offset_m, std::span<const std::uint32_t> segments,
                                        const CarrySource* before) {
  AnnotationAction action{scripted.client.value_or(client), scripted.change};
  if (auto* lock = std::get_if<LockLabel>(&action.change); lock != nullptr && lock->locked) {
    const std::span<const std::uint32_t> labels = annotation.labels();
    for (std::uint32_t point = 0; point < labels.size(); ++point) {
      if (labels[point] == lock->label) lock->points.push_back(point);
    }
    if (lock->points.empty()) return at_line(scripted, "no point has label " + std::to_string(lock->label));
  }
  if (auto* paint = std::get_if<PaintLabels>(&action.change)) {
    SACCADE_TRY(*paint, carried_paint(scripted, before, positions_m, annotation, executor));
  }
  if (!takes_points(scripted.change)) return action;
  const Resolver resolver{scripted, positions_m, annotation, executor, offset_m};
  SACCADE_TRY(Indices points, scripted.selection ? resolver.selected() : resolver.named());
  if (scripted.whole_segments) {
    SACCADE_TRY(points, resolver.whole_segments(points, segments));
  }
  if (std::holds_alternative<PaintPoints>(action.change)) {
    const auto is_locked = [&](std::uint32_t point) {
      return point < positions_m.size() && annotation.locked(point) != kNoLabel;
    };
    std::erase_if(points, is_locked);
    if (points.empty()) return at_line(scripted, "all of these points belong to locked labels");
  }
  give_points(action.change, std::move(points));
  return action;
}

}  // namespace saccade
