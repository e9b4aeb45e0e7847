// SPDX-License-Identifier: Apache-2.0
#include "score_json.hpp"

#include "json_output.hpp"
#include "summary.hpp"

namespace saccade::cli {

using nlohmann::json;

std::string fixed_or_dash(const std::optional<double>& number) { return number ? fixed(*number, 3) : "    -"; }

json score_json(const SegmentationScore& score) {
  return {{"boundary_precision", optional_json(score.precision())},
          {"boundary_recall", optional_json(score.recall())},
          {"boundary_f", optional_json(score.f())},
          {"bce", score.bce},
          {"boundary",
           {{"surfels", score.boundary},
            {"true_surfels", score.true_boundary},
            {"matched", score.matched},
            {"distance_m", score.matched > 0 ? json(score.distance_m) : json(nullptr)}}}};
}

}  // namespace saccade::cli
