// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/selection.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <string>

namespace saccade {

namespace {

constexpr int kLargestEdge{8192};
constexpr int kLargestPoint{64};

bool is_perspective(const Eigen::Matrix4d& clip_world) { return !clip_world.row(3).head<3>().isZero(0.0); }

/// Returns the rows of x, y and of the depth.
Eigen::Matrix3d seen_axes(const Eigen::Matrix4d& clip_world) {
  Eigen::Matrix3d axes;
  axes.row(0) = clip_world.row(0).head<3>();
  axes.row(1) = clip_world.row(1).head<3>();
  axes.row(2) = clip_world.row(is_perspective(clip_world) ? 3 : 2).head<3>();
  return axes;
}

bool is_size(int size, int largest) { return size >= 1 && size <= largest; }

}  // namespace

Status SelectionView::validate() const {
  if (!is_size(width, kLargestEdge) || !is_size(height, kLargestEdge)) {
    return Error{Errc::invalid_argument, "width and height must be 1 to " + std::to_string(kLargestEdge) + " px",
                 "selection view"};
  }
  if (!is_size(point_size_px, kLargestPoint)) {
    return Error{Errc::invalid_argument, "point_size_px must be 1 to " + std::to_string(kLargestPoint),
                 "selection view"};
  }
  constexpr std::size_t kMostPlanes{16};
  const bool are_planes =
      planes.size() <= kMostPlanes &&
      std::all_of(planes.begin(), planes.end(), [](const auto& plane) { return plane.allFinite(); });
  if (!are_planes) {
    return Error{Errc::invalid_argument, "a view may have 16 clip planes, of finite numbers", "selection view"};
  }
  const bool is_view = clip_world.allFinite() && (is_perspective(clip_world) || clip_world(3, 3) > 0.0) &&
                       seen_axes(clip_world).inverse().allFinite();
  if (!is_view) {
    return Error{Errc::invalid_argument, "the matrix is not a perspective or orthographic view of space",
                 "selection view"};
  }
  return {};
}

ScreenProjection::ScreenProjection(const SelectionView& view)
    : view_{view},
      clip_world_{view.clip_world},
      world_clip_{seen_axes(view.clip_world).inverse()},
      half_width_{0.5 * view.width},
      half_height_{0.5 * view.height},
      perspective_{is_perspective(view.clip_world)},
      m_per_clip_{1.0 / seen_axes(view.clip_world).row(2).norm()} {
  const Eigen::Vector3d middle = place(half_width_, half_height_, 1.0);
  const double across_m = (place(half_width_ + 1.0, half_height_, 1.0) - middle).norm();
  const double down_m = (place(half_width_, half_height_ + 1.0, 1.0) - middle).norm();
  (perspective_ ? pixel_per_m_ : pixel_m_) = static_cast<float>(std::max(across_m, down_m));
}

Eigen::Vector3d ScreenProjection::place(double u_px, double v_px, double depth_m) const {
  const double along = depth_m / m_per_clip_;
  const double w = perspective_ ? along : clip_world_(3, 3);
  const Eigen::Vector3d clip{(u_px / half_width_ - 1.0) * w, (1.0 - v_px / half_height_) * w, along};
  const Eigen::Vector3d origin{clip_world_(0, 3), clip_world_(1, 3), clip_world_(perspective_ ? 3 : 2, 3)};
  return world_clip_ * (clip - origin);
}

}  // namespace saccade
