// SPDX-License-Identifier: Apache-2.0
#pragma once
// A small cloud with its graph, and random actions on it.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "saccade/annotate/annotation.hpp"

namespace saccade::test {

/// side × side points about 1 cm apart, in patches of colour, and one at the end that is not finite.
inline PointCloud patchy_cloud(int side, std::uint32_t seed = 1) {
  std::mt19937 random{seed};
  const auto jitter = [&] { return static_cast<float>(random() % 1000) * 4e-6F; };
  PointCloud cloud;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto at = [](int i) { return 0.01F * static_cast<float>(i); };
      cloud.positions_m.emplace_back(at(x) + jitter(), at(y) + jitter(), jitter());
      cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
      cloud.colors.emplace_back(x / 5 % 2 == 0 ? 0.9F : 0.2F, y / 7 % 2 == 0 ? 0.8F : 0.3F, 0.5F);
    }
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  cloud.positions_m.emplace_back(nan, nan, nan);
  cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
  cloud.colors.emplace_back(0.0F, 0.0F, 0.0F);
  return cloud;
}

/// Trees reach some five points far.
inline std::shared_ptr<const Neighbourhood> graph_of(const PointCloud& cloud) {
  NeighbourhoodConfig config;
  config.neighbours = 6;
  config.max_path = 0.06;
  config.color_weight = 0.05;
  auto graph = Neighbourhood::build(cloud, config, Executor{});
  if (!graph) throw std::runtime_error{graph.error().to_string()};
  return std::make_shared<const Neighbourhood>(std::move(*graph));
}

/// Valid actions of several clients, which a seed and the state decide.
class RandomActions {
 public:
  explicit RandomActions(std::uint64_t seed, std::size_t most_points = 12, std::uint64_t clients = 3)
      : random_{seed}, most_points_{most_points}, clients_{clients} {}

  AnnotationAction next(const Annotation& annotation) {
    while (true) {
      AnnotationAction action{1 + random_() % clients_, change(annotation)};
      if (annotation.validate(action)) return action;
    }
  }

 private:
  std::uint32_t below(std::size_t end) { return static_cast<std::uint32_t>(random_() % end); }

  std::vector<std::uint32_t> points(const Annotation& annotation, std::size_t most) {
    std::vector<std::uint32_t> chosen(1 + below(most));
    for (std::uint32_t& point : chosen) point = below(annotation.labels().size() - 1);
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    if (below(2) == 0) std::reverse(chosen.begin(), chosen.end());
    return chosen;
  }

  /// Control points, mostly some that are there.
  std::uint32_t control_point(const Annotation& annotation) {
    const std::vector<ControlPoint> there = annotation.control_points();
    return there.empty() ? below(annotation.labels().size() - 1) : there[below(there.size())].point;
  }

  /// Locks a label, or unlocks it where it is locked.
  AnnotationChange lock(const Annotation& annotation) {
    LockLabel lock{1 + below(4), true, {}};
    lock.locked = !annotation.is_locked(lock.label);
    for (std::uint32_t point = 0; lock.locked && point < annotation.labels().size(); ++point) {
      if (annotation.label_of(point) == lock.label) lock.points.push_back(point);
    }
    return lock;
  }

  AnnotationChange paint_labels(const Annotation& annotation) {
    PaintLabels paint{points(annotation, most_points_), {}};
    std::sort(paint.points.begin(), paint.points.end());
    for (std::size_t i = 0; i < paint.points.size(); ++i) paint.labels.push_back(1 + below(4));
    return paint;
  }

  AnnotationChange change(const Annotation& annotation) {
    const double max_path = annotation.forest().neighbourhood().config().max_path;
    const std::uint32_t kind = below(100);
    if (kind < 25) return SetControlPoints{points(annotation, 4), 1 + below(5), max_path * (below(3) * 0.2)};
    if (kind < 27) return SetControlPoints{points(annotation, 60), 1 + below(5), 0.0};
    if (kind < 37) {
      std::vector<std::uint32_t> removed = points(annotation, 3);
      const std::uint32_t point = control_point(annotation);
      if (std::find(removed.begin(), removed.end(), point) == removed.end()) removed.push_back(point);
      return RemoveControlPoints{removed};
    }
    if (kind < 52) {
      const std::uint32_t to = below(2) == 0 ? control_point(annotation) : below(annotation.labels().size() - 1);
      return MoveControlPoint{control_point(annotation), to};
    }
    if (kind < 56) return paint_labels(annotation);
    if (kind < 62) return PaintPoints{points(annotation, most_points_), below(4)};
    if (kind < 67) {
      const std::uint32_t number = 1 + below(4);
      const auto level = static_cast<std::uint8_t>(below(256));
      return DefineLabels{{{number, {"box " + std::to_string(below(9)), {level, 1, 2}, "box", below(3)}}}};
    }
    if (kind < 69) return ClearAnnotation{};
    if (kind < 73) return lock(annotation);
    if (kind < 88) return UndoAction{};
    return RedoAction{};
  }

  std::mt19937_64 random_;
  std::size_t most_points_;
  std::uint64_t clients_;
};

}  // namespace saccade::test
