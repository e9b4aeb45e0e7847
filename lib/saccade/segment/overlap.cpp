// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/overlap.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace saccade {

Result<SegmentOverlap> score_segments(std::span<const std::uint32_t> segments, std::span<const std::uint32_t> objects,
                                      std::uint32_t first_object) {
  if (segments.size() != objects.size()) {
    return Error{Errc::size_mismatch, "as many segment labels as object labels are needed", "score"};
  }
  std::map<std::uint32_t, std::size_t> segment_points, object_points;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> shared_points;  // (object, segment)
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i] == kUnlabelled) continue;
    object_points[objects[i]] += 1;
    if (segments[i] == kUnlabelled) continue;
    segment_points[segments[i]] += 1;
    shared_points[{objects[i], segments[i]}] += 1;
  }

  SegmentOverlap score;
  double inside{0.0}, outside{0.0}, weighted{0.0};
  for (auto object = object_points.lower_bound(first_object); object != object_points.end(); ++object) {
    const auto& [label, points] = *object;
    score.objects += 1;
    score.points += points;
    std::size_t most{0}, most_of{0};
    double best_iou{0.0};
    for (auto it = shared_points.lower_bound({label, 0}); it != shared_points.end() && it->first.first == label; ++it) {
      const std::size_t shared = it->second;
      const std::size_t size = segment_points.at(it->first.second);
      best_iou = std::max(best_iou, static_cast<double>(shared) / static_cast<double>(points + size - shared));
      if (shared > most) {
        most = shared;
        most_of = size;
      }
    }
    inside += static_cast<double>(most);
    outside += static_cast<double>(most_of - most);
    weighted += static_cast<double>(points) * best_iou;
  }
  if (score.points == 0) return score;
  const auto all = static_cast<double>(score.points);
  score.over_segmentation = 1.0 - inside / all;
  score.under_segmentation = outside / all;
  score.weighted_overlap = weighted / all;
  return score;
}

}  // namespace saccade
