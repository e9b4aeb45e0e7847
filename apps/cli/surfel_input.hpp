// SPDX-License-Identifier: Apache-2.0
#pragma once
// Radii and normals, which surfels need and a file of points may lack.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "saccade/core/executor.hpp"
#include "saccade/core/names.hpp"
#include "saccade/io/files/column_table.hpp"
#include "saccade/segment/segmentation_truth.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

/// Where a cloud's radii or normals come from, for the result.
enum class Origin { file, option, estimate };
inline constexpr auto kOriginNames =
    make_names<Origin>({{Origin::file, "given"}, {Origin::option, "option"}, {Origin::estimate, "estimated"}});
[[nodiscard]] constexpr std::string_view to_string(Origin origin) { return kOriginNames.of(origin); }

/// The radius that was asked for, or those of the file, or estimates.
Origin complete_radii(PointCloud& cloud, std::optional<double> radius_m, const Executor& executor);
/// Those of the file, or estimates, which turn towards the viewpoint.
Origin complete_normals(PointCloud& cloud, const Eigen::Vector3d& viewpoint_m, const Executor& executor);

/// How a labelled cloud is taken as a truth of surfels.
struct TruthOptions {
  SegmentationTruthConfig config;
  std::optional<double> radius_m;  ///< one radius for all surfels
};

/// Adds --tolerance and --no-split; --radius is the command's own.
void add_truth_options(CLI::App& command, TruthOptions& options);
void check_truth_options(const TruthOptions& options);
/// The fields have places; a cloud without radii has estimates.
[[nodiscard]] Result<SegmentationTruth> surfel_truth(const ColumnTable& fields, std::span<const std::uint32_t> labels,
                                                     const TruthOptions& options, const Executor& executor);

}  // namespace saccade::cli
