// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tables 4.4 to 4.8 of the thesis: its parameters, its user study, and the times of its annotation.

#include <array>
#include <cstddef>
#include <string_view>

#include "saccade/annotate/neighbourhood.hpp"

namespace saccade::thesis {

/// Table 4.4.
inline constexpr NeighbourhoodConfig kTable4_4{10, 1.0, 0.5, 1.0, 1.0, false, false};

struct MeanAndDeviation {
  double mean;
  double deviation;
};

/// Results of ten persons; errors are points.
struct StudiedMethod {
  MeanAndDeviation minutes;
  MeanAndDeviation undos_per_minute;
  MeanAndDeviation errors;
};

struct Scenario {
  int number;
  std::size_t points;
  MeanAndDeviation control_points;  ///< that users placed, by the text
  std::size_t truths_differ;        ///< points in which its two ground truths do
  StudiedMethod by_control_points;
  StudiedMethod by_rectangles;
};
/// Annotated in each: four objects and the background.
inline constexpr std::size_t kStudiedLabels{5};
inline constexpr Scenario kTable4_5{
    1, 150'868, {26.5, 14.9}, 860, {{6.0, 2.2}, {0.72, 0.5}, {1203, 687}}, {{9.4, 1.1}, {0.35, 0.25}, {3551, 761}}};
inline constexpr Scenario kTable4_6{
    2, 124'966, {31.0, 11.0}, 674, {{6.8, 2.1}, {0.75, 0.76}, {926, 346}}, {{9.5, 1.1}, {0.53, 0.41}, {4349, 1744}}};

/// From 0 to 10.
struct Opinion {
  std::string_view index;
  MeanAndDeviation control_points;
  MeanAndDeviation rectangles;
  bool differ;  ///< p < 0.05
};
inline constexpr std::array<Opinion, 5> kTable4_7{{{"Learnability", {8.9, 0.8}, {8.6, 0.9}, false},
                                                   {"Ease of use", {8.3, 1.1}, {7.1, 1.0}, true},
                                                   {"Efficiency", {7.4, 2.1}, {5.8, 1.9}, true},
                                                   {"Effectiveness", {8.2, 0.8}, {7.3, 1.3}, true},
                                                   {"Global evaluation", {8.9, 0.9}, {7.8, 1.1}, true}}};

/// Table 4.8: of scenario 1.
struct AnnotationTimes {
  double graph_ms;
  double annotation_ms;  ///< for this number of control points: kTable4_8ControlPoints
  double addition_ms;
  double deletion_ms;
};
inline constexpr std::size_t kTable4_8ControlPoints{90};
inline constexpr AnnotationTimes kTable4_8{520, 41, 10, 11};

}  // namespace saccade::thesis
