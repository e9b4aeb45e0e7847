// SPDX-License-Identifier: Apache-2.0
#pragma once
// SimulatedAnnotator and RectangleAnnotator: someone who knows the truth, with control points and with rectangles.
// Thesis §4.2.2, §4.2.3.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
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

struct RectangleAnnotatorConfig {
  int columns{160};          ///< borders of rectangles lie on a grid of so many columns …
  int rows{120};             ///< … and rows; each cell is cell_px wide and high; 1 to 1024
  int cell_px{4};            ///< 1 to 8
  int point_size_px{5};      ///< of the points in the picture: what Surface rect does not select; 1 to 64
  double orbit_rad{30_deg};  ///< between the views; positive, at most 90°

  /// invalid_argument for numbers out of range.
  [[nodiscard]] Status validate() const;
};

/// One rectangle and the label that it gives.
struct RectangleAction {
  std::size_t view{0};  ///< 0: the sensor's; then azimuths −2, −1, 1, 2 orbits, then one orbit of elevation
  bool surface{false};  ///< Surface rect; otherwise Deep rect
  std::uint32_t label{0};
  int left{0}, top{0}, right{0}, bottom{0};  ///< cells [left, right) × [top, bottom)
  std::size_t corrected{0};                  ///< points with a wrong label before, and the right one after
  std::size_t broken{0};                     ///< the other way round
};

/// A user of the thesis' rectangular selection who knows the truth: paints one label into one rectangle per action, in
/// one of six views, as Surface rect or Deep rect. `next_around` draws it around the largest region that is wrong, as
/// SimulatedAnnotator clicks into its centre. `next` always takes the one by which the number of points with a wrong
/// label falls most, of all that there are; users do not find these. The views: the sensor's own (from the origin along
/// +z, y down, at most 120° wide), and from as far from the centroid, or farther where the cloud is too large, turned
/// around it by ±1 and ±2 orbits about y, and by one upwards. What most of the scene is has a label like others.
class RectangleAnnotator {
 public:
  /// @param positions_m  in the frame of the sensor; those that are not finite have no truth.
  /// @param truth        a label per position; 0: none, it does not matter what the point is given.
  /// @return size_mismatch for unlike numbers; invalid_argument for a bad configuration, or no point with a truth.
  [[nodiscard]] static Result<RectangleAnnotator> create(std::span<const Eigen::Vector3f> positions_m,
                                                         std::span<const std::uint32_t> truth,
                                                         const RectangleAnnotatorConfig& config,
                                                         const Executor& executor);

  [[nodiscard]] const std::vector<std::uint32_t>& labels() const { return labels_; }  ///< 0: none yet
  [[nodiscard]] std::size_t wrong() const { return wrong_; }
  [[nodiscard]] const SelectionView& view(std::size_t view) const { return pictures_[view].view; }

  /// Chooses and carries out the next action. Of equally good ones it is in the first view, surface before deep, of the
  /// least label, the topmost, the least high, the one that ends first from the left, the narrowest. None: no rectangle
  /// makes it better. O(views · (points + labels · columns · rows²)), where of the pictures only what may be corrected
  /// counts, and of labels those that may be the best. The thread count never changes the result.
  std::optional<RectangleAction> next(const Executor& executor);

  /// The rectangle around all that is seen of a region, in the view and by the tool by which the number of points with
  /// a wrong label falls most; of equals the first view, surface before deep. Where it never falls, what `next` does.
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
