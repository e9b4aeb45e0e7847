// SPDX-License-Identifier: Apache-2.0
#pragma once
// Options of saliency: which heuristic, or a blend of several, and what they need to know.

#include <optional>
#include <string>

#include "saccade/attention/saliency.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct SaliencyOptions {
  std::string names{"objectness"};  ///< "name" or "name=weight,name=weight…"
  bool given{false};                ///< `names` was
  SizePriorConfig size;
  HeightConfig height;
  std::optional<Eigen::Vector3d> up;  ///< default: +z; −y for the cloud of a single camera
  std::optional<Region> region;
  SaliencyHeuristic heuristic;  ///< set by check_saliency_options
};

void add_saliency_options(CLI::App& command, SaliencyOptions& options);
/// All that decides the heuristic, after it was checked: equal for equal heuristics.
[[nodiscard]] std::string saliency_text(const SaliencyOptions& options);
/// Throws usage errors, and makes the heuristic.
void check_saliency_options(SaliencyOptions& options, bool single_camera);

}  // namespace saccade::cli
