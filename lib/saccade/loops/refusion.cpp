// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/refusion.hpp"

namespace saccade {
namespace {

Pose blended(const Pose& a, const Pose& b, double share_of_b) {
  Pose T{Pose::Identity()};
  T.linear() = Eigen::Quaterniond{a.linear()}.slerp(share_of_b, Eigen::Quaterniond{b.linear()}).toRotationMatrix();
  T.translation() = (1.0 - share_of_b) * a.translation() + share_of_b * b.translation();
  return T;
}

}  // namespace

Status fuse_along(TsdfMap& map, const PinholeCamera& camera, std::span<const TrackedFrame> frames,
                  const ReadFrame& read, const Executor& executor) {
  for (const TrackedFrame& tracked : frames) {
    SACCADE_TRY(const Frame frame, read(tracked.index));
    const ColorImage* color = frame.color ? &*frame.color : nullptr;
    SACCADE_CHECK(map.integrate(camera, frame.depth, tracked.T_world_camera, executor, color));
  }
  return {};
}

std::vector<Pose> carried_along(std::span<const Pose> T_world_camera, std::span<const std::size_t> corrected,
                                std::span<const Pose> T_world_corrected) {
  SACCADE_EXPECTS(!corrected.empty() && corrected.size() == T_world_corrected.size());
  std::vector<Pose> poses;
  const auto carried_by = [&](std::size_t k, std::size_t i) -> Pose {
    return T_world_corrected[k] * (T_world_camera[corrected[k]].inverse() * T_world_camera[i]);
  };
  std::size_t next{0};  // first corrected pose after i
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    while (next < corrected.size() && corrected[next] <= i) ++next;
    if (next == 0 || next == corrected.size()) {
      poses.push_back(carried_by(next == 0 ? 0 : next - 1, i));
      continue;
    }
    const auto before = static_cast<double>(i - corrected[next - 1]);
    const auto between = static_cast<double>(corrected[next] - corrected[next - 1]);
    poses.push_back(blended(carried_by(next - 1, i), carried_by(next, i), before / between));
  }
  return poses;
}

}  // namespace saccade
