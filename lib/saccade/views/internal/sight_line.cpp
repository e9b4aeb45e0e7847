// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/sight_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/views/internal/sight_lines.hpp"

namespace saccade {
namespace {

/// Returns the share of a ray at which it finally leaves a closed box, if it passes through it.
std::optional<double> share_past(const Box& box, const SightRay& ray) {
  double enter{0.0};
  double leave{1.0};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double step_m = ray.to_m[axis] - ray.from_m[axis];
    if (step_m == 0.0) {
      if (ray.from_m[axis] < box.min[axis] || ray.from_m[axis] > box.max[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.min[axis] - ray.from_m[axis]) / step_m;
    const double b = (box.max[axis] - ray.from_m[axis]) / step_m;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? std::optional{leave} : std::nullopt;
}

/// Starts a line; nullopt where it meets nothing.
std::optional<SightLine> start(const SightClasses& classes, const Box& around_region, const SightRay& ray) {
  const std::optional<double> past_region = share_past(around_region, ray);
  if (!past_region) return std::nullopt;  // holds for most rays of a small region, such as a hand's
  return SightLine::start(classes, ray, *past_region);
}

}  // namespace

std::optional<SightLine> SightLine::start(const SightClasses& classes, const SightRay& ray, double past_region) {
  const double size_m = classes.voxel_size_m();
  const IndexBox& box = classes.box();
  const std::array<std::int32_t, 3> lo{box.lo.x, box.lo.y, box.lo.z};
  const std::array<std::int32_t, 3> hi{box.hi.x, box.hi.y, box.hi.z};
  const Eigen::Vector3d from = ray.from_m / size_m;
  const Eigen::Vector3d step = (ray.to_m - ray.from_m) / size_m;
  double enter{0.0};
  double leave{1.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (step[i] == 0.0) {
      if (from[i] < lo[axis] || from[i] >= hi[axis]) return std::nullopt;
      continue;
    }
    const double a = (lo[axis] - from[i]) / step[i];
    const double b = (hi[axis] - from[i]) / step[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return std::nullopt;
  SightLine line;
  line.share_ = enter;
  line.end_ = leave;
  line.past_region_ = past_region;
  std::ptrdiff_t place{0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double at = from[i] + enter * step[i];
    const std::int32_t cell = std::clamp(static_cast<std::int32_t>(std::floor(at)), lo[axis], hi[axis] - 1);
    const bool up = step[i] > 0.0;
    const std::ptrdiff_t stride = classes.strides()[axis];
    place += (cell - lo[axis]) * stride;
    line.between_[axis] = step[i] == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(step[i]);
    line.next_[axis] = step[i] == 0.0 ? line.between_[axis] : ((up ? cell + 1 : cell) - from[i]) / step[i];
    line.move_[axis] = up ? stride : -stride;
    line.left_[axis] = up ? hi[axis] - 1 - cell : cell - lo[axis];
  }
  line.place_ = static_cast<std::size_t>(place);
  return line;
}

bool SightLine::look(SightClass seen) {
  if (seen == SightClass::surface) {
    if (met_) met_->returns = true;
    return true;
  }
  if (met_) return false;
  if (seen == SightClass::blocks || share_ > past_region_) return true;
  if (seen == SightClass::promise) met_ = MetVoxel{place_, share_};
  return false;
}

bool SightLine::advance() {
  const std::size_t axis =
      next_[0] <= next_[1] ? (next_[0] <= next_[2] ? std::size_t{0} : 2) : (next_[1] <= next_[2] ? std::size_t{1} : 2);
  if (next_[axis] >= end_ || left_[axis]-- == 0) return false;
  share_ = next_[axis];
  next_[axis] += between_[axis];
  place_ = static_cast<std::size_t>(static_cast<std::int64_t>(place_) + move_[axis]);
  return true;
}

std::optional<MetVoxel> SightLine::walk(const SightClasses& classes) {
  while (!look(classes.at(place_)) && advance()) {
  }
  return met_;
}

std::optional<MetVoxel> met_voxel(const SightClasses& classes, const Box& around_region, const SightRay& ray) {
  std::optional<SightLine> line = start(classes, around_region, ray);
  return line ? line->walk(classes) : std::nullopt;
}

std::vector<std::optional<MetVoxel>> met_voxels(const SightClasses& classes, const Box& around_region,
                                                std::span<const SightRay> rays) {
  constexpr std::size_t kWorthwhile{4};  // lanes from which on several lines at a time are faster
  std::vector<std::optional<MetVoxel>> met(rays.size());
  const std::size_t lanes = SightLines::lanes();
  if (lanes < kWorthwhile) {
    for (std::size_t i = 0; i < rays.size(); ++i) met[i] = met_voxel(classes, around_region, rays[i]);
    return met;
  }
  SightLines lines;
  std::array<std::size_t, SightLines::kMost> ray_in{};
  std::size_t next{0};
  const auto begin_in = [&](std::size_t lane) {
    while (next < rays.size()) {
      ray_in[lane] = next++;
      if (const std::optional<SightLine> line = start(classes, around_region, rays[ray_in[lane]])) {
        lines.put(lane, *line);
        return;
      }
    }
  };
  for (std::size_t lane = 0; lane < lanes; ++lane) begin_in(lane);
  while (lines.walking != 0) {
    const std::uint32_t walked = lines.walking;
    lines.walk(classes, next < rays.size() ? lanes / 2 : 0);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (((walked & ~lines.walking) >> lane & 1U) == 0) continue;
      met[ray_in[lane]] = lines.result(lane);
      begin_in(lane);
    }
  }
  return met;
}

}  // namespace saccade
