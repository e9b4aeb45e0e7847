// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "saccade/arm/kinematics.hpp"

namespace saccade {
namespace {

constexpr double kBelieved_m{0.005};

}  // namespace

bool touches(const ArmCollision& collision, const Solids& solids, const Configuration& q) {
  const ArmPoses poses = forward_kinematics(collision.arm(), q);
  return !collision.clear(poses, [&](const Eigen::Vector3d& center, double cover_radius_m, bool finest) {
    const double radius_m = cover_radius_m - (finest ? kBelieved_m : 0.0);
    return radius_m <= 0.0 || (solids.distance_m(center, 2.0 * radius_m) >= radius_m && !solids.contain(center));
  });
}

std::size_t count_contacts(const ArmCollision& collision, const Solids& solids, std::span<const Trajectory> motions,
                           const Executor& executor, double step_s) {
  SACCADE_EXPECTS(step_s > 0.0);
  std::vector<Configuration> instants;
  for (const Trajectory& motion : motions) {
    if (motion.empty()) continue;
    for (double t_s = 0.0; t_s < motion.duration_s(); t_s += step_s) instants.push_back(motion.at(t_s).q);
    instants.push_back(motion.end());
  }
  std::vector<std::uint8_t> touched(instants.size());
  executor.parallel_for(instants.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) touched[i] = touches(collision, solids, instants[i]) ? 1 : 0;
  });
  return std::accumulate(touched.begin(), touched.end(), std::size_t{0});
}

}  // namespace saccade
