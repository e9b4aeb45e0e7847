// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnalyticScene: boxes, spheres, cylinders and planes with exact surfaces, rendered to depth and colour; a sample
// table-top and a sample trajectory around it. Ground truth for tests, examples and the demo.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Half space below the plane normal·p = offset_m; its surface is visible from above. The normal has length 1.
struct HalfSpace {
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};
  double offset_m{0.0};
};

/// Squares of two shades on the surface; edge 0 is plain.
struct Checker {
  double edge_m{0.0};
  double darkening{0.35};  ///< colour of every other square, relative to the full colour
};

struct AnalyticObject {
  std::string name;
  std::variant<Sphere, Box, Cylinder, HalfSpace> shape;
  Rgb8 color{200, 200, 200};
  Checker checker{};
};

/// Point where a ray meets a surface.
struct SurfaceHit {
  double t{0.0};                                          ///< p = origin + t·direction
  Eigen::Vector3d normal_world{Eigen::Vector3d::Zero()};  ///< outward, length 1
  int object{-1};                                         ///< index into AnalyticScene::objects
};

struct RenderedFrame {
  DepthImage depth;      ///< metres along z; 0 where nothing is hit within the camera's range
  ColorImage color;      ///< black where depth is 0
  Image<int> object_id;  ///< index into AnalyticScene::objects; −1 where depth is 0
};

/// Union of solid objects.
struct AnalyticScene {
  std::vector<AnalyticObject> objects;
  /// Towards the light, world frame; Lambert shading over an ambient share.
  Eigen::Vector3d to_light_world{0.3, -0.5, 0.8};
  double ambient{0.35};

  /// Returns the nearest hit with t > 0 of the ray origin + t·direction, entering an object from outside; the first
  /// object at a tie.
  [[nodiscard]] std::optional<SurfaceHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Returns the signed distance to the union's surface, negative inside; exact outside, a lower bound of the depth
  /// inside.
  [[nodiscard]] double signed_distance_m(const Eigen::Vector3d& p_world) const;
  /// Checks sizes and names of all objects. Answers invalid_argument.
  [[nodiscard]] Status validate() const;
};

/// Renders the camera's view: pixel (u, v) is the ray through (u, v), exact to rounding. Answers invalid_argument for a
/// bad camera. O(pixels · objects). The thread count never changes the result.
[[nodiscard]] Result<RenderedFrame> render(const AnalyticScene& scene, const PinholeCamera& camera,
                                           const Pose& T_world_camera, const Executor& executor = {});

/// Returns a scene: a table slab with its top at z = 0, 1.2 × 0.8 m around the origin, four objects of different shape
/// and colour on it, a floor and a back wall. Checkered, so that pictures and tracking have texture.
[[nodiscard]] AnalyticScene sample_tabletop();

/// Returns n ≥ 1 poses on an arc of 140° around the table at 0.75 to 0.95 m, looking at a point 5 cm above its centre.
/// Height and distance vary smoothly. With n = 60, neighbours differ by about 4 cm and 2.5°.
[[nodiscard]] std::vector<Pose> sample_trajectory(std::size_t n);

}  // namespace saccade
