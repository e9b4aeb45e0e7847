// SPDX-License-Identifier: Apache-2.0
#pragma once
// ModeFilter: several colours and positions per surfel, of which the most frequent wins.  Thesis §4.1.1, Algorithm 6.

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

/// Parameters of sharpened modes: modes of the neighbours decide as well (decision 19).
struct ModeSharpeningConfig {
  double strength{2.0};      ///< λ; 0: every surfel by itself
  double reach_m{0.02};      ///< as far as wrong poses carry colours
  double color_sigma{0.06};  ///< colours that count as one, in [0, 1] as colours are

  /// invalid_argument for a strength that is negative, a reach or σ that is not positive, or any that is not finite.
  [[nodiscard]] Status validate() const;
};

/// Parameters of ModeFilter: Table 4.2. (σ_img is SurfelFusionConfig::image_sigma: both weigh pixels alike.)
struct ModeFilterConfig {
  GuidedFilterConfig guided{};  ///< R_m, σ_c and σ_d; σ_c is that of the modes too
  double color_sigmas{5.0};     ///< K: a colour farther from all modes is a new one; infinity: one mode for all
  int max_modes{10};            ///< M_max
  bool enhance_depth{true};     ///< lines 16–19; without: d′_e = d′
  /// A depth that the guided filter moves farther is taken as it was measured; infinity: all are moved, as printed.
  double max_depth_change_m{0.01};
  /// What a surfel is in the end: where its modes are densest, seen through a Gaussian of so many σ_c (densest_mode);
  /// 0: its heaviest mode, eq. 4.11 as printed.
  double choice_sigmas{8.0};
  ModeSharpeningConfig sharpening{};  ///< modes of the neighbours decide as well; of no use to the heaviest one

  /// invalid_argument for a bad guided filter, K or a change of depth that is not positive, M_max outside 1 to 32, or
  /// choice_sigmas that are negative or not finite, or bad sharpening.
  [[nodiscard]] Status validate() const;
};

/// What became of one frame.
struct ModeFilterReport {
  bool has_color{false};  ///< false: nothing was done
  std::size_t pixels{0};  ///< associated ones
  std::size_t guided{0};  ///< of these, with a mode at the frame's beginning: their depths were enhanced
  std::size_t new_modes{0};
  std::size_t merged_modes{0};   ///< by compression
  std::size_t evicted_modes{0};  ///< for want of room, line 10
  double evicted_weight{0.0};
  double integrate_ms{0.0};      ///< lines 1–15 and 20–26, with measured depths
  double guided_filter_ms{0.0};  ///< lines 16–18
  double move_ms{0.0};           ///< line 19: positions move to the enhanced depths
};

/// What modes say about the pixels of a frame.
struct ModeGuidance {
  static constexpr std::uint8_t kNoMode{255};

  std::vector<Eigen::Vector4f> values;      ///< colour in [0, 1] and depth of the nearest mode
  std::vector<std::uint8_t> used;           ///< 0: there is none
  std::vector<std::uint8_t> mode_of_pixel;  ///< the mode that the pixel went into, or kNoMode; where it saw a surfel
};

/// Runs beside SurfelFusion, frame by frame. Guidance comes from the modes at the frame's beginning; then each pixel
/// goes through Algorithm 6, several pixels of one surfel in row-major order. No line of it asks for a position but
/// the averages of eq. 4.6, which are linear: so modes take the measured points first, in one pass through memory, and
/// where the filtered depths differ from the measured ones their share is added afterwards.
/// A pixel without guidance keeps its depth. The average without enhancement (eq. 4.12) is the colour and position of
/// the SurfelMap itself, as long as all frames have colour.
/// One caller at a time. Neither threads nor simd_target() change a bit of the result.
class ModeFilter {
 public:
  [[nodiscard]] static Result<ModeFilter> create(const ModeFilterConfig& config = {});

  /// The frame that SurfelFusion took last, and what it made of it. O(pixels · modes).
  /// @return size_mismatch if frame and association differ in size.
  [[nodiscard]] Result<ModeFilterReport> add_frame(const Frame& frame, const SurfelAssociation& seen,
                                                   const Executor& executor);

  /// One surfel's modes, in the order in which they came.
  [[nodiscard]] std::vector<SurfelMode> modes(SurfelId id) const;
  /// What each surfel is in the end (choice_sigmas, sharpening); weight 0 where there is no mode.
  [[nodiscard]] std::vector<SurfelMode> winners(const Executor& executor) const;
  [[nodiscard]] std::size_t size() const { return store_.size(); }
  /// Of the modes.
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
  float lightest_{1.0F};  ///< weight of a pixel so far
  ModeGuidance guidance_;
  std::vector<float> enhanced_m_;
};

}  // namespace saccade
