// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedAnnotator and RectangleAnnotator: annotators who know the ground truth, one with control points, one with
// rectangles. Thesis §4.2.2, §4.2.3.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct SimulatedClick {
  std::uint32_t point{0};
  std::uint32_t label{0};
  double add_ms{0.0};     ///< time of the forest alone
  AnnotationScore score;  ///< score after the click
  bool segment{false};    ///< a whole segment was painted, instead of a control point set
};

/// Annotator by the usual protocol of interactive segmentation. The next click is at the centre of the largest region
/// of points that share a true label and do not have it (error_regions, region_centre), and gives them this label; with
/// strong_borders as a guarded_click. The
/// ground truth is used for nothing else. Every point of the cloud counts, until it has its true label.
class SimulatedAnnotator {
 public:
  /// @param truth  one label per point; 0: none, any label is accepted.
  /// @return size_mismatch unless there is one per point of the graph and per position; invalid_argument without a
  /// label.
  [[nodiscard]] static Result<SimulatedAnnotator> create(std::shared_ptr<const Neighbourhood> neighbourhood,
                                                         const PointCloud& cloud, std::vector<std::uint32_t> truth);

  /// Offers segments, one per point, kNoLabel for none; expects as many as points. From now on a click accepts the
  /// whole segment at its point (PaintPoints), if at least 95 % of the segment's points with a true label have the
  /// wanted one. Errors inside accepted segments stay.
  void offer_segments(std::vector<std::uint32_t> segments);

  /// Clicks. nullopt: nothing is wrong any more, or the wrong points are control points already.
  std::optional<SimulatedClick> next();

  [[nodiscard]] const std::vector<std::uint32_t>& labels() const { return labels_; }  ///< 0: none yet
  [[nodiscard]] ShortestPathForest& forest() { return forest_; }

 private:
  SimulatedAnnotator(std::shared_ptr<const Neighbourhood> neighbourhood, std::vector<std::uint32_t> truth,
                     std::vector<std::uint8_t> ends);

  [[nodiscard]] bool accepts(std::uint32_t segment, std::uint32_t label) const;
  void paint(std::uint32_t segment, std::uint32_t label);
  void set(SimulatedClick& click);

  ShortestPathForest forest_;
  std::vector<std::uint32_t> segments_;        ///< empty: none are offered
  std::unordered_set<std::uint32_t> painted_;  ///< accepted segments
  std::vector<std::uint32_t> truth_;
  std::vector<std::uint8_t> ends_;
  std::unordered_map<std::uint32_t, std::uint32_t> label_of_root_;
  std::vector<std::uint32_t> labels_;
};

struct RectangleAnnotatorConfig {
  int columns{160};          ///< columns of the grid on which borders of rectangles lie
  int rows{120};             ///< rows of the grid; each cell is cell_px wide and high; 1 to 1024
  int cell_px{4};            ///< 1 to 8
  int point_size_px{5};      ///< size of the drawn points, which determines what Surface rect cannot select; 1 to 64
  double orbit_rad{30_deg};  ///< angle between the views; positive, at most 90°

  /// Answers invalid_argument for numbers out of range.
  [[nodiscard]] Status validate() const;
};

/// One rectangle and the label that it gives.
struct RectangleAction {
  std::size_t view{0};  ///< 0: the sensor's; then azimuths −2, −1, 1, 2 orbits, then one orbit of elevation
  bool surface{false};  ///< Surface rect, by SurfaceRule::as_printed; otherwise Deep rect
  std::uint32_t label{0};
  int left{0}, top{0}, right{0}, bottom{0};  ///< cells [left, right) × [top, bottom)
  std::size_t corrected{0};                  ///< points that become right
  std::size_t broken{0};                     ///< points that become wrong
};

/// User of the thesis' rectangular selection who knows the ground truth. Each action paints one label into one
/// rectangle, in one of six views, as Surface rect or Deep rect. `next_around` draws it around the largest wrong
/// region, whose centre SimulatedAnnotator would click. `next` takes the rectangle that reduces the number of wrong
/// points most; users do not find these. The views: the sensor's own (from the origin along +z, y down, at most 120°
/// wide), and from as far from the centroid, or farther where the cloud is too large, turned around it by ±1 and ±2
/// orbits about y, and by one upwards. The background has a label like others.
class RectangleAnnotator {
 public:
  /// @param positions_m  in the frame of the sensor; those that are not finite have no truth.
  /// @param truth        one label per position; 0: none, any label is accepted.
  /// @return size_mismatch for unequal numbers; invalid_argument for a bad configuration, or no point with a truth.
  [[nodiscard]] static Result<RectangleAnnotator> create(std::span<const Eigen::Vector3f> positions_m,
                                                         std::span<const std::uint32_t> truth,
                                                         const RectangleAnnotatorConfig& config,
                                                         const Executor& executor);

  [[nodiscard]] const std::vector<std::uint32_t>& labels() const { return labels_; }  ///< 0: none yet
  [[nodiscard]] std::size_t wrong() const { return wrong_; }
  [[nodiscard]] const SelectionView& view(std::size_t view) const { return pictures_[view].view; }

  /// Chooses and performs the next action. Ties are broken by: the first view, surface before deep, the smallest label,
  /// the topmost, the lowest height, the leftmost right border, the narrowest. nullopt: no rectangle is an improvement.
  /// O(views · (points + labels · columns · rows²)), restricted to the parts of images that can be corrected, and to
  /// labels that may be best. The thread count never changes the result.
  std::optional<RectangleAction> next(const Executor& executor);

  /// Draws a rectangle around all visible points of a region, in the view and with the tool that reduce the number of
  /// wrong points most; at a tie the first view, surface before deep. Acts as `next` where no rectangle reduces it.
  /// @param region  the first of error_regions of labels(). O(views · points) unless `next` is needed.
  std::optional<RectangleAction> next_around(const ErrorRegion& region, const Executor& executor);

 private:
  static constexpr std::uint32_t kNowhere{0xffffffff};
  struct Picture {
    SelectionView view;
    std::vector<std::uint32_t> cells;  ///< per point; kNowhere: not in view
    std::vector<std::uint8_t> seen;    ///< per point: by Surface rect
  };

  RectangleAnnotator() = default;
  [[nodiscard]] bool is_right(std::size_t point) const { return labels_[point] == names_[truth_[point]]; }
  [[nodiscard]] bool is_selected(std::size_t point, const RectangleAction& action) const;
  [[nodiscard]] RectangleAction best_in(std::size_t view, bool surface) const;
  [[nodiscard]] RectangleAction around(const ErrorRegion& region, std::size_t view, bool surface) const;
  void carry_out(RectangleAction& action);

  RectangleAnnotatorConfig config_;
  std::vector<std::uint32_t> names_;  ///< labels of the truth in ascending order, after 0
  std::vector<std::uint32_t> truth_;  ///< per point, index of names_
  std::vector<std::uint32_t> labels_;
  std::vector<Picture> pictures_;
  std::size_t wrong_{0};
};

}  // namespace saccade
