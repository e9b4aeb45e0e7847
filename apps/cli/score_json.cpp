// SPDX-License-Identifier: Apache-2.0
#include "score_json.hpp"

#include "summary.hpp"

namespace saccade::cli {

using nlohmann::json;

json number_or_null(const std::optional<double>& number) { return number ? json(*number) : json(nullptr); }

std::string fixed_or_dash(const std::optional<double>& number) { return number ? fixed(*number, 3) : "    -"; }

json score_json(const SegmentationScore& score) {
  return {{"boundary_precision", number_or_null(score.precision())},
          {"boundary_recall", number_or_null(score.recall())},
          {"boundary_f", number_or_null(score.f())},
          {"bce", score.bce},
          {"boundary",
           {{"surfels", score.boundary},
            {"true_surfels", score.true_boundary},
            {"matched", score.matched},
            {"distance_m", score.matched > 0 ? json(score.distance_m) : json(nullptr)}}}};
}

}  // namespace saccade::cli
