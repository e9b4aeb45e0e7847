// SPDX-License-Identifier: Apache-2.0
#include "surfel_input.hpp"

#include <CLI/CLI.hpp>

#include "add_value.hpp"
#include "options.hpp"
#include "saccade/cloud/nearest_neighbours.hpp"
#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::cli {
namespace {

constexpr std::size_t kNearest{10};

}  // namespace

Origin complete_radii(PointCloud& cloud, std::optional<double> radius_m, const Executor& executor) {
  if (radius_m) {
    cloud.radii_m.assign(cloud.positions_m.size(), static_cast<float>(*radius_m));
    return Origin::option;
  }
  if (!cloud.radii_m.empty()) return Origin::file;
  const NearestNeighbours near = nearest_neighbours(cloud.positions_m, kNearest, executor);
  const std::vector<float> of_nodes = estimate_radii(near);
  cloud.radii_m.assign(cloud.positions_m.size(), 0.0F);
  for (std::size_t n = 0; n < of_nodes.size(); ++n) cloud.radii_m[near.order[n]] = of_nodes[n];
  return Origin::estimate;
}

Origin complete_normals(PointCloud& cloud, const Eigen::Vector3d& viewpoint_m, const Executor& executor) {
  if (!cloud.normals.empty()) return Origin::file;
  constexpr int kRounds{2};
  const NearestNeighbours near = nearest_neighbours(cloud.positions_m, kNearest, executor);
  const std::vector<Eigen::Vector3f> of_nodes = estimate_normals(near, kRounds, executor);
  cloud.normals.assign(cloud.positions_m.size(), Eigen::Vector3f::Zero());
  const Eigen::Vector3f towards_m = viewpoint_m.cast<float>();
  for (std::size_t n = 0; n < of_nodes.size(); ++n) {
    const bool is_away = of_nodes[n].dot(towards_m - near.positions_m[n]) < 0.0F;
    cloud.normals[near.order[n]] = is_away ? Eigen::Vector3f{-of_nodes[n]} : of_nodes[n];
  }
  return Origin::estimate;
}

void add_truth_options(CLI::App& command, TruthOptions& options) {
  add_value(command, "--tolerance", options.config.matching.tolerance_m, "METRES",
            "boundaries match within this distance, T_eval, metres");
  command.add_flag("!--no-split", options.config.split,
                   "true labels whose surfels do not all touch stay one (default: they are split)");
}

void check_truth_options(const TruthOptions& options) {
  require_positive(options.config.matching.tolerance_m, "--tolerance");
  if (options.radius_m) require_positive(*options.radius_m, "--radius");
}

Result<SegmentationTruth> surfel_truth(const ColumnTable& fields, std::span<const std::uint32_t> labels,
                                       const TruthOptions& options, const Executor& executor) {
  SACCADE_TRY(PointCloud cloud, cloud_from_fields(fields));
  if (options.config.split) complete_radii(cloud, options.radius_m, executor);
  return SegmentationTruth::create(cloud, labels, options.config, executor);
}

}  // namespace saccade::cli
