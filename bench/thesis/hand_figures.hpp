// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tables 2.2 to 2.6 of the thesis: what it says of detectors of hand actions.

#include <array>
#include <optional>

namespace saccade::thesis {

/// Precision and recall, %.
struct Rates {
  double precision;
  double recall;
};

/// Over the data set's tasks as recorded.
struct TaskRates {
  Rates zvc;
  Rates gmm;
};
inline constexpr TaskRates kTable2_2PlacementsAndRemovals{{96.4, 97.3}, {95.4, 95.9}};
inline constexpr TaskRates kTable2_2PickAndPlace{{94.5, 98.2}, {97.7, 97.3}};

/// Over all tasks, at another speed or with noise.
struct ConditionRates {
  double speed;  ///< multiple of the number of samples
  double sigma_m;
  Rates zvc;
  Rates gmm;
};
inline constexpr std::array<ConditionRates, 5> kTable2_3{{{0.25, 0.0, {96.6, 93.0}, {98.0, 86.1}},
                                                          {0.5, 0.0, {95.7, 97.7}, {97.0, 95.9}},
                                                          {1.0, 0.0, {95.5, 97.7}, {96.6, 96.6}},
                                                          {2.0, 0.0, {95.7, 97.7}, {96.8, 92.5}},
                                                          {4.0, 0.0, {96.4, 97.7}, {97.0, 80.7}}}};
inline constexpr std::array<ConditionRates, 3> kTable2_4{{{1.0, 0.001, {95.4, 97.7}, {97.5, 98.4}},
                                                          {1.0, 0.025, {95.1, 12.5}, {97.0, 80.2}},
                                                          {1.0, 0.05, {97.5, 0.5}, {98.6, 56.8}}}};

/// A Gaussian of the mixtures in Figures 2.13 and 2.14.
struct GaussianSaliency {
  double saliency;
  std::optional<double> threshold;
  bool is_poi;
};
inline constexpr std::array<GaussianSaliency, 6> kTable2_5{{{0.005880, std::nullopt, false},
                                                            {0.001646, 0.040424, false},
                                                            {0.001352, 0.031084, false},
                                                            {0.073616, 0.002673, true},
                                                            {0.001749, 0.038675, false},
                                                            {0.002383, std::nullopt, false}}};
inline constexpr std::array<GaussianSaliency, 7> kTable2_6{{{0.002341, std::nullopt, false},
                                                            {0.025118, 0.002693, true},
                                                            {0.001191, 0.036059, false},
                                                            {0.001855, 0.035187, false},
                                                            {0.066844, 0.002574, true},
                                                            {0.000679, 0.035919, false},
                                                            {0.003140, std::nullopt, false}}};

/// Times the neighbours' mean saliency: what the thresholds of Tables 2.5 and 2.6 are.
inline constexpr double kThresholdFactor{1.5};

}  // namespace saccade::thesis
