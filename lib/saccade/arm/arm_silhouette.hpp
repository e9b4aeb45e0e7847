// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmSilhouette: an arm in the picture of the camera that it holds; its pixels are taken out of the depth.

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
  double margin_m{0.01};   ///< the bodies are taken for so much larger: models, joints and hand-eye transforms err
  double border_px{2.0};   ///< and their picture for so much wider: depth at edges is mixed
  double most_share{0.1};  ///< both together widen the picture by at most this share of the image's width
  /// Depth that is nearer than the enlarged body by less than this times z² still counts as the body. Four standard
  /// deviations and a disparity step of a Kinect v1 (kinect_v1_noise), which are 24 mm at 2 m.
  double depth_error_per_m{0.006};

  /// invalid_argument for what is negative or not finite.
  [[nodiscard]] Status validate() const;
};

/// Where the arm stands in the picture depends on the configuration alone: the camera is fixed to the last link.
///
/// What is seen: of closed bodies the faces that point to the camera, so that a body around the camera's centre, its
/// own housing, hides nothing; of open meshes all faces. Closed meshes that are inside out are turned. Nothing nearer
/// than DepthRaster::kNearest_m along z is seen. Cylinders and spheres are those of body_surface. Bodies of the last
/// link stand still in the picture and are drawn once. Immutable; safe for concurrent use; every function gives the
/// same for every thread count.
class ArmSilhouette {
 public:
  /// Errors: those of PinholeCamera and ArmSilhouetteConfig::validate, and invalid_argument when bodies of the last
  /// link cover more than 90 % of the picture, with their names: such a camera would see nothing. O(triangles).
  [[nodiscard]] static Result<ArmSilhouette> create(const ArmModel& arm, const PinholeCamera& camera,
                                                    const ArmSilhouetteConfig& config = {});

  /// Depth of the bodies along z, metres, as they are, without margin; 0: none. Nearer than the camera's minimum range
  /// too: a body there gives no return, but hides what is behind it. About half a millisecond at 640×480.
  [[nodiscard]] DepthImage depth(const Configuration& q, const Executor& executor = {}) const;

  /// Sets every pixel that the enlarged arm covers to 0 (no return), free claims (d < 0) included, so that fusion
  /// learns nothing there; except where the depth is nearer than the enlarged arm by more than the depth's error:
  /// something stands before the arm. Farther depth goes too: where the model says arm and the camera sees through, one
  /// of the two is wrong. How many pixels lost a measurement; size_mismatch when the image is not of the camera's size.
  /// Microseconds when the arm is not in the picture.
  [[nodiscard]] Result<std::size_t> mask(const Configuration& q, DepthImage& depth,
                                         const Executor& executor = {}) const;

  /// Whether mask() would look at any pixel.
  [[nodiscard]] bool in_picture(const Configuration& q) const;

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] const ArmSilhouetteConfig& config() const { return config_; }

 private:
  /// A body's surface in its link's frame.
  struct Surface {
    std::size_t link;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// Across the edge from corner i to the next; kNone where the surface ends.
    std::vector<std::array<std::uint32_t, 3>> neighbors;
    bool closed{false};
    Eigen::Vector3d center{Eigen::Vector3d::Zero()};  ///< of a ball around it
    double radius_m{0.0};
  };
  static constexpr std::uint32_t kNone{~0U};

  ArmSilhouette(const ArmModel& arm, const PinholeCamera& camera, const ArmSilhouetteConfig& config);
  [[nodiscard]] static Surface surface_of(const CollisionBody& body, std::size_t link);
  static void connect(Surface& surface);
  [[nodiscard]] RasterGrowth growth() const;
  [[nodiscard]] bool may_be_seen(const Surface& surface, const Pose& T_camera_link) const;
  static void add(const Surface& surface, const Pose& T_camera_link, DepthRaster& raster);
  /// Calls visit(index of its first pixel, inverse depth) for each block of rows.
  template <class Visit>
  void draw(const DepthRaster& raster, const std::optional<Image<float>>& hand, const Executor& executor,
            const Visit& visit) const;
  /// The links that move before the camera.
  [[nodiscard]] DepthRaster others(const Configuration& q, const RasterGrowth& growth) const;

  std::shared_ptr<const ArmModel> arm_;
  PinholeCamera camera_;
  ArmSilhouetteConfig config_;
  std::vector<Surface> surfaces_;                  ///< of all links but the last
  std::optional<Image<float>> hand_;               ///< inverse depth of the last link; none: not in the picture
  std::optional<Image<float>> hand_with_margins_;  ///< the same, enlarged
};

}  // namespace saccade
