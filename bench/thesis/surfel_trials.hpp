// SPDX-License-Identifier: Apache-2.0
#pragma once
// The experiment of thesis §4.1.3: surfels of a rendered sequence, with and without the mode filter, segmented by two
// algorithms at many thresholds, beside the truth.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/progress.hpp"
#include "saccade/scene/rendered_sequence.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/score_curve.hpp"
#include "saccade/surfel/mode_filter.hpp"

namespace saccade::thesis {

struct SurfelTrialConfig {
  std::size_t frames{0};  ///< 0: as many as the thesis' scene has; fewer are as many places along the same way
  int image_width_px{0};  ///< 0: the sensor's
  std::uint64_t seed{1};
  bool noise{true};                      ///< noise of depth, colour and poses
  std::optional<bool> automatic_gain{};  ///< none: as in the scene
  bool exposure_compensation{false};
  ModeFilterConfig mode_filter{};
  std::size_t placements{16};    ///< placements of the grid of SV-LCCP's seeds; its results are pooled over all
  bool places_of_modes{false};   ///< positions of the modes; false: positions of the averages (decision 20)
  FloodFillConfig flood_fill{};  ///< weights of Table 4.2 are set, whatever they are
  SvLccpConfig sv_lccp{};        ///< sizes and weights of Table 4.2 are set, whatever they are
  double min_weight{10.0};       ///< surfels with a smaller weight w_s are ignored; scaled with the number of frames
};

/// Not enhanced, enhanced, and as a yardstick: surfels that are not enhanced but for their colours, each that of the
/// thing that it is on, which is the mean of the enhanced ones there.
enum class SurfelColors { average, modes, truth };
inline constexpr std::array kSurfelColors{SurfelColors::average, SurfelColors::modes};  ///< the two in the thesis

struct SurfelTrial {
  std::string scene;
  std::size_t frames{0};
  std::size_t surfels{0};                ///< that are segmented
  std::size_t segments{0};               ///< true ones, after they were split
  double ms_per_frame{0.0};              ///< fusion and mode filter, median
  std::vector<double> true_gains;        ///< gains of frames, relative to the first
  std::vector<double> found_gains;       ///< by exposure compensation
  std::array<ScoreCurve, 3> flood_fill;  ///< by SurfelColors
  std::array<ScoreCurve, 3> sv_lccp;
  FloodFillConfig flood_fill_config;  ///< as used
  SvLccpConfig sv_lccp_config;        ///< as used
  std::array<PointCloud, 2> clouds;   ///< by SurfelColors; the same surfels, of the thesis' two

  std::vector<Eigen::Vector3f> mode_positions_m;  ///< positions of the modes of these surfels
  std::vector<std::uint32_t> true_segments;       ///< true segment of each surfel; kUnlabelled: none

  [[nodiscard]] const ScoreCurve& curve(bool by_flood_fill, SurfelColors colors) const {
    return (by_flood_fill ? flood_fill : sv_lccp)[static_cast<std::size_t>(colors)];
  }
};

/// T_ff and T_lccp of the curves.
[[nodiscard]] std::vector<double> surfel_thresholds();

/// Parameters of Table 4.2; σ_img is 0.1 where the scene is vignetted. Both clouds have the same surfels, with the
/// truth of where the average is, split where its segments do not touch there.
/// @param scene  of kSurfelScenes.
/// @return not_found for another scene; invalid_argument without placements; cancelled.
[[nodiscard]] Result<SurfelTrial> carry_out_surfel_trial(std::string_view scene, const SurfelTrialConfig& config,
                                                         const Executor& executor, const Progress& progress);

/// A cloud in the segments that the algorithm finds where its BCE is least.
struct BestSegments {
  double threshold{0.0};
  double bce{0.0};
  std::vector<std::uint32_t> labels;  ///< one per surfel, or kUnlabelled
  std::size_t count{0};
};
[[nodiscard]] Result<BestSegments> best_segments(const SurfelTrial& trial, bool by_flood_fill, SurfelColors colors,
                                                 const Executor& executor);

}  // namespace saccade::thesis
