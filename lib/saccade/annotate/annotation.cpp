// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/annotation.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace saccade {
namespace {

/// Smallest number of changed control points that is applied by a rebuild; fewer are applied one by one.
constexpr std::size_t kLeastRebuild{8};
constexpr std::size_t kSuspectsAtOnce{16384};

Error cannot(std::string why) { return {Errc::invalid_argument, std::move(why), "action"}; }

std::vector<std::uint32_t> in_order(std::span<const std::uint32_t> numbers) {
  std::vector<std::uint32_t> sorted{numbers.begin(), numbers.end()};
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

}  // namespace

Annotation::Annotation(const std::shared_ptr<const Neighbourhood>& neighbourhood, const Executor& executor)
    : executor_{executor},
      forest_{neighbourhood, executor},
      history_{neighbourhood->size()},
      labels_(neighbourhood->size(), kNoLabel) {}

Status Annotation::validate(const AnnotationAction& action) const {
  const Neighbourhood& graph = forest_.neighbourhood();
  SACCADE_CHECK(check_action(action, graph.size(), graph.config().max_path));
  const auto check_joined = [&](std::span<const std::uint32_t> points) -> Status {
    for (const std::uint32_t point : points) {
      if (graph.edges(graph.node_of(point)).empty()) {
        return cannot("point " + std::to_string(point) +
                      " has no neighbours: its position is not finite, or no other point lies elsewhere");
      }
    }
    return {};
  };
  SACCADE_CHECK(check_locks(action));
  const auto is_control_point = [this](std::uint32_t point) { return control_.contains(point); };
  if (const auto* set = std::get_if<SetControlPoints>(&action.change)) return check_joined(set->points);
  if (const auto* paint = std::get_if<PaintPoints>(&action.change)) return check_joined(paint->points);
  if (const auto* paint = std::get_if<PaintLabels>(&action.change)) return check_joined(paint->points);
  if (const auto* remove = std::get_if<RemoveControlPoints>(&action.change)) {
    if (std::none_of(remove->points.begin(), remove->points.end(), is_control_point)) {
      return cannot("there is no control point to remove");
    }
  }
  if (const auto* move = std::get_if<MoveControlPoint>(&action.change)) {
    if (!is_control_point(move->from)) {
      return cannot("point " + std::to_string(move->from) + " is not a control point, so it cannot be moved");
    }
    return check_joined({&move->to, 1});
  }
  return {};
}

Status Annotation::check_locks(const AnnotationAction& action) const {
  if (locks_.empty()) return {};
  const auto check_label = [this](std::uint32_t label) -> Status {
    if (!is_locked(label)) return {};
    return cannot("label " + std::to_string(label) + " is locked; unlock it first");
  };
  const auto check_place = [this](std::uint32_t point) -> Status {
    if (locked(point) == kNoLabel) return {};
    return cannot("point " + std::to_string(point) + " belongs to the locked label " + std::to_string(locked(point)));
  };
  if (const auto* set = std::get_if<SetControlPoints>(&action.change)) {
    SACCADE_CHECK(check_label(set->label));
    for (const std::uint32_t point : set->points) SACCADE_CHECK(check_place(point));
  } else if (const auto* paint = std::get_if<PaintPoints>(&action.change)) {
    SACCADE_CHECK(check_label(paint->label));
    for (const std::uint32_t point : paint->points) SACCADE_CHECK(check_place(point));
  } else if (const auto* labels = std::get_if<PaintLabels>(&action.change)) {
    for (const std::uint32_t label : labels->labels) SACCADE_CHECK(check_label(label));
    for (const std::uint32_t point : labels->points) SACCADE_CHECK(check_place(point));
  } else if (const auto* move = std::get_if<MoveControlPoint>(&action.change)) {
    if (const auto moved = control_point(move->from)) SACCADE_CHECK(check_label(moved->label));
    return check_place(move->to);
  }
  return {};
}

Applied Annotation::apply(AnnotationAction action) {
  changed_points_.clear();
  changed_control_points_.clear();
  changed_labels_.clear();
  const std::optional<SlotChanges> changes = history_.push(std::move(action));
  if (!changes) return {false, history_.size(), {}, {}, {}};
  change_slots(*changes);
  return {true, history_.size(), changed_points_, changed_control_points_, changed_labels_};
}

void Annotation::restore(std::span<const AnnotationAction> actions) {
  SACCADE_EXPECTS(history_.size() == 0);
  for (const AnnotationAction& action : actions) history_.push(action);
  change_slots(history_.written());
}

void Annotation::change_slots(const SlotChanges& slots) {
  change_definitions(slots.labels);
  if (!slots.painted.empty() && painted_.empty()) painted_.assign(labels_.size(), kNoLabel);
  for (const std::uint32_t point : slots.painted) painted_[point] = history_.painted(point);
  suspects_ = slots.painted;
  change_locks(slots.locks);
  change_control_points(slots.control_points);
  relabel();
}

void Annotation::change_locks(std::span<const std::uint32_t> slots) {
  if (slots.empty()) return;
  const std::vector<const LockLabel*> held = history_.locks();
  std::vector<std::uint32_t> now(labels_.size(), kNoLabel);
  locks_.clear();
  for (const LockLabel* lock : held) {
    locks_.insert(lock->label);
    for (const std::uint32_t point : lock->points) now[point] = lock->label;
  }
  for (std::uint32_t point = 0; point < now.size(); ++point) {
    if (now[point] != locked(point)) suspects_.push_back(point);
  }
  locked_ = std::move(now);
  for (const std::uint32_t label : in_order(slots)) changed_labels_.push_back(label);
}

void Annotation::change_definitions(std::span<const std::uint32_t> slots) {
  for (const std::uint32_t label : in_order(slots)) {
    const LabelInfo* info = history_.definition(label);
    const auto before = table_.defined().find(label);
    const bool was_defined = before != table_.defined().end();
    if (info == nullptr ? !was_defined : was_defined && before->second == *info) continue;
    if (info != nullptr) {
      table_.define(label, *info);
    } else {
      table_.undefine(label);
    }
    changed_labels_.push_back(label);
  }
}

void Annotation::change_control_points(std::span<const std::uint32_t> slots) {
  std::vector<ControlPoint> placed;
  std::vector<std::uint32_t> removed;
  for (const std::uint32_t point : in_order(slots)) {
    const std::optional<ControlPoint> now = history_.control_point(point);
    if (now == control_point(point)) continue;
    changed_control_points_.push_back(point);
    if (now) {
      placed.push_back(*now);
    } else {
      removed.push_back(point);
    }
  }
  change_forest(placed, removed);
}

void Annotation::change_forest(const std::vector<ControlPoint>& placed, const std::vector<std::uint32_t>& removed) {
  const std::size_t changes = placed.size() + removed.size();
  const bool rebuild = changes >= kLeastRebuild && 2 * changes > control_.size() + placed.size();
  const auto note = [&] { suspects_.insert(suspects_.end(), forest_.touched().begin(), forest_.touched().end()); };
  // New ones first, so that points which they take are not taken by others in between.
  for (const ControlPoint& point : placed) {
    const bool there = control_.contains(point.point);
    control_[point.point] = point;
    if (rebuild) continue;
    if (there) {
      forest_.remove(point.point);
      note();
    }
    forest_.add({point.point, point.start_cost});
    note();
  }
  for (const std::uint32_t point : removed) {
    control_.erase(point);
    if (rebuild) continue;
    forest_.remove(point);
    note();
  }
  if (rebuild) {
    std::vector<Root> roots;
    for (const ControlPoint& point : control_points()) roots.push_back({point.point, point.start_cost});
    forest_.rebuild(roots);
    suspects_.resize(labels_.size());
    std::iota(suspects_.begin(), suspects_.end(), 0U);
  }
}

void Annotation::relabel() {
  labels_now_.resize(suspects_.size());
  executor_.parallel_for(suspects_.size(), kSuspectsAtOnce, [this](std::size_t begin, std::size_t end) {
    std::optional<ControlPoint> last;  // consecutive points mostly share one
    for (std::size_t i = begin; i < end; ++i) {
      labels_now_[i] = locked(suspects_[i]);
      if (labels_now_[i] == kNoLabel) labels_now_[i] = painted(suspects_[i]);
      if (labels_now_[i] != kNoLabel) continue;
      const std::optional<std::uint32_t> root = forest_.root_of(suspects_[i]);
      if (!root) continue;
      if (!last || last->point != *root) last = control_.at(*root);
      labels_now_[i] = last->label;
    }
  });
  changed_points_.reserve(suspects_.size());
  Moved moved;
  for (std::size_t i = 0; i < suspects_.size(); ++i) {
    const std::uint32_t before = std::exchange(labels_[suspects_[i]], labels_now_[i]);
    if (labels_now_[i] == before) continue;
    if (before != moved.from || labels_now_[i] != moved.to) {
      count(moved);
      moved = {before, labels_now_[i], 0};
    }
    ++moved.points;
    changed_points_.push_back(suspects_[i]);
  }
  count(moved);
}

void Annotation::count(const Moved& moved) {
  if (moved.points == 0) return;
  if (moved.from != kNoLabel) {
    const auto count = counts_.find(moved.from);
    count->second -= moved.points;
    if (count->second == 0) counts_.erase(count);
  }
  if (moved.to != kNoLabel) counts_[moved.to] += moved.points;
}

std::vector<ControlPoint> Annotation::control_points() const {
  std::vector<ControlPoint> points;
  points.reserve(control_.size());
  for (const auto& [point, control] : control_) points.push_back(control);
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.point < b.point; });
  return points;
}

std::optional<ControlPoint> Annotation::control_point(std::uint32_t point) const {
  const auto found = control_.find(point);
  if (found == control_.end()) return std::nullopt;
  return found->second;
}

}  // namespace saccade
