// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmSilhouette: an arm in the image of the camera that it holds; masks its pixels in the depth image.

#include <memory>
#include <optional>
#include <vector>

#include "saccade/arm/kinematics.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

class DepthRaster;
struct RasterGrowth;

struct ArmSilhouetteConfig {
  double margin_m{0.01};   ///< enlargement of the bodies, since models, joints and hand-eye transforms are inexact
  double border_px{2.0};   ///< enlargement of their image, since depth at edges is mixed
  double most_share{0.1};  ///< limit of both together, as a share of the image's width
  /// Depth nearer than the enlarged body by less than this times z² still belongs to the body. Four standard deviations
  /// and a disparity step of a Kinect v1 (kinect_v1_noise), which are 24 mm at 2 m.
  double depth_error_per_m{0.006};

  /// Answers invalid_argument for negative numbers and numbers that are not finite.
  [[nodiscard]] Status validate() const;
};

/// Silhouette of an arm. The arm's position in the image depends on the configuration alone, because the camera is
/// fixed to the last link.
///
/// Visible are the faces of closed bodies that point to the camera, so that a body around the camera's centre, its own
/// housing, hides nothing; and all faces of open meshes. Inverted closed meshes are corrected. Nothing nearer than
/// DepthRaster::kNearest_m along z is visible. Cylinders and spheres are those of body_surface. Bodies of the last link
/// do not move in the image and are drawn once. Immutable; safe for concurrent use. The thread count never changes a
/// result.
class ArmSilhouette {
 public:
  /// Creates the silhouette. Errors: those of PinholeCamera and ArmSilhouetteConfig::validate. Answers
  /// invalid_argument, naming the bodies, when bodies of the last link cover more than 90 % of the image: such a camera
  /// would see nothing. O(triangles).
  [[nodiscard]] static Result<ArmSilhouette> create(const ArmModel& arm, const PinholeCamera& camera,
                                                    const ArmSilhouetteConfig& config = {});

  /// Returns the depth of the bodies along z in metres, without margin; 0 where there is none. Includes bodies nearer
  /// than the camera's minimum range: they give no return, but hide what is behind them. About half a millisecond at
  /// 640×480.
  [[nodiscard]] DepthImage depth(const Configuration& q, const Executor& executor = {}) const;

  /// Sets every pixel covered by the enlarged arm to 0 (no return), free claims (d < 0) included, so that fusion learns
  /// nothing there. It keeps depth that is nearer than the enlarged arm by more than the depth's error: an object
  /// stands in front of the arm. Farther depth is also removed, since model and camera contradict each other there.
  /// Returns the number of pixels that lost a measurement; size_mismatch when the image is not of the camera's size.
  /// Microseconds when the arm is not in the image.
  [[nodiscard]] Result<std::size_t> mask(const Configuration& q, DepthImage& depth,
                                         const Executor& executor = {}) const;

  /// Tells whether mask() would examine any pixel.
  [[nodiscard]] bool in_picture(const Configuration& q) const;

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] const ArmSilhouetteConfig& config() const { return config_; }

 private:
  /// Surface of a body in its link's frame.
  struct Surface {
    std::size_t link;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// Triangle across the edge from corner i to the next; kNone where the surface ends.
    std::vector<std::array<std::uint32_t, 3>> neighbors;
    bool closed{false};
    Eigen::Vector3d center{Eigen::Vector3d::Zero()};  ///< centre of a ball around it
    double radius_m{0.0};
  };
  static constexpr std::uint32_t kNone{~0U};

  ArmSilhouette(const ArmModel& arm, const PinholeCamera& camera, const ArmSilhouetteConfig& config);
  [[nodiscard]] static Surface surface_of(const CollisionBody& body, std::size_t link);
  static void connect(Surface& surface);
  [[nodiscard]] RasterGrowth growth() const;
  [[nodiscard]] bool may_be_seen(const Surface& surface, const Pose& T_camera_link) const;
  static void add(const Surface& surface, const Pose& T_camera_link, DepthRaster& raster);
  /// Calls visit(index of the first pixel, inverse depth) for each block of rows.
  template <class Visit>
  void draw(const DepthRaster& raster, const std::optional<Image<float>>& hand, const Executor& executor,
            const Visit& visit) const;
  /// Returns the raster of the links that move relative to the camera.
  [[nodiscard]] DepthRaster others(const Configuration& q, const RasterGrowth& growth) const;

  std::shared_ptr<const ArmModel> arm_;
  PinholeCamera camera_;
  ArmSilhouetteConfig config_;
  std::vector<Surface> surfaces_;                  ///< surfaces of all links except the last
  std::optional<Image<float>> hand_;               ///< inverse depth of the last link; none: not in the image
  std::optional<Image<float>> hand_with_margins_;  ///< hand_ of the enlarged bodies
};

}  // namespace saccade
