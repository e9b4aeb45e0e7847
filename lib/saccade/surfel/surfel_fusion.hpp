// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelFusion: fuses RGB-D frames with poses into a map of surfels, frame by frame.  Thesis §4.1.1, eq. 4.1, 4.2.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/point_image.hpp"
#include "saccade/surfel/exposure_compensation.hpp"
#include "saccade/surfel/surfel_association.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Parameters of SurfelFusion. A measurement belongs to a surfel when their depths differ by no more than
/// depth_tolerance_m + depth_tolerance_growth_per_m · z², and their normals by no more than max_normal_angle_rad.
struct SurfelFusionConfig {
  double image_sigma{0.3};  ///< σ_img of eq. 4.2
  double depth_tolerance_m{0.02};
  double depth_tolerance_growth_per_m{0.005};  ///< a structured-light camera's noise grows with z²
  double max_normal_angle_rad{0.8};
  double max_view_angle_rad{1.4};  ///< between normal and view; flatter views create no surfel
  double max_radius_m{0.05};
  /// The slant of a surface enlarges its surfels at most this many times; 1: not at all. A flat view tells little of
  /// the normal, and the rim of a large disc then stands off the surface.
  double max_stretch{1000.0};

  /// Answers invalid_argument for values that are not finite or not positive, or angles of 90° and more.
  [[nodiscard]] Status validate() const;
};

/// Result of fusing one frame.
struct SurfelFusionReport {
  bool has_color{false};        ///< false: colours stay as they were
  std::size_t points{0};        ///< pixels with depth within range and a normal
  std::size_t associated{0};    ///< points associated with existing surfels
  std::size_t created{0};       ///< new surfels
  std::size_t contradicted{0};  ///< points at a surfel with a different normal, which are ignored
  double points_ms{0.0};
  double index_ms{0.0};
  double associate_ms{0.0};
  double exposure_ms{0.0};
  double integrate_ms{0.0};
  std::optional<ExposureReport> exposure{};  ///< set for frames with colour that were compensated
};

/// Fusion of frames. The method is the published one (Keller et al., 3DV 2013; Whelan et al., RSS 2015), with an index
/// image at the camera's resolution. Of the surfels that project into a pixel's cell, the one nearest to the measured
/// depth fills it (without a measurement: the one nearest to the camera). Two surfaces that are visible there
/// alternately thus keep a surfel each. A pixel takes the surfel of its own cell; otherwise, of the surfels around
/// whose discs cover its ray, the one nearest to the ray. So no holes open while the camera approaches, up to about
/// half the distance. Beyond that, new, smaller surfels fill them. No surfel is created at the depth of an existing
/// one, whatever its normal, so a camera at rest adds none.
/// One caller at a time. Neither threads nor simd_target() change a bit of the result.
class SurfelFusion {
 public:
  /// @param map  surfels of an earlier fusion with this configuration, which goes on as if it had never stopped
  [[nodiscard]] static Result<SurfelFusion> create(const SurfelFusionConfig& config = {}, SurfelMap map = {});

  /// Fuses one frame. O(surfels + pixels).
  /// @return errors leave the map as it was: invalid_argument for a bad camera, or a pose that is missing or not
  ///         finite; size_mismatch if depth or colour differ from the camera's size.
  [[nodiscard]] Result<SurfelFusionReport> add_frame(const Frame& frame, const PinholeCamera& camera,
                                                     const Executor& executor);
  /// Fuses one frame as above, after adapting its colours to the exposure of the map. Afterwards `frame` holds the
  /// adapted colours, for the mode filter.
  [[nodiscard]] Result<SurfelFusionReport> add_frame(Frame& frame, const PinholeCamera& camera,
                                                     ExposureCompensation& exposure, const Executor& executor);

  [[nodiscard]] const SurfelFusionConfig& config() const { return config_; }
  [[nodiscard]] const SurfelMap& map() const { return map_; }
  /// Returns the association of the last frame.
  [[nodiscard]] const SurfelAssociation& association() const { return association_; }

 private:
  SurfelFusion(const SurfelFusionConfig& config, SurfelMap map) : config_{config}, map_{std::move(map)} {}
  /// Performs all of add_frame except integrate().
  [[nodiscard]] Result<SurfelFusionReport> associate(const Frame& frame, const PinholeCamera& camera,
                                                     const Executor& executor);
  void prepare(const PinholeCamera& camera, const Pose& T_world_camera);
  void project(const PointImage& points, const Executor& executor);
  void associate(const PointImage& points, const Executor& executor, SurfelFusionReport& report);
  void number_new_surfels(const std::vector<std::size_t>& created, const Executor& executor);
  void integrate(const Frame& frame, const Executor& executor, SurfelFusionReport& report);

  SurfelFusionConfig config_;
  SurfelMap map_;
  SurfelAssociation association_;
  PointImage points_;                 ///< points of the last frame
  std::vector<std::uint64_t> cells_;  ///< (bits of the difference in depth, id); the smallest fills the cell
};

}  // namespace saccade
