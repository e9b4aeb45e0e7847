// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores of surfels in results: of saccade score, and of the curve of saccade segment.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "saccade/segment/segmentation_truth.hpp"

namespace saccade::cli {

/// Three decimals, or a dash.
[[nodiscard]] std::string fixed_or_dash(const std::optional<double>& number);

/// {boundary_precision, boundary_recall, boundary_f, bce, boundary: {surfels, true_surfels, matched, distance_m}}.
[[nodiscard]] nlohmann::json score_json(const SegmentationScore& score);

}  // namespace saccade::cli
