// SPDX-License-Identifier: Apache-2.0
#include "basic_views.hpp"

#include <cmath>
#include <numbers>
#include <unordered_set>

#include "plain_types.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/ray_walk.hpp"

namespace saccade::ros1 {
namespace {

constexpr double kMostVoxels{1e9};
constexpr std::size_t kPosesPerReport{64};

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

std::vector<double> angles(const AngleSteps& steps) {
  std::vector<double> all;
  for (int i = 0; steps.step > 0.0 && i < 3600; ++i) {
    const double angle = steps.first + i * steps.step;
    if (angle > steps.last + 1e-9) break;
    all.push_back(radians(angle));
  }
  return all;
}

/// Voxels within the bounds of the listed ones; all others are empty.
class States {
 public:
  static Result<States> make(const Occupancy& occupancy, double voxel_m) {
    States states;
    for (const auto& [x, y, z, state] : occupancy) {
      if (!std::isfinite(x + y + z + state)) continue;
      if (std::max({std::abs(x), std::abs(y), std::abs(z)}) > 1000.0F)
        return Error{Errc::invalid_argument, "a voxel lies farther than 1000 m from the origin", {}};
      states.box_ = states.box_.hull(IndexBox::cube(voxel_at({x, y, z}, voxel_m), 1));
    }
    if (states.box_.empty()) return states;
    if (states.box_.count() > kMostVoxels)
      return Error{Errc::invalid_argument, "the occupancy spans more than a thousand million voxels", {}};
    states.states_.assign(static_cast<std::size_t>(states.box_.count()), VoxelState::empty);
    for (const auto& [x, y, z, state] : occupancy) {
      if (!std::isfinite(x + y + z + state)) continue;
      states.states_[states.at(voxel_at({x, y, z}, voxel_m))] = state > 0.0F   ? VoxelState::occupied
                                                                : state < 0.0F ? VoxelState::empty
                                                                               : VoxelState::unknown;
    }
    return states;
  }
  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] std::size_t at(const Index3& voxel) const {
    const Index3 i = voxel - box_.lo;
    const Index3 size = box_.size();
    return (static_cast<std::size_t>(i.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(i.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i.x);
  }
  [[nodiscard]] VoxelState operator[](std::size_t i) const { return states_[i]; }

 private:
  IndexBox box_;
  std::vector<VoxelState> states_;
};

std::pair<std::uint32_t, std::uint32_t> count_view(const States& states, const Pose& T_world_camera,
                                                   const BasicFilter& filter, const BasicConfig& config) {
  std::unordered_set<std::size_t> unknown, occupied;
  const Eigen::Vector3d from = T_world_camera.translation() / config.voxel_size;
  const LatticePoint origin = lattice_point(from.x(), from.y(), from.z());
  const double wide = std::tan(radians(config.half_width_deg));
  const double high = std::tan(radians(config.half_height_deg));
  for (std::uint32_t v = 0; v < config.rows; ++v) {
    for (std::uint32_t u = 0; u < config.columns; ++u) {
      const Eigen::Vector3d ray_camera{wide * ((2.0 * u + 1.0) / config.columns - 1.0),
                                       high * ((2.0 * v + 1.0) / config.rows - 1.0), 1.0};
      const Eigen::Vector3f d = (T_world_camera.linear() * ray_camera.normalized() / config.voxel_size).cast<float>();
      const LatticeRay ray = make_lattice_ray(origin, d.x(), d.y(), d.z());
      const RaySpan span = clip(ray, states.box()).until(after_depth(static_cast<float>(config.max_range)));
      walk_cells<kVoxelLevel>(ray, span, [&](const Index3& voxel, const RaySpan&) {
        const std::size_t i = states.at(voxel);
        if (states[i] == VoxelState::empty) return false;
        const Eigen::Vector3d center = voxel_center(voxel, config.voxel_size);
        const bool counts = (!filter.box || contains(to_box(*filter.box), center)) &&
                            (!filter.sphere || contains(to_sphere(*filter.sphere), center));
        if (counts) (states[i] == VoxelState::unknown ? unknown : occupied).insert(i);
        return true;
      });
    }
  }
  return {static_cast<std::uint32_t>(unknown.size()), static_cast<std::uint32_t>(occupied.size())};
}

}  // namespace

std::vector<PlainPose> poses_around(const std::array<double, 3>& point, const BasicConfig& config) {
  const Eigen::Vector3d target = to_vector(point);
  std::vector<PlainPose> poses;
  for (const double latitude : angles(config.latitude)) {
    for (const double longitude : angles(config.longitude)) {
      const Eigen::Vector3d out{std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                                std::cos(latitude)};
      for (const double roll : angles(config.roll)) {
        poses.push_back(to_plain(look_at(target + config.radius * out, target, Eigen::Vector3d::UnitZ(), roll)));
      }
    }
  }
  return poses;
}

std::string count_voxels(const Occupancy& occupancy, const std::vector<PlainPose>& poses, const BasicFilter& filter,
                         const BasicConfig& config, const std::atomic<bool>& cancelled,
                         const std::function<void(std::size_t done)>& progress, BasicCounts& counts) {
  const Result<States> states = States::make(occupancy, config.voxel_size);
  if (!states) return states.error().to_string();
  std::vector<Pose> checked;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Result<Pose> pose = to_pose(poses[i]);
    if (!pose) return "pose " + std::to_string(i) + ": " + pose.error().message;
    checked.push_back(*pose);
  }
  counts.unknown.assign(poses.size(), 0);
  counts.occupied.assign(poses.size(), 0);
  if (states->box().empty()) return {};
  const Executor executor = Executor::with_threads(0);
  for (std::size_t begin = 0; begin < poses.size(); begin += kPosesPerReport) {
    if (cancelled) return "cancelled";
    executor.parallel_for(std::min(kPosesPerReport, poses.size() - begin), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = begin + first; i < begin + last; ++i)
        std::tie(counts.unknown[i], counts.occupied[i]) = count_view(*states, checked[i], filter, config);
    });
    progress(std::min(begin + kPosesPerReport, poses.size()));
  }
  return {};
}

}  // namespace saccade::ros1
