// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedAnnotator: control points where someone who knows the truth would click next. Thesis §4.2.3.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"

namespace saccade {

struct SimulatedClick {
  std::uint32_t point{0};
  std::uint32_t label{0};
  double add_ms{0.0};     ///< of the forest alone
  AnnotationScore score;  ///< with it
};

/// The usual protocol of interactive segmentation: the next click is at the centre of the largest region of points that
/// ought to have the same label and do not (error_regions, region_centre), and gives them this label. The truth does
/// nothing else. Every point that the cloud has counts, until it has the label of its truth.
class SimulatedAnnotator {
 public:
  /// @param truth  a label per point; 0: none, it does not matter what the point is given.
  /// @return size_mismatch unless there is one per point of the graph and per position; invalid_argument without a
  /// label.
  [[nodiscard]] static Result<SimulatedAnnotator> create(std::shared_ptr<const Neighbourhood> neighbourhood,
                                                         const PointCloud& cloud, std::vector<std::uint32_t> truth);

  /// Clicks. None: nothing is wrong any more, or what is wrong is a control point already.
  std::optional<SimulatedClick> next();

  [[nodiscard]] const std::vector<std::uint32_t>& labels() const { return labels_; }  ///< 0: none yet
  [[nodiscard]] ShortestPathForest& forest() { return forest_; }

 private:
  SimulatedAnnotator(std::shared_ptr<const Neighbourhood> neighbourhood, std::vector<std::uint32_t> truth,
                     std::vector<std::uint8_t> ends);

  ShortestPathForest forest_;
  std::vector<std::uint32_t> truth_;
  std::vector<std::uint8_t> ends_;
  std::unordered_map<std::uint32_t, std::uint32_t> label_of_root_;
  std::vector<std::uint32_t> labels_;
};

}  // namespace saccade
