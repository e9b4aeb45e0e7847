// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthFilter: removes wrong points from a Kinect v2's depth images: points in the emitter's shadow, and veil points at
// edges. Thesis §3.1.3.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

enum class ShadowState : std::uint8_t;

/// Side of the infrared emitter, seen along the camera's view: left is towards u = 0. The thesis' equations have it on
/// the left; drivers that mirror the image need the right.
enum class EmitterSide { left, right };
inline constexpr auto kEmitterSideNames =
    make_names<EmitterSide>({{EmitterSide::left, "left"}, {EmitterSide::right, "right"}});

enum class DepthFilterMethod : std::uint8_t {
  thesis,   ///< removes every point that may be wrong: Algorithm 5 and eq. 3.19
  surface,  ///< as thesis, but keeps points that lie on a surface.  docs/guides/depth-filter.md
};
inline constexpr auto kDepthFilterMethodNames =
    make_names<DepthFilterMethod>({{DepthFilterMethod::surface, "surface"}, {DepthFilterMethod::thesis, "thesis"}});

struct DepthFilterConfig {
  DepthFilterMethod method{DepthFilterMethod::surface};
  double baseline_m{0.08};                      ///< Δ: from the camera's centre to the emitter, along its x axis
  EmitterSide emitter_side{EmitterSide::left};  ///< shadows fall to the other side of an object
  double veil_angle_rad{10_deg};                ///< Θ_max of eq. 3.19
  double baseline_uncertainty{0.15};            ///< relative uncertainty of the baseline; method surface
  double tolerance_m{0.004};  ///< a point lies on a surface within tolerance_m + tolerance_per_m · z; the same
  double tolerance_per_m{0.004};
  bool remove_shadow_points{true};
  bool remove_veil_points{true};

  /// Answers invalid_argument unless the baseline is within 0 and 1 m, its uncertainty within 0 and 1, the angle above
  /// 0 and below 90°, and the tolerance finite and not negative.
  [[nodiscard]] Status validate() const;
};

/// State of a pixel after filtering. A pixel that both steps remove is a shadow point.
enum class FilteredPixel : std::uint8_t { no_return, kept, shadow_point, veil_point };

struct FilteredDepth {
  DepthImage depth;             ///< 0 where a point was removed, otherwise as in the input
  Image<FilteredPixel> pixels;  ///< state of each pixel
  std::size_t points{0};        ///< returns in the input image
  std::size_t shadow_points{0};
  std::size_t veil_points{0};

  [[nodiscard]] std::size_t kept() const { return points - shadow_points - veil_points; }
};

/// Method thesis. Shadow points: seen by the camera, not lit by the emitter. A point is removed when its angle from the
/// emitter (eq. 3.16) is not beyond that of every point before it in its row, counted from the emitter's side (eq.
/// 3.18, Algorithm 5). The condition is necessary, not sufficient: behind a thin object, lit points are removed too.
/// Veil points: between an edge and the surface behind it. A point is removed when the line to one of its four
/// neighbours is within veil_angle_rad of the line from the camera (eq. 3.19; the thesis' text says "higher than").
/// This removes the points on both sides of an edge.
///
/// Method surface. A shadow point stays if no visible surface blocks its light and it lies on the background beside the
/// shadow. A point that would be in shadow if the baseline were somewhat longer is removed if it lies on no surface. A
/// veil point stays if it lies on the surface of the next two pixels on one side.
///
/// Both steps read the unfiltered image. Each row needs itself and two neighbours on either side; nothing is kept
/// between images.
/// images.
class DepthFilter {
 public:
  /// Creates a filter for the camera of the depth images, without distortion. Answers invalid_argument: see
  /// PinholeCamera and DepthFilterConfig.
  [[nodiscard]] static Result<DepthFilter> create(const PinholeCamera& camera, const DepthFilterConfig& config = {});

  [[nodiscard]] const DepthFilterConfig& config() const { return config_; }

  /// Filters an image. Pixels without a return (0, NaN, infinity) and free claims (d < 0) are kept unchanged, and
  /// neither cast shadows nor count as neighbours. Answers size_mismatch unless the image has the camera's size.
  /// O(pixels), rows in parallel. The thread count never changes the result. Safe to call concurrently.
  [[nodiscard]] Result<FilteredDepth> filter(const DepthImage& depth, const Executor& executor = {}) const;

 private:
  DepthFilter(const PinholeCamera& camera, const DepthFilterConfig& config);
  void mark_shadow_points(const float* z, FilteredPixel* pixels) const;
  void mark_veil_points(const DepthImage& depth, int v, FilteredPixel* pixels) const;
  [[nodiscard]] float jump_per_m(double step) const;
  [[nodiscard]] Image<ShadowState> classify_shadows(const DepthImage& depth, const Executor& executor) const;
  void mark_unlit_points(const DepthImage& depth, const Image<ShadowState>& states, int v, FilteredPixel* pixels) const;
  void mark_unsupported_points(const DepthImage& depth, const Image<ShadowState>& states, int v,
                               FilteredPixel* pixels) const;

  DepthFilterConfig config_;
  std::vector<double> x_;  ///< x of the ray through each column, at z = 1
  std::vector<double> y_;  ///< y of the ray through each row, at z = 1
  double step_x_;          ///< between columns, at z = 1
  double step_y_;
};

}  // namespace saccade
