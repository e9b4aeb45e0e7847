// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_sphere.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr double kSlack{1e-9};  // a step that divides the range to within rounding counts as dividing it
constexpr double kMostPoses{1e7};

double samples_around(double step_rad) { return std::max(1.0, std::ceil(360_deg / step_rad - kSlack)); }
double samples_between(double min_rad, double max_rad, double step_rad) {
  return std::floor((max_rad - min_rad) / step_rad + kSlack) + 1.0;
}
bool is_positive(double x) { return std::isfinite(x) && x > 0.0; }

Pose pose_on_sphere(const Eigen::Vector3d& center, double radius_m, double longitude_rad, double latitude_rad,
                    double roll_rad) {
  const double cos_longitude = std::cos(longitude_rad);
  const double sin_longitude = std::sin(longitude_rad);
  const Eigen::Vector3d outward{std::cos(latitude_rad) * cos_longitude, std::cos(latitude_rad) * sin_longitude,
                                std::sin(latitude_rad)};
  Pose T_world_camera{Pose::Identity()};
  const Eigen::Vector3d x{-sin_longitude, cos_longitude, 0.0};
  T_world_camera.linear().col(0) = x;
  T_world_camera.linear().col(1) = (-outward).cross(x);
  T_world_camera.linear().col(2) = -outward;
  T_world_camera.translation() = center + radius_m * outward;
  if (roll_rad != 0.0) T_world_camera.rotate(Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitZ()});
  return T_world_camera;
}

}  // namespace

Status ViewSphereConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "view sphere"}; };
  if (radii_m.empty()) return fail("at least one radius is needed");
  if (!std::all_of(radii_m.begin(), radii_m.end(), is_positive)) return fail("radii must be positive");
  if (!is_positive(longitude_step_rad) || !is_positive(latitude_step_rad) || !is_positive(roll_step_rad)) {
    return fail("the steps of longitude, latitude and roll must be positive");
  }
  if (!(latitude_min_rad >= -90_deg - kSlack && latitude_max_rad <= 90_deg + kSlack &&
        latitude_min_rad <= latitude_max_rad)) {
    return fail("latitudes must satisfy -90 deg <= min <= max <= 90 deg");
  }
  const double poses = static_cast<double>(radii_m.size()) * samples_around(longitude_step_rad) *
                       samples_between(latitude_min_rad, latitude_max_rad, latitude_step_rad) *
                       samples_around(roll_step_rad);
  if (poses > kMostPoses) return fail("the steps give more than ten million poses; make them larger");
  return {};
}

Result<std::vector<ViewCandidate>> view_sphere(const Eigen::Vector3d& center, const ViewSphereConfig& config) {
  SACCADE_CHECK(config.validate());
  if (!center.allFinite()) return Error{Errc::invalid_argument, "the centre contains NaN or infinity", "view sphere"};
  const auto latitudes =
      static_cast<int>(samples_between(config.latitude_min_rad, config.latitude_max_rad, config.latitude_step_rad));
  const auto longitudes = static_cast<int>(samples_around(config.longitude_step_rad));
  const auto rolls = static_cast<int>(samples_around(config.roll_step_rad));
  std::vector<ViewCandidate> candidates;
  candidates.reserve(config.radii_m.size() * static_cast<std::size_t>(latitudes) *
                     static_cast<std::size_t>(longitudes) * static_cast<std::size_t>(rolls));
  for (const double radius_m : config.radii_m) {
    for (int i = 0; i < latitudes; ++i) {
      const double latitude_rad = std::min(config.latitude_min_rad + i * config.latitude_step_rad, 90_deg);
      for (int j = 0; j < longitudes; ++j) {
        const double longitude_rad = j * config.longitude_step_rad;
        for (int k = 0; k < rolls; ++k) {
          const double roll_rad = k * config.roll_step_rad;
          candidates.push_back({pose_on_sphere(center, radius_m, longitude_rad, latitude_rad, roll_rad), radius_m,
                                longitude_rad, latitude_rad, roll_rad});
        }
      }
    }
  }
  return candidates;
}

std::vector<Pose> poses_of(const std::vector<ViewCandidate>& candidates) {
  std::vector<Pose> poses;
  poses.reserve(candidates.size());
  for (const ViewCandidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
  return poses;
}

}  // namespace saccade
