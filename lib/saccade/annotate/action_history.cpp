// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/action.hpp"

#include <algorithm>

namespace saccade {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// Calls f for each control point slot that an action writes.
template <class F>
void for_each_control_slot(const AnnotationChange& change, F&& f) {
  if (const auto* set = std::get_if<SetControlPoints>(&change)) {
    for (const std::uint32_t point : set->points) f(point);
  } else if (const auto* remove = std::get_if<RemoveControlPoints>(&change)) {
    for (const std::uint32_t point : remove->points) f(point);
  } else if (const auto* move = std::get_if<MoveControlPoint>(&change)) {
    f(move->from);
    f(move->to);
  }
}

/// Returns the points that an action paints; nullptr: it paints none.
const std::vector<std::uint32_t>* painted_points(const AnnotationChange& change) {
  if (const auto* paint = std::get_if<PaintPoints>(&change)) return &paint->points;
  if (const auto* paint = std::get_if<PaintLabels>(&change)) return &paint->points;
  return nullptr;
}

/// Returns the paint that an action gives to one of its points.
std::uint32_t paint_on(const AnnotationChange& change, std::uint32_t point) {
  if (const auto* paint = std::get_if<PaintPoints>(&change)) return paint->label;
  const auto& paint = std::get<PaintLabels>(change);
  const auto at = std::lower_bound(paint.points.begin(), paint.points.end(), point) - paint.points.begin();
  return paint.labels[static_cast<std::size_t>(at)];
}

}  // namespace

std::optional<SlotChanges> ActionHistory::push(AnnotationAction action) {
  SlotChanges changes;
  Client& client = clients_[action.client];
  const bool undo = std::holds_alternative<UndoAction>(action.change);
  const bool redo = std::holds_alternative<RedoAction>(action.change);
  if ((undo && client.done.empty()) || (redo && client.undone.empty())) return std::nullopt;
  if (undo || redo) {
    std::vector<std::uint32_t>& from = undo ? client.done : client.undone;
    std::vector<std::uint32_t>& to = undo ? client.undone : client.done;
    set_active(from.back(), redo, changes);
    to.push_back(from.back());
    from.pop_back();
  } else {
    client.undone.clear();
    client.done.push_back(static_cast<std::uint32_t>(entries_.size()));
    keep(std::move(action), changes);
  }
  ++size_;
  return changes;
}

void ActionHistory::keep(AnnotationAction action, SlotChanges& changes) {
  const auto number = static_cast<std::uint32_t>(entries_.size());
  SACCADE_EXPECTS(entries_.size() < kNone);
  for_each_control_slot(action.change, [&](std::uint32_t point) { control_writers_[point].push_back(number); });
  if (const std::vector<std::uint32_t>* painted = painted_points(action.change)) {
    SACCADE_EXPECTS(paint_writes_.size() + painted->size() < kNone);
    if (paint_heads_.empty()) paint_heads_.assign(points_, kNone);
    for (const std::uint32_t point : *painted) {
      paint_writes_.push_back({number, paint_heads_[point]});
      paint_heads_[point] = static_cast<std::uint32_t>(paint_writes_.size() - 1);
    }
  } else if (const auto* define = std::get_if<DefineLabels>(&action.change)) {
    for (std::size_t i = 0; i < define->labels.size(); ++i) {
      label_writers_[define->labels[i].number].push_back({number, i});
    }
  }
  if (const auto* lock = std::get_if<LockLabel>(&action.change)) lock_writers_[lock->label].push_back(number);
  entries_.push_back({std::move(action), false, {}});
  set_active(number, true, changes);
}

void ActionHistory::set_active(std::uint32_t entry, bool active, SlotChanges& changes) {
  entries_[entry].active = active;
  std::visit(Overloaded{
                 [&](const PaintPoints& paint) { changes.painted = paint.points; },
                 [&](const PaintLabels& paint) { changes.painted = paint.points; },
                 [&](const DefineLabels& define) {
                   for (const NumberedLabel& label : define.labels) changes.labels.push_back(label.number);
                 },
                 [&](const LockLabel& lock) { changes.locks.push_back(lock.label); },
                 [&](const MoveControlPoint&) { set_move_active(entry, active, changes); },
                 [&](const ClearAnnotation&) { set_clear_active(entry, active, changes); },
                 [&](const auto&) {
                   for_each_control_slot(entries_[entry].action.change,
                                         [&](std::uint32_t point) { ripple(point, entry, changes); });
                 },
             },
             entries_[entry].action.change);
  follow_moves(changes);
}

void ActionHistory::set_move_active(std::uint32_t entry, bool active, SlotChanges& changes) {
  const auto move = std::get<MoveControlPoint>(entries_[entry].action.change);
  if (active) {
    moves_.insert(entry);
    entries_[entry].moved = before(move.from, entry);
  } else {
    moves_.erase(entry);
    entries_[entry].moved.reset();
  }
  ripple(move.from, entry, changes);
  ripple(move.to, entry, changes);
}

void ActionHistory::set_clear_active(std::uint32_t entry, bool active, SlotChanges& changes) {
  if (active) {
    clears_.insert(entry);
  } else {
    clears_.erase(entry);
  }
  stale_.insert(moves_.upper_bound(entry), moves_.end());
  changes = written();
  changes.labels.clear();
  changes.locks.clear();
}

