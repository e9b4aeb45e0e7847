// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/surfel_measures.hpp"

#include <array>
#include <numbers>

namespace saccade {

TriangleMesh surfel_mesh(const SurfelMap& surfels, double min_weight, const Box& box) {
  constexpr std::array<std::array<float, 2>, 6> kCorners{{{1.0F, 0.0F},
                                                          {0.5F, 0.5F * std::numbers::sqrt3_v<float>},
                                                          {-0.5F, 0.5F * std::numbers::sqrt3_v<float>},
                                                          {-1.0F, 0.0F},
                                                          {-0.5F, -0.5F * std::numbers::sqrt3_v<float>},
                                                          {0.5F, -0.5F * std::numbers::sqrt3_v<float>}}};
  TriangleMesh mesh;
  for (const SurfelDisc& disc : surfels.discs) {
    if (!(static_cast<double>(disc.weight) >= min_weight) || !contains(box, disc.position_m.cast<double>())) continue;
    const Eigen::Vector3f x = disc.normal.unitOrthogonal();
    const Eigen::Vector3f y = disc.normal.cross(x);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [a, b] : kCorners) mesh.vertices.emplace_back(disc.position_m + disc.radius_m * (a * x + b * y));
    for (std::uint32_t i = 1; i + 1 < 6; ++i) mesh.triangles.push_back({first, first + i, first + i + 1});
  }
  return mesh;
}

Measures measure_surfels(const GroundTruth& truth, const TsdfSnapshot& free_space, const SurfelMap& surfels,
                         double min_weight, double within_m, const Executor& executor) {
  const Box& workspace = truth.scene().scene().workspace;
  const Metrics metrics = measure_mesh(truth, surfel_mesh(surfels, min_weight, workspace), within_m, executor);
  return {metrics.coverage, count_unknown(free_space, workspace), std::nullopt, metrics.accuracy_m, metrics.chamfer_m,
          metrics.f_score};
}

}  // namespace saccade
