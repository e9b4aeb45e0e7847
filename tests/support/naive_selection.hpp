// SPDX-License-Identifier: Apache-2.0
#pragma once
// Selections by the letter of their definition: every point and every pixel of its square against every other.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "saccade/annotate/selection.hpp"
#include "saccade/core/pose.hpp"

namespace saccade::test {

/// As a browser makes it: z forward of the camera, image up along −y of the camera.
inline Eigen::Matrix4d perspective(const Pose& T_world_camera, double focal_px, int width, int height, double near_m,
                                   double far_m) {
  Eigen::Matrix4d clip_camera = Eigen::Matrix4d::Zero();
  clip_camera(0, 0) = 2.0 * focal_px / width;
  clip_camera(1, 1) = -2.0 * focal_px / height;
  clip_camera(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_camera(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_camera(3, 2) = 1.0;
  return clip_camera * T_world_camera.inverse().matrix();
}

inline Eigen::Matrix4d orthographic(const Pose& T_world_camera, double px_per_m, int width, int height, double near_m,
                                    double far_m) {
  Eigen::Matrix4d clip_camera = Eigen::Matrix4d::Identity();
  clip_camera(0, 0) = 2.0 * px_per_m / width;
  clip_camera(1, 1) = -2.0 * px_per_m / height;
  clip_camera(2, 2) = 2.0 / (far_m - near_m);
  clip_camera(2, 3) = -(far_m + near_m) / (far_m - near_m);
  return clip_camera * T_world_camera.inverse().matrix();
}

inline bool naive_contains(const ScreenRectangle& shape, const ScreenPoint& p) {
  return p.x() >= std::min(shape.corner.x(), shape.opposite.x()) &&
         p.x() < std::max(shape.corner.x(), shape.opposite.x()) &&
         p.y() >= std::min(shape.corner.y(), shape.opposite.y()) &&
         p.y() < std::max(shape.corner.y(), shape.opposite.y());
}

inline bool naive_contains(const ScreenPolygon& shape, const ScreenPoint& p) {
  bool inside{false};
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    const ScreenPoint& a = shape.corners[i];
    const ScreenPoint& b = shape.corners[(i + 1) % shape.corners.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    if (p.x() >= a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

inline bool naive_contains(const ScreenStroke& shape, const ScreenPoint& p) {
  for (std::size_t i = 0; i < shape.line.size(); ++i) {
    const ScreenPoint& a = shape.line[i];
    const ScreenPoint along = shape.line[std::min(i + 1, shape.line.size() - 1)] - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::min(1.0, std::max(0.0, (p - a).dot(along) / length2)) : 0.0;
    if ((p - a - t * along).squaredNorm() <= shape.radius_px * shape.radius_px) return true;
  }
  return false;
}

/// A point's place in the picture; depth along the viewing direction. Nothing outside the view.
struct NaivePosition {
  bool in_view{false};
  double u_px{0.0}, v_px{0.0};
  float depth_m{0.0F};
};

inline NaivePosition naive_position(const SelectionView& view, const Eigen::Vector3f& p) {
  if (!p.allFinite()) return {};
  const Eigen::Vector3d q = p.cast<double>();
  Eigen::Vector4d clip;  // rounded as by the arithmetic that is tested, so that no point is in another pixel
  for (int i = 0; i < 4; ++i) {
    const auto row = view.clip_world.row(i);
    clip[i] = row[0] * q.x() + row[1] * q.y() + (row[2] * q.z() + row[3]);
  }
  if (!(clip.w() > 0.0) || std::abs(clip.z()) > clip.w()) return {};
  NaivePosition at;
  at.u_px = (clip.x() / clip.w() + 1.0) * 0.5 * view.width;
  at.v_px = (1.0 - clip.y() / clip.w()) * 0.5 * view.height;
  at.in_view = at.u_px >= 0.0 && at.u_px < view.width && at.v_px >= 0.0 && at.v_px < view.height;
  const bool is_perspective = !view.clip_world.row(3).head<3>().isZero(0.0);
  const Eigen::Index row = is_perspective ? 3 : 2;
  at.depth_m = static_cast<float>(clip[row] / view.clip_world.row(row).head<3>().norm());
  return at;
}

inline std::vector<NaivePosition> naive_positions(const SelectionView& view,
                                                  std::span<const Eigen::Vector3f> positions_m) {
  std::vector<NaivePosition> positions;
  for (const Eigen::Vector3f& p : positions_m) positions.push_back(naive_position(view, p));
  return positions;
}

/// Returns the depth shown by a pixel; infinite: nothing.
inline float naive_depth_m(const std::vector<NaivePosition>& positions, double half_px, int u, int v) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const NaivePosition& at : positions) {
    const double right = u + 0.5 - at.u_px;
    const double below = v + 0.5 - at.v_px;
    const bool covers = at.in_view && right > -half_px && right <= half_px && below > -half_px && below <= half_px;
    if (covers) nearest = std::min(nearest, at.depth_m);
  }
  return nearest;
}

/// Picture of a cloud, for several selections in it.
class NaivePicture {
 public:
  NaivePicture(std::span<const Eigen::Vector3f> positions_m, const SelectionView& view)
      : view_{view}, positions_{naive_positions(view, positions_m)} {
    for (int v = 0; v < view.height; ++v) {
      for (int u = 0; u < view.width; ++u) {
        depths_m_.push_back(naive_depth_m(positions_, 0.5 * view.point_size_px, u, v));
      }
    }
    thickness_m_.assign(depths_m_.size(), -1.0F);
  }
  [[nodiscard]] const std::vector<NaivePosition>& positions() const { return positions_; }
  [[nodiscard]] float depth_m(int u, int v) const { return depths_m_[index(u, v)]; }
  /// Returns how far behind the depth of a pixel its points still belong to what is seen. Expects one that shows a
  /// point.
  float thickness_m(int u, int v) {
    float& thickness_m = thickness_m_[index(u, v)];
    if (thickness_m >= 0.0F) return thickness_m;
    const int size = view_.point_size_px;
    float farthest_m = depth_m(u, v);
    for (int row = std::max(0, v - size / 2); row <= std::min(view_.height - 1, v + size / 2); ++row) {
      for (int column = std::max(0, u - size / 2); column <= std::min(view_.width - 1, u + size / 2); ++column) {
        if (std::isfinite(depth_m(column, row))) farthest_m = std::max(farthest_m, depth_m(column, row));
      }
    }
    const float pixel_m = ScreenProjection{view_}.pixel_m(depth_m(u, v));
    thickness_m = std::min(farthest_m - depth_m(u, v) + static_cast<float>(size + 3) * pixel_m,
                           static_cast<float>(8 * (size + 1)) * pixel_m);
    return thickness_m;
  }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(u);
  }

  SelectionView view_;
  std::vector<NaivePosition> positions_;
  std::vector<float> depths_m_;
  std::vector<float> thickness_m_;  ///< negative where it was not asked for
};

inline std::vector<std::uint32_t> naive_select(NaivePicture& picture, const ScreenShape& shape, double below_m,
                                               SurfaceRule rule = SurfaceRule::seen) {
  std::vector<std::uint32_t> selected;
  for (std::size_t i = 0; i < picture.positions().size(); ++i) {
    const NaivePosition& at = picture.positions()[i];
    if (!at.in_view) continue;
    const int u = static_cast<int>(std::floor(at.u_px));
    const int v = static_cast<int>(std::floor(at.v_px));
    if (!std::visit([&](const auto& of) { return naive_contains(of, {u + 0.5, v + 0.5}); }, shape)) continue;
    const float shown_m = picture.depth_m(u, v);
    const bool is_selected =
        rule == SurfaceRule::as_printed
            ? at.depth_m - shown_m <= below_m
            : at.depth_m <= shown_m + std::max(static_cast<float>(below_m), picture.thickness_m(u, v));
    if (is_selected) selected.push_back(static_cast<std::uint32_t>(i));
  }
  return selected;
}

}  // namespace saccade::test
