// SPDX-License-Identifier: Apache-2.0
#pragma once
// RenderedSequence: a simulated hand-held RGB-D camera as a CameraSource, with ground truth for every pixel.
// surfel_scene: scenes with small painted parts and a camera path. Thesis §4.1.3, Fig. 4.4.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/scene/simulated_camera.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/noise.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/sensor/srgb.hpp"

namespace saccade {

/// Linear light, 1: white.
using LightImage = Image<std::array<float, 3>>;

enum class Vignetting : std::uint8_t { off, on, corrected };
inline constexpr auto kVignettingNames =
    make_names<Vignetting>({{Vignetting::on, "on"}, {Vignetting::off, "off"}, {Vignetting::corrected, "corrected"}});

struct ColorCameraConfig {
  /// on: light falls off with the fourth power of the cosine of the angle from the axis, to 0.45 in the corners of an
  /// Xtion; Alexandrov et al. (IROS 2016) measured half. corrected: divided by this factor again after the noise, as
  /// they do with a calibration, which is taken as exact.
  Vignetting vignetting{Vignetting::on};
  /// Shot and read noise (Poissonian and Gaussian; Foi et al., IEEE TIP 2008); the two values below are in electrons.
  bool noise{true};
  double electrons_at_white{4000.0};
  double read_noise_electrons{10.0};
  /// Whether the gain follows the image's mean light: it then moves towards the target with a time constant, within its
  /// limits.
  bool automatic_gain{false};
  double target_light{0.25};
  double time_constant_frames{15.0};
  double max_gain{2.0};  ///< the lower limit is 1/max_gain
  std::uint64_t seed{1};

  /// Answers invalid_argument for numbers that are not positive, and a largest gain below 1.
  [[nodiscard]] Status validate() const;
};

/// Returns the share of the light that reaches an image point.
[[nodiscard]] double vignetting_at(const PinholeCamera& camera, double u, double v);

/// Returns the gain of the frame that follows one taken with `gain`. mean_light is measured before any gain.
[[nodiscard]] double next_gain(const ColorCameraConfig& config, double gain, double mean_light);
/// Returns the mean light at the sensor over pixels and channels. Expects an image of the camera's size.
[[nodiscard]] double mean_light(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config);

/// Exposes an image in 8-bit sRGB. Noise depends on seed, frame and pixel alone. Expects a valid configuration and an
/// image of the camera's size. O(pixels).
[[nodiscard]] ColorImage expose(const LightImage& light, const PinholeCamera& camera, const ColorCameraConfig& config,
                                double gain, std::uint64_t frame, const Executor& executor = {});

/// Path of a hand-held camera. It looks at a target that wanders in a box, from directions and distances that oscillate
/// at incommensurable rates, and trembles by some millimetres.
struct HandHeldPath {
  Box targets;
  double azimuth_from_rad{0.0};  ///< azimuth of the camera seen from the target, about z
  double azimuth_to_rad{0.0};
  double elevation_from_rad{0.0};
  double elevation_to_rad{0.0};
  double distance_from_m{0.9};
  double distance_to_m{1.4};
  double tremor_m{0.0015};
  double roll_rad{0.06};
};
/// Returns the poses. Expects frames ≥ 1; the number of frames does not change the path's extent. A seed shifts the
/// oscillations.
[[nodiscard]] std::vector<Pose> hand_held_poses(const HandHeldPath& path, std::size_t frames, std::uint64_t seed = 1);

/// Errors of the delivered poses: a drift that changes smoothly over a number of frames, and jitter; normal, per axis.
struct PoseNoise {
  double drift_m{0.004};
  double drift_rad{0.003};
  double drift_frames{60.0};
  double jitter_m{0.0005};
  double jitter_rad{0.0005};
  std::uint64_t seed{1};
};
[[nodiscard]] std::vector<Pose> with_noise(const std::vector<Pose>& T_world_camera, const PoseNoise& noise);

struct RenderedSequenceConfig {
  PinholeCamera camera;
  ColorCameraConfig color;
  std::optional<PoseNoise> pose_noise{PoseNoise{}};
  std::optional<DepthNoise> depth_noise;             ///< noise of a structured-light camera; none: exact
  double lateral_noise_px{0.0};                      ///< standard deviation, with depth_noise
  std::optional<TimeOfFlightConfig> time_of_flight;  ///< replaces both
};

struct SequenceTruth {
  Pose T_world_camera;         ///< without noise
  DepthImage depth;            ///< exact
  Image<std::uint16_t> label;  ///< as in SegmentTable; 0 where nothing is within the range
  double gain{1.0};
};

/// Rendered frames. One caller at a time. The n-th frame is equal on every machine and for every thread count. Depth is
/// that of one ray per pixel. Colour is the mean light of 4×4 rays where the pixel's neighbours belong to another
/// segment or body, or it lies in print; elsewhere of one ray. A lamp shines from 2.5 m above the middle of the
/// workspace, besides ambient light. There are no shadows and no motion blur.
class RenderedSequence final : public CameraSource {
 public:
  /// Answers invalid_argument as the parts of the configuration, or without poses.
  [[nodiscard]] static Result<RenderedSequence> create(RayScene scene, std::vector<Pose> T_world_camera,
                                                       const RenderedSequenceConfig& config, Executor executor = {});

  [[nodiscard]] const PinholeCamera& camera() const override { return config_.camera; }
  [[nodiscard]] std::optional<std::size_t> size() const override { return true_poses_.size(); }
  [[nodiscard]] Result<std::optional<Frame>> next() override;

  /// Returns the ground truth of the frame that next() delivered last.
  [[nodiscard]] const SequenceTruth& truth() const { return truth_; }
  [[nodiscard]] const SegmentTable& segments() const { return segments_; }

 private:
  RenderedSequence(RayScene scene, std::vector<Pose> true_poses, std::vector<Pose> poses,
                   const RenderedSequenceConfig& config, Executor executor);
  [[nodiscard]] LightImage render_light(const Pose& T_world_camera);
  [[nodiscard]] DepthImage measured(const Pose& T_world_camera) const;

  RayScene scene_;
  SegmentTable segments_;
  std::vector<Pose> T_object_world_;
  std::vector<Pose> true_poses_;
  std::vector<Pose> poses_;
  RenderedSequenceConfig config_;
  Executor executor_;
  std::size_t next_{0};
  double gain_{1.0};
  SequenceTruth truth_;
};

constexpr std::array<std::string_view, 5> kSurfelScenes{"workshop-1", "workshop-2", "desk", "magazines-1",
                                                        "magazines-2"};

struct SurfelScene {
  Scene scene;
  HandHeldPath path;
  std::size_t frames{0};    ///< number of frames in the thesis' scene (Table 4.1)
  std::string_view sensor;  ///< sensor used by the thesis
  ColorCameraConfig color;  ///< properties and corrections of its colour camera
};

constexpr std::array<std::string_view, 2> kSurfelSensors{"xtion", "kinect-v2"};
/// Returns the camera of the preset, and the noise of its depth, colour and poses; docs/guides/surfel-scenes.md lists
/// the sources of the values. Answers not_found with the known names.
[[nodiscard]] Result<RenderedSequenceConfig> surfel_sensor(std::string_view name);

/// Answers not_found with the known names.
[[nodiscard]] Result<SurfelScene> surfel_scene(std::string_view name);

}  // namespace saccade
