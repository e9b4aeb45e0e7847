// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "saccade/explore/internal/timed_frame.hpp"

namespace saccade {

bool TimedFrame::hold(Frame& frame, const MotionSample& asked) {
  const bool knows_pose = frame.T_world_camera && frame.T_world_camera->matrix() != asked.T_world_camera.matrix();
  if (!frame.time_s || !asked.time_s || knows_pose) return false;
  frame_ = std::move(frame);
  before_ = asked;
  return true;
}

std::optional<MotionSample> TimedFrame::reached(const MotionSample& now) {
  if (!frame_) return std::nullopt;
  if (!now.time_s) return now;
  const double time_s = *frame_->time_s + offset_s_;
  if (*now.time_s < time_s) {
    before_ = now;
    return std::nullopt;
  }
  const double span_s = *now.time_s - *before_.time_s;
  const double share = span_s > 0.0 ? std::clamp((time_s - *before_.time_s) / span_s, 0.0, 1.0) : 1.0;
  MotionSample at = now;
  at.T_world_camera.translation() = before_.T_world_camera.translation() +
                                    share * (now.T_world_camera.translation() - before_.T_world_camera.translation());
  const Eigen::Quaterniond from{before_.T_world_camera.linear()};
  at.T_world_camera.linear() =
      from.slerp(share, Eigen::Quaterniond{now.T_world_camera.linear()}).normalized().toRotationMatrix();
  return at;
}

}  // namespace saccade
