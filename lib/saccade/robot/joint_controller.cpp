// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/joint_controller.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

Result<JointArrival> SimulatedJoints::execute(const Trajectory& trajectory, const JointObserver& observer) {
  if (observer) {
    const auto samples = static_cast<int>(std::ceil(trajectory.duration_s() / kSample_s));
    for (int i = 0; i <= samples; ++i) {
      const double t_s = std::min(i * kSample_s, trajectory.duration_s());
      const Configuration q = trajectory.at(t_s).q;
      if (observer({t_s, q, std::nullopt}) == Advance::go_on) continue;
      q_ = q;
      return JointArrival{q_, true};
    }
  }
  q_ = trajectory.end();
  return JointArrival{q_};
}

}  // namespace saccade
