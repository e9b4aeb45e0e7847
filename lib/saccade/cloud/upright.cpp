// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/upright.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace saccade {
namespace {

constexpr std::size_t kPlaneSample{4000};
constexpr int kPlaneTrials{400};
constexpr double kPlaneShare{1.0 / 6.0};
constexpr double kPlaneTolerance{0.008};                                // as a share of the sample's extent
constexpr double kCameraMostTilt_rad{50.0 * std::numbers::pi / 180.0};  // one camera may look down steeply
constexpr double kCamerasMostTilt_rad{12.0 * std::numbers::pi / 180.0};

/// Every n-th finite point.
std::vector<Eigen::Vector3d> plane_sample(std::span<const Eigen::Vector3f> positions_m) {
  const std::size_t every = std::max<std::size_t>(1, positions_m.size() / kPlaneSample);
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < positions_m.size(); i += every) {
    if (positions_m[i].allFinite()) sample.emplace_back(positions_m[i].cast<double>());
  }
  return sample;
}

struct Plane {
  Eigen::Vector3d normal{Eigen::Vector3d::UnitZ()};
  double offset_m{0.0};
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p) const { return std::abs(normal.dot(p) - offset_m); }
};

std::size_t count_near(const Plane& plane, std::span<const Eigen::Vector3d> points, double tolerance_m) {
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [&](const Eigen::Vector3d& p) { return plane.distance_m(p) <= tolerance_m; }));
}

/// The plane of least squares through the points near another one.
Plane refined(const Plane& plane, std::span<const Eigen::Vector3d> points, double tolerance_m) {
  Eigen::Vector3d sum{0.0, 0.0, 0.0};
  Eigen::Matrix3d products{Eigen::Matrix3d::Zero()};
  double count{0.0};
  for (const Eigen::Vector3d& p : points) {
    if (plane.distance_m(p) > tolerance_m) continue;
    sum += p;
    products += p * p.transpose();
    count += 1.0;
  }
  if (count < 3.0) return plane;
  const Eigen::Vector3d mean = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{products / count - mean * mean.transpose()};
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return {normal, normal.dot(mean)};
}

double extent_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d low{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
  Eigen::Vector3d high{-low};
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// The normal of the largest plane near `rough`; `rough` itself where no plane is large enough.
Eigen::Vector3d made_exact(const Eigen::Vector3d& rough, double most_tilt_rad,
                           std::span<const Eigen::Vector3f> positions_m) {
  const std::vector<Eigen::Vector3d> points = plane_sample(positions_m);
  if (points.size() < 30) return rough;
  const double tolerance_m = kPlaneTolerance * extent_of(points);
  const double least_cosine = std::cos(most_tilt_rad);
  std::mt19937 random{1};
  const auto any = [&] { return points[random() % points.size()]; };
  Plane best;
  std::size_t most{0};
  for (int trial = 0; trial < kPlaneTrials; ++trial) {
    const Eigen::Vector3d a = any();
    const Eigen::Vector3d b = any();
    const Eigen::Vector3d c = any();
    const Eigen::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    if (!(std::abs(normal.dot(rough)) >= least_cosine)) continue;
    const Plane plane{normal, normal.dot(a)};
    const std::size_t count = count_near(plane, points, tolerance_m);
    if (count > most) {
      most = count;
      best = plane;
    }
  }
  if (static_cast<double>(most) < kPlaneShare * static_cast<double>(points.size())) return rough;
  for (int round = 0; round < 3; ++round) best = refined(best, points, tolerance_m);
  const double cosine = best.normal.dot(rough);
  if (std::abs(cosine) < least_cosine) return rough;
  return cosine < 0.0 ? Eigen::Vector3d{-best.normal} : best.normal;
}

std::optional<Eigen::Vector3d> direction_of(const Eigen::Vector3d& v) {
  if (!v.allFinite() || v.norm() < 1e-9) return std::nullopt;
  return v.normalized();
}

/// Out of the mean direction that the cameras looked in.
std::optional<Eigen::Vector3d> towards_cameras(std::span<const Pose> T_world_cameras) {
  Eigen::Vector3d ahead{0.0, 0.0, 0.0};
  for (const Pose& pose : T_world_cameras) ahead += pose.linear().col(2);
  return ahead.norm() > 0.25 * static_cast<double>(T_world_cameras.size()) ? direction_of(-ahead) : std::nullopt;
}

std::optional<Eigen::Vector3d> up_of_cameras(std::span<const Pose> T_world_cameras) {
  Eigen::Vector3d down{0.0, 0.0, 0.0};
  Eigen::Matrix3d sideways{Eigen::Matrix3d::Zero()};
  for (const Pose& pose : T_world_cameras) {
    down += pose.linear().col(1);
    sideways += pose.linear().col(0) * pose.linear().col(0).transpose();
  }
  const auto count = static_cast<double>(T_world_cameras.size());
  if (down.norm() <= 0.25 * count) return std::nullopt;
  // However far cameras look down, their x axes stay level: up is what all of them are across, if they turned enough.
  constexpr double kTurned{0.02};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{sideways / count};
  const Eigen::Vector3d& shares = solver.eigenvalues();
  if (shares[1] < kTurned || shares[1] < 4.0 * shares[0]) return direction_of(-down);
  const Eigen::Vector3d up = solver.eigenvectors().col(0);
  return up.dot(down) > 0.0 ? Eigen::Vector3d{-up} : up;
}

}  // namespace

bool is_in_camera_frame(std::span<const Eigen::Vector3f> positions_m) {
  constexpr float kLeastCosine{0.5F};
  constexpr double kMost{0.99};
  std::size_t finite{0};
  std::size_t ahead{0};
  for (const Eigen::Vector3f& p : positions_m) {
    if (!p.allFinite()) continue;
    ++finite;
    ahead += p.z() > kLeastCosine * p.norm() ? 1 : 0;
  }
  return finite > 0 && static_cast<double>(ahead) >= kMost * static_cast<double>(finite);
}

Upright find_upright(std::span<const Eigen::Vector3f> positions_m, const UprightHints& hints) {
  const bool one_camera = hints.T_world_cameras.empty() && is_in_camera_frame(positions_m);
  Upright result;
  result.towards_viewer =
      one_camera ? std::optional{Eigen::Vector3d{-Eigen::Vector3d::UnitZ()}} : towards_cameras(hints.T_world_cameras);
  if (const auto stated = hints.up ? direction_of(*hints.up) : std::nullopt) {
    result.up = *stated;
    result.source = UprightSource::stated;
  } else if (const auto down = hints.gravity ? direction_of(*hints.gravity) : std::nullopt) {
    result.up = -*down;
    result.source = UprightSource::gravity;
  } else if (const auto rough = up_of_cameras(hints.T_world_cameras)) {
    result.up = made_exact(*rough, kCamerasMostTilt_rad, positions_m);
    result.source = UprightSource::cameras;
  } else if (one_camera || hints.is_organized) {
    result.up = made_exact(-Eigen::Vector3d::UnitY(), kCameraMostTilt_rad, positions_m);
    result.source = UprightSource::camera_frame;
    if (!one_camera) result.towards_viewer = -Eigen::Vector3d::UnitZ();
  }
  return result;
}

}  // namespace saccade
