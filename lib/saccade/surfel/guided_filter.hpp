// SPDX-License-Identifier: Apache-2.0
#pragma once
// GuidedFilter: smooths a depth image where its guidance (colour and depth of the visible surfels) is smooth, and keeps
// its edges where the guidance has edges. Thesis §4.1.1, Algorithm 7, eq. 4.4; He, Sun and Tang, "Guided image
// filtering".

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct GuidedFilterConfig {
  int radius_px{3};            ///< R_m: circular window, δu² + δv² ≤ R_m²
  double color_sigma{0.005};   ///< σ_c, in the unit colour cube; Σ_E = diag(σ_c², σ_c², σ_c², σ_d²)
  double depth_sigma_m{0.05};  ///< σ_d

  /// Answers invalid_argument unless the radius is within 0 and 16 pixels, and each σ finite and at least 0.0001.
  [[nodiscard]] Status validate() const;
};

/// Filter of depth images, guided by colour and depth. With γ the guidance, d′ the depth and F_m the mean over the
/// window's used pixels inside the image:
///   μ = F_m(γ), δ = F_m(d′), Σ = F_m(γγᵀ) − μμᵀ, κ = F_m(γd′) − μδ, a = (Σ + Σ_E)⁻¹κ, b = δ − aᵀμ,
///   d′_e = F_m(a)ᵀγ + F_m(b).
/// One instance per calling thread; it keeps its memory between frames.
class GuidedFilter {
 public:
  /// Creates the filter. Requires a valid configuration (a contract).
  explicit GuidedFilter(GuidedFilterConfig config = {});
  ~GuidedFilter();
  GuidedFilter(GuidedFilter&&) noexcept;
  GuidedFilter& operator=(GuidedFilter&&) noexcept;

  [[nodiscard]] const GuidedFilterConfig& config() const { return config_; }

  /// Filters images of width·height pixels, row by row (a contract); empty images are accepted.
  /// @param depth_m     d′, along the camera's view.
  /// @param guidance    γ: (r, g, b, d), colours within 0 and 1, d in metres.
  /// @param used        0: the pixel has no guidance or no depth. It enters no mean, its depth and guidance are
  /// ignored, and its output is its input. The caller must mark such pixels: depths of 0 count as depths here, and a
  /// NaN that is used spoils the pixels within twice the radius.
  /// @param enhanced_m  d′_e; shares no memory with the inputs.
  /// Sums are in double precision and their terms exact, so that their differences keep all significant digits. For
  /// depths up to 100 m the output is within one unit in the last place of a float of the exact result. Threads and
  /// instruction sets never change a bit.
  /// O(pixels · radius); rows in parallel.
  void apply(int width, int height, std::span<const float> depth_m, std::span<const Eigen::Vector4f> guidance,
             std::span<const std::uint8_t> used, const Executor& executor, std::span<float> enhanced_m);

 private:
  struct Memory;
  GuidedFilterConfig config_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace saccade
