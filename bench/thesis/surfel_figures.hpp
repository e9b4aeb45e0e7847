// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tables 4.1 to 4.3 of the thesis: its five scenes of surfels, its parameters, and how well they were segmented.

#include <array>
#include <cstddef>

namespace saccade::thesis {

/// Table 4.1.
struct SurfelDataset {
  std::size_t frames;
  std::size_t points;
  std::size_t labels;
};
inline constexpr std::array<SurfelDataset, 5> kTable4_1{
    {{1737, 120'000, 87}, {1737, 114'000, 196}, {2209, 134'000, 164}, {1831, 287'000, 139}, {1698, 100'000, 97}}};

/// Table 4.2.
inline constexpr double kColorSigma{0.005};    ///< σ_c
inline constexpr double kDepthSigma_m{0.05};   ///< σ_d
inline constexpr double kColorSigmas{5.0};     ///< K
inline constexpr int kMeanRadius_px{3};        ///< R_m
inline constexpr double kEvaluation_m{0.02};   ///< T_eval
inline constexpr double kVoxel_m{0.01};        ///< V_lccp
inline constexpr double kSupervoxel_m{0.05};   ///< S_lccp
inline constexpr double kPositionWeight{0.1};  ///< α_p
inline constexpr double kNormalWeight{0.5};    ///< α_n
inline constexpr double kColorWeight{1.0};     ///< α_c
inline constexpr double kImageSigma{0.3};      ///< σ_img
inline constexpr double kVignettedSigma{0.1};  ///< σ_img of scene 3
inline constexpr int kMaxModes{10};            ///< M_max

/// Table 4.3, least BCE.
struct LeastErrors {
  double flood_fill;
  double flood_fill_enhanced;
  double sv_lccp;
  double sv_lccp_enhanced;
};
inline constexpr std::array<LeastErrors, 5> kTable4_3{{{0.361, 0.259, 0.310, 0.277},
                                                       {0.677, 0.578, 0.597, 0.569},
                                                       {0.538, 0.486, 0.492, 0.484},
                                                       {0.674, 0.604, 0.580, 0.565},
                                                       {0.565, 0.518, 0.516, 0.493}}};

}  // namespace saccade::thesis
