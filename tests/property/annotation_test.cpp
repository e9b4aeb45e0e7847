// SPDX-License-Identifier: Apache-2.0
// Any sequence of actions, undo and redo of several clients, leaves what the actions that are not undone leave.

#include <gtest/gtest.h>

#include <map>

#include "support/annotated_cloud.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kAnnotationRuns{test::scaled_cases(150)};
constexpr int kActionsPerRun{120};

/// The state as its definition says: each action does to the state what its name says, one after the other.
struct PlainState {
  std::map<std::uint32_t, ControlPoint> control_points;
  std::map<std::uint32_t, std::uint32_t> paint;
  std::map<std::uint32_t, LabelInfo> definitions;
  std::vector<LockLabel> locks;  ///< that hold, the latest last

  void operator()(const SetControlPoints& set) {
    for (const std::uint32_t point : set.points) control_points[point] = {point, set.label, set.start_cost};
  }
  void operator()(const RemoveControlPoints& remove) {
    for (const std::uint32_t point : remove.points) control_points.erase(point);
  }
  void operator()(const MoveControlPoint& move) {
    const auto found = control_points.find(move.from);
    if (found == control_points.end()) return;
    control_points[move.to] = {move.to, found->second.label, found->second.start_cost};
    control_points.erase(move.from);
  }
  void operator()(const PaintPoints& painted) {
    for (const std::uint32_t point : painted.points) paint[point] = painted.label;
  }
  void operator()(const PaintLabels& painted) {
    for (std::size_t i = 0; i < painted.points.size(); ++i) paint[painted.points[i]] = painted.labels[i];
  }
  void operator()(const DefineLabels& define) {
    for (const NumberedLabel& label : define.labels) definitions[label.number] = label.info;
  }
  void operator()(const LockLabel& lock) {
    std::erase_if(locks, [&](const LockLabel& earlier) { return earlier.label == lock.label; });
    if (lock.locked) locks.push_back(lock);
  }
  void operator()(const ClearAnnotation& /*clear*/) {
    control_points.clear();
    paint.clear();
  }
  void operator()(const UndoAction& /*undo*/) { FAIL(); }
  void operator()(const RedoAction& /*redo*/) { FAIL(); }

  [[nodiscard]] std::vector<std::uint32_t> labels(ShortestPathForest& forest) const {
    std::vector<Root> roots;
    for (const auto& [point, control] : control_points) roots.push_back({point, control.start_cost});
    forest.rebuild(roots);
    std::vector<std::uint32_t> labels(forest.neighbourhood().size(), kNoLabel);
    for (std::uint32_t point = 0; point < labels.size(); ++point) {
      if (const auto root = forest.root_of(point)) labels[point] = control_points.at(*root).label;
      const auto painted = paint.find(point);
      if (painted != paint.end() && painted->second != kNoLabel) labels[point] = painted->second;
    }
    for (const LockLabel& lock : locks) {
      for (const std::uint32_t point : lock.points) labels[point] = lock.label;
    }
    return labels;
  }
};

/// Undo and redo as lists of actions, without slots.
struct PlainHistory {
  struct Done {
    AnnotationAction action;
    bool active{true};
  };
  std::vector<Done> all;
  std::map<std::uint64_t, std::vector<std::size_t>> undone;

  void push(const AnnotationAction& action) {
    if (std::holds_alternative<UndoAction>(action.change)) {
      for (std::size_t i = all.size(); i-- > 0;) {
        if (all[i].action.client != action.client || !all[i].active) continue;
        all[i].active = false;
        undone[action.client].push_back(i);
        return;
      }
    } else if (std::holds_alternative<RedoAction>(action.change)) {
      if (undone[action.client].empty()) return;
      all[undone[action.client].back()].active = true;
      undone[action.client].pop_back();
    } else {
      undone[action.client].clear();
      all.push_back({action});
    }
  }
  [[nodiscard]] PlainState state() const {
    PlainState state;
    for (const Done& done : all) {
      if (done.active) std::visit(state, done.action.change);
    }
    return state;
  }
};

void expect_same(const Annotation& annotation, const PlainState& plain, ShortestPathForest& forest) {
  std::vector<ControlPoint> control_points;
  for (const auto& [point, control] : plain.control_points) control_points.push_back(control);
  ASSERT_EQ(annotation.control_points(), control_points);
  const std::vector<std::uint32_t> labels = plain.labels(forest);
  ASSERT_TRUE(std::equal(labels.begin(), labels.end(), annotation.labels().begin(), annotation.labels().end()));
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : labels) {
    if (label != kNoLabel) ++counts[label];
  }
  ASSERT_EQ(annotation.counts(), counts);
  ASSERT_EQ(annotation.label_table().defined(), plain.definitions);
}

/// Checks that an action reports exactly the values that changed.
void expect_reported(const Applied& applied, std::vector<std::uint32_t>& labels, const Annotation& annotation) {
  std::vector<std::uint32_t> reported{applied.points.begin(), applied.points.end()};
  std::sort(reported.begin(), reported.end());
  std::vector<std::uint32_t> changed;
  for (std::uint32_t point = 0; point < labels.size(); ++point) {
    if (labels[point] != annotation.label_of(point)) changed.push_back(point);
  }
  ASSERT_EQ(reported, changed);
  labels.assign(annotation.labels().begin(), annotation.labels().end());
}

TEST(AnnotationProperty, IsWhatTheActionsThatAreNotUndoneLeave) {
  const auto graph = test::graph_of(test::patchy_cloud(16));
  ShortestPathForest forest{graph};
  int compared = 0;
  int undone = 0;
  int moved_on = 0;
  int locked = 0;
  for (int run = 0; run < kAnnotationRuns; ++run) {
    SCOPED_TRACE("seed " + std::to_string(run));
    test::RandomActions random{static_cast<std::uint64_t>(run), 30};
    Annotation annotation{graph};
    PlainHistory history;
    std::vector<AnnotationAction> actions;
    std::vector<std::uint32_t> labels(graph->size(), kNoLabel);
    for (int step = 0; step < kActionsPerRun; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      actions.push_back(random.next(annotation));
      history.push(actions.back());
      const Applied applied = annotation.apply(actions.back());
      ASSERT_NO_FATAL_FAILURE(expect_reported(applied, labels, annotation));
      ASSERT_NO_FATAL_FAILURE(expect_same(annotation, history.state(), forest));
      ++compared;
      undone += applied.done && std::holds_alternative<UndoAction>(actions.back().change) ? 1 : 0;
      locked += std::holds_alternative<LockLabel>(actions.back().change) ? 1 : 0;
      moved_on += std::holds_alternative<MoveControlPoint>(actions.back().change) ? 1 : 0;
    }
    Annotation replayed{graph};
    replayed.restore(annotation.history().active());
    ASSERT_NO_FATAL_FAILURE(expect_same(replayed, history.state(), forest));
    Annotation restored{graph};
    restored.restore(actions);
    ASSERT_NO_FATAL_FAILURE(expect_same(restored, history.state(), forest));
    EXPECT_EQ(restored.history().size(), annotation.history().size());
    EXPECT_EQ(restored.history().active(), annotation.history().active());
  }
  EXPECT_EQ(compared, kAnnotationRuns * kActionsPerRun);
  EXPECT_GT(undone, 10 * kAnnotationRuns);
  EXPECT_GT(moved_on, 5 * kAnnotationRuns);
  EXPECT_GT(locked, kAnnotationRuns);
}

}  // namespace
}  // namespace saccade
