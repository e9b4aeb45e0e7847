// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_supports: planes of a map that objects stand on. top_layers: their layers by column. hull_columns: the columns
// within a convex hull.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// Steepest slope of a support.
constexpr double kMaxSlope{0.25};
constexpr double kMinSupport_m2{0.08};  // smallest seen area of supports for ray gains and the gains of other authors

/// Finds planes that rise by kMaxSlope at most and were seen over at least `min_area_m2`, the largest first. Planes are
/// fitted to small patches of occupied voxels below empty ones, then to the zero crossings of the map's signed
/// distance. Voxels within one layer of a plane belong to it. A plane that is mostly holes, such as one through the
/// tops of three boxes, is no support. O(voxels); the thread count never changes a bit.
[[nodiscard]] std::vector<Support> find_supports(const TsdfSnapshot& map, const StateVolume& volume, double min_area_m2,
                                                 const Executor& executor);

/// Returns the first layer above a support for each column, counted from the volume's lowest; kNoLayer elsewhere.
[[nodiscard]] std::vector<std::int32_t> top_layers(const StateVolume& volume, const Support& support);
constexpr std::int32_t kNoLayer{std::numeric_limits<std::int32_t>::min()};

/// Returns the columns within the convex hull of `seen`, which are distinct columns, in order, of a grid with `width`
/// columns per row, x fastest. O(columns of the hull).
[[nodiscard]] std::vector<std::uint32_t> hull_columns(std::span<const std::uint32_t> seen, std::int32_t width);

}  // namespace saccade
