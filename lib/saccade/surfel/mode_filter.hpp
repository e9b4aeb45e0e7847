// SPDX-License-Identifier: Apache-2.0
#pragma once
// ModeFilter: several colours and positions per surfel, the most frequent of which wins.  Thesis §4.1.1, Algorithm 6.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/surfel/guided_filter.hpp"
#include "saccade/surfel/mode_store.hpp"
#include "saccade/surfel/surfel_association.hpp"

namespace saccade {

/// Parameters of sharpened modes, to which modes of the neighbours contribute (decision 19).
struct ModeSharpeningConfig {
  double strength{2.0};      ///< λ; 0: neighbours do not contribute
  double reach_m{0.02};      ///< distance over which wrong poses spread colours
  double color_sigma{0.06};  ///< spread of colours that count as one, in the unit of colours, [0, 1]

  /// Answers invalid_argument for a negative strength, a reach or σ that is not positive, or any that is not finite.
  [[nodiscard]] Status validate() const;
};

/// Parameters of ModeFilter: Table 4.2. (σ_img is SurfelFusionConfig::image_sigma: both weigh pixels alike.)
struct ModeFilterConfig {
  GuidedFilterConfig guided{};  ///< R_m, σ_c and σ_d; σ_c also applies to the modes
  double color_sigmas{5.0};     ///< K: a colour farther from all modes starts a new one; infinity: one mode for all
  int max_modes{10};            ///< M_max
  bool enhance_depth{true};     ///< lines 16–19; false: d′_e = d′
  /// Limit of the change by the guided filter; where it moves a depth farther, the measured depth is kept. Infinity: no
  /// limit, as printed.
  double max_depth_change_m{0.01};
  /// Width in σ_c of the Gaussian under which a surfel's modes are densest (densest_mode), which gives its final
  /// colour; 0: its heaviest mode, eq. 4.11 as printed.
  double choice_sigmas{8.0};
  ModeSharpeningConfig sharpening{};  ///< contribution of the neighbours' modes; no effect on the heaviest mode

  /// Algorithm 6 and eq. 4.11 to the letter: the heaviest mode, at its own place, with depths as far as the guided
  /// filter moves them (decisions 18, 19, 41).
  [[nodiscard]] static ModeFilterConfig as_printed();

  /// Answers invalid_argument for a bad guided filter or bad sharpening, K or a change of depth that is not positive,
  /// M_max outside 1 to 32, or choice_sigmas that are negative or not finite.
  [[nodiscard]] Status validate() const;
};

/// Result of filtering one frame.
struct ModeFilterReport {
  bool has_color{false};  ///< false: the frame was ignored
  std::size_t pixels{0};  ///< pixels associated with a surfel
  std::size_t guided{0};  ///< among these, pixels with a mode at the frame's beginning: their depths were enhanced
  std::size_t new_modes{0};
  std::size_t merged_modes{0};   ///< merged by compression
  std::size_t evicted_modes{0};  ///< evicted for lack of space, line 10
  double evicted_weight{0.0};
  double integrate_ms{0.0};      ///< lines 1–15 and 20–26, with measured depths
  double guided_filter_ms{0.0};  ///< lines 16–18
  double move_ms{0.0};           ///< line 19: positions move to the enhanced depths
};

/// Guidance of the pixels of a frame by modes.
struct ModeGuidance {
  static constexpr std::uint8_t kNoMode{255};

  std::vector<Eigen::Vector4f> values;      ///< colour in [0, 1] and depth of the nearest mode
  std::vector<std::uint8_t> used;           ///< 0 where there is no mode
  std::vector<std::uint8_t> mode_of_pixel;  ///< mode that the pixel was merged into, or kNoMode; set where it saw a
                                            ///< surfel
};

/// Runs beside SurfelFusion, frame by frame. Guidance comes from the modes at the frame's beginning. Then each pixel
/// goes through Algorithm 6, several pixels of one surfel in row-major order. The algorithm uses positions only in the
/// averages of eq. 4.6, which are linear. Modes therefore take the measured points first, in one pass through memory;
/// where the filtered depths differ from the measured ones, their share is added afterwards.
/// A pixel without guidance keeps its depth. The average without enhancement (eq. 4.12) is the colour and position of
/// the SurfelMap itself, as long as all frames have colour.
/// One caller at a time. Neither threads nor simd_target() change a bit of the result.
class ModeFilter {
 public:
  [[nodiscard]] static Result<ModeFilter> create(const ModeFilterConfig& config = {});

  /// Adds the frame that SurfelFusion processed last, with its association. O(pixels · modes).
  /// @return size_mismatch if frame and association differ in size.
  [[nodiscard]] Result<ModeFilterReport> add_frame(const Frame& frame, const SurfelAssociation& seen,
                                                   const Executor& executor);

  /// Returns one surfel's modes in the order of their creation.
  [[nodiscard]] std::vector<SurfelMode> modes(SurfelId id) const;
  /// Returns the final colour and position of each surfel (choice_sigmas, sharpening); weight 0 where it has no mode.
  [[nodiscard]] std::vector<SurfelMode> winners(const Executor& executor) const;
  [[nodiscard]] std::size_t size() const { return store_.size(); }
  /// Returns the memory of the modes.
  [[nodiscard]] std::size_t memory_bytes() const { return store_.memory_bytes(); }
  [[nodiscard]] const ModeFilterConfig& config() const { return config_; }

 private:
  explicit ModeFilter(const ModeFilterConfig& config)
      : config_{config}, guided_{config.guided}, store_{static_cast<std::size_t>(config.max_modes)} {}
  void integrate(const Frame& frame, const SurfelAssociation& seen, const Executor& executor, ModeFilterReport& report);
  void move_to_enhanced(const Frame& frame, const SurfelAssociation& seen, const Executor& executor);

  ModeFilterConfig config_;
  GuidedFilter guided_;
  ModeStore store_;
  float lightest_{1.0F};  ///< smallest weight of a pixel so far
  ModeGuidance guidance_;
  std::vector<float> enhanced_m_;
};

}  // namespace saccade