/// Moves take the value that their source slot has just before them; a change there propagates to their target.
void ActionHistory::follow_moves(SlotChanges& changes) {
  while (!stale_.empty()) {
    const std::uint32_t entry = *stale_.begin();
    stale_.erase(stale_.begin());
    const auto move = std::get<MoveControlPoint>(entries_[entry].action.change);
    std::optional<ControlPoint> found = before(move.from, entry);
    if (found == entries_[entry].moved) continue;
    entries_[entry].moved = found;
    ripple(move.to, entry, changes);
  }
}

/// Propagates the change of a writer of a slot to the writers after it, up to the first that hides it.
void ActionHistory::ripple(std::uint32_t point, std::uint32_t entry, SlotChanges& changes) {
  const auto next_clear = clears_.upper_bound(entry);
  const std::vector<std::uint32_t>& writers = control_writers_.at(point);
  for (auto it = std::upper_bound(writers.begin(), writers.end(), entry); it != writers.end(); ++it) {
    if (next_clear != clears_.end() && *it > *next_clear) return;
    const Entry& writer = entries_[*it];
    if (!writer.active) continue;
    const auto* move = std::get_if<MoveControlPoint>(&writer.action.change);
    if (move != nullptr && move->from == point) stale_.insert(*it);
    if (move == nullptr || move->from == point || writer.moved) return;
  }
  if (next_clear == clears_.end()) changes.control_points.push_back(point);
}

std::optional<std::uint32_t> ActionHistory::clear_before(std::uint32_t entry) const {
  const auto after = clears_.lower_bound(entry);
  if (after == clears_.begin()) return std::nullopt;
  return *std::prev(after);
}

std::optional<ControlPoint> ActionHistory::before(std::uint32_t point, std::uint32_t entry) const {
  const auto slot = control_writers_.find(point);
  if (slot == control_writers_.end()) return std::nullopt;
  const std::vector<std::uint32_t>& writers = slot->second;
  const std::optional<std::uint32_t> clear = clear_before(entry);
  for (auto it = std::lower_bound(writers.begin(), writers.end(), entry); it != writers.begin();) {
    --it;
    if (clear && *it < *clear) break;
    const Entry& writer = entries_[*it];
    if (!writer.active) continue;
    if (const auto* set = std::get_if<SetControlPoints>(&writer.action.change)) {
      return ControlPoint{point, set->label, set->start_cost};
    }
    const auto* move = std::get_if<MoveControlPoint>(&writer.action.change);
    if (move == nullptr || move->from == point) break;
    if (writer.moved) return ControlPoint{point, writer.moved->label, writer.moved->start_cost};
  }
  return std::nullopt;
}

std::uint32_t ActionHistory::painted(std::uint32_t point) const {
  if (paint_heads_.empty()) return kNoLabel;
  const std::optional<std::uint32_t> clear = clear_before(kNone);
  for (std::uint32_t write = paint_heads_[point]; write != kNone; write = paint_writes_[write].previous) {
    const std::uint32_t entry = paint_writes_[write].entry;
    if (clear && entry < *clear) break;
    if (entries_[entry].active) return paint_on(entries_[entry].action.change, point);
  }
  return kNoLabel;
}

const LabelInfo* ActionHistory::definition(std::uint32_t label) const {
  const auto found = label_writers_.find(label);
  if (found == label_writers_.end()) return nullptr;
  const auto latest = std::find_if(found->second.rbegin(), found->second.rend(),
                                   [this](const LabelWrite& write) { return entries_[write.entry].active; });
  if (latest == found->second.rend()) return nullptr;
  return &std::get<DefineLabels>(entries_[latest->entry].action.change).labels[latest->index].info;
}

std::vector<const LockLabel*> ActionHistory::locks() const {
  std::vector<std::uint32_t> held;
  for (const auto& [label, writers] : lock_writers_) {
    const auto latest =
        std::find_if(writers.rbegin(), writers.rend(), [this](std::uint32_t entry) { return entries_[entry].active; });
    const bool is_held = latest != writers.rend() && std::get<LockLabel>(entries_[*latest].action.change).locked;
    if (is_held) held.push_back(*latest);
  }
  std::sort(held.begin(), held.end());
  std::vector<const LockLabel*> locks;
  for (const std::uint32_t entry : held) locks.push_back(&std::get<LockLabel>(entries_[entry].action.change));
  return locks;
}

SlotChanges ActionHistory::written() const {
  SlotChanges all;
  for (const auto& [point, writers] : control_writers_) all.control_points.push_back(point);
  for (std::uint32_t point = 0; point < paint_heads_.size(); ++point) {
    if (paint_heads_[point] != kNone) all.painted.push_back(point);
  }
  for (const auto& [label, writers] : label_writers_) all.labels.push_back(label);
  for (const auto& [label, writers] : lock_writers_) all.locks.push_back(label);
  return all;
}

bool ActionHistory::can_undo(std::uint64_t client) const {
  const auto found = clients_.find(client);
  return found != clients_.end() && !found->second.done.empty();
}

bool ActionHistory::can_redo(std::uint64_t client) const {
  const auto found = clients_.find(client);
  return found != clients_.end() && !found->second.undone.empty();
}

std::vector<AnnotationAction> ActionHistory::active() const {
  std::vector<AnnotationAction> actions;
  for (const Entry& entry : entries_) {
    if (entry.active) actions.push_back(entry.action);
  }
  return actions;
}

}  // namespace saccade
