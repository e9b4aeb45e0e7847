// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/action.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>

namespace saccade {
namespace {

Error refused(std::string why) { return {Errc::invalid_argument, std::move(why), "action"}; }

/// Returns the first number that occurs twice, or nullptr; the list may be unordered.
template <class T>
const T* repeated(std::vector<T>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  return twice != numbers.end() ? &*twice : nullptr;
}

Status check_points(std::span<const std::uint32_t> points, std::size_t count) {
  if (points.empty()) return refused("it names no point");
  for (const std::uint32_t point : points) {
    if (point >= count) {
      return refused("point " + std::to_string(point) + " is not one of the cloud's " + std::to_string(count));
    }
  }
  if (std::adjacent_find(points.begin(), points.end(), std::greater_equal{}) == points.end()) return {};  // in order
  std::vector<std::uint32_t> copy{points.begin(), points.end()};
  if (const std::uint32_t* twice = repeated(copy)) {
    return refused("point " + std::to_string(*twice) + " is named twice");
  }
  return {};
}

Status check_label(std::uint32_t label) {
  if (label != kNoLabel && label <= kMaxLabel) return {};
  return refused("labels are 1 to " + std::to_string(kMaxLabel) + ", not " + std::to_string(label));
}

Status check_labels(const std::vector<NumberedLabel>& labels) {
  if (labels.empty()) return refused("it names no label");
  std::vector<std::uint32_t> numbers;
  for (const NumberedLabel& label : labels) {
    SACCADE_CHECK(check_label(label.number));
    SACCADE_CHECK(label.info.validate());
    numbers.push_back(label.number);
  }
  if (const std::uint32_t* twice = repeated(numbers)) {
    return refused("label " + std::to_string(*twice) + " is named twice");
  }
  return {};
}

struct Check {
  std::size_t points;
  double max_path;

  Status operator()(const SetControlPoints& set) const {
    SACCADE_CHECK(check_label(set.label));
    if (!(set.start_cost >= 0.0 && set.start_cost < max_path)) {
      return refused("a start cost is at least 0 and less than the longest path, " + std::to_string(max_path));
    }
    return check_points(set.points, points);
  }
  Status operator()(const RemoveControlPoints& remove) const { return check_points(remove.points, points); }
  Status operator()(const MoveControlPoint& move) const {
    if (move.from == move.to) return refused("it moves a control point to where it is");
    return check_points(std::array{move.from, move.to}, points);
  }
  Status operator()(const PaintPoints& paint) const {
    if (paint.label != kNoLabel) SACCADE_CHECK(check_label(paint.label));
    return check_points(paint.points, points);
  }
  Status operator()(const DefineLabels& define) const { return check_labels(define.labels); }
  Status operator()(const ClearAnnotation& /*clear*/) const { return {}; }
  Status operator()(const LockLabel& lock) const {
    SACCADE_CHECK(check_label(lock.label));
    if (!lock.locked)
      return lock.points.empty() ? Status{} : refused("it names points to unlock; they follow the label");
    return check_points(lock.points, points);
  }
  Status operator()(const PaintLabels& paint) const {
    if (paint.points.size() != paint.labels.size()) return refused("it needs one label for each point");
    for (const std::uint32_t label : paint.labels) SACCADE_CHECK(check_label(label));
    if (!std::is_sorted(paint.points.begin(), paint.points.end())) return refused("its points are not in order");
    return check_points(paint.points, points);
  }
  Status operator()(const UndoAction& /*undo*/) const { return {}; }
  Status operator()(const RedoAction& /*redo*/) const { return {}; }
};

}  // namespace

Status check_action(const AnnotationAction& action, std::size_t points, double max_path) {
  return std::visit(Check{points, max_path}, action.change);
}

}  // namespace saccade
