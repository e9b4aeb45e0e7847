// SPDX-License-Identifier: Apache-2.0
#include "surfel_input.hpp"

#include <CLI/CLI.hpp>

#include "add_value.hpp"
#include "length_options.hpp"
#include "options.hpp"
#include "saccade/cloud/surfel_estimates.hpp"
#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::cli {

Origin complete_radii(PointCloud& cloud, std::optional<double> radius_m, const Executor& executor) {
  if (radius_m) {
    cloud.radii_m.assign(cloud.positions_m.size(), static_cast<float>(*radius_m));
    return Origin::option;
  }
  if (!cloud.radii_m.empty()) return Origin::file;
  cloud.radii_m = surfel_radii(cloud.positions_m, executor);
  return Origin::estimate;
}

Origin complete_normals(PointCloud& cloud, const Eigen::Vector3d& viewpoint_m, const Executor& executor) {
  if (!cloud.normals.empty()) return Origin::file;
  cloud.normals = surfel_normals(cloud.positions_m, viewpoint_m, executor);
  return Origin::estimate;
}

void add_truth_options(CLI::App& command, TruthOptions& options) {
  add_value(command, "--tolerance", options.config.matching.tolerance_m, "METRES",
            "boundaries match within this distance, T_eval, metres");
  command.add_flag("!--no-split", options.config.split,
                   "true labels whose surfels do not all touch stay one (default: they are split)");
}

void check_truth_options(const TruthOptions& options) {
  require_length(options.config.matching.tolerance_m, "--tolerance");
  if (options.radius_m) require_length(*options.radius_m, "--radius");
}

Result<SegmentationTruth> surfel_truth(const ColumnTable& fields, std::span<const std::uint32_t> labels,
                                       const TruthOptions& options, const Executor& executor) {
  SACCADE_TRY(PointCloud cloud, cloud_from_fields(fields));
  if (options.config.split) complete_radii(cloud, options.radius_m, executor);
  return SegmentationTruth::create(cloud, labels, options.config, executor);
}

}  // namespace saccade::cli
