// SPDX-License-Identifier: Apache-2.0
// Tables 2.5 and 2.6: saliencies and thresholds of the Gaussians of one task, an object placed, and one moved.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "json_output.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "summary.hpp"
#include "tables/hand_data.hpp"
#include "tables/thesis_table.hpp"
#include "thesis/hand_figures.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;
using thesis::GaussianSaliency;

/// A recording whose mixture stands beside the thesis', and what it was chosen from.
struct SaliencyExample {
  RecordedHand hand;
  GmmAsResult result;
  std::size_t recordings{0};
  std::size_t least_gaussians{0};
  std::size_t most_gaussians{0};
};

/// Of the recordings of such tasks, the first by name whose number of Gaussians is nearest to `gaussians`.
Result<SaliencyExample> choose_example(std::vector<RecordedHand> hands, HandTasks tasks, std::size_t gaussians,
                                       const Progress& progress) {
  std::erase_if(hands, [tasks](const RecordedHand& hand) { return hand.tasks != tasks; });
  SACCADE_EXPECTS(!hands.empty());  // read_hand_data gives some of either tasks
  SaliencyExample example;
  example.recordings = hands.size();
  example.least_gaussians = std::numeric_limits<std::size_t>::max();
  std::size_t nearest = std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "looking for an example"};
    progress.report("looking for an example", i, hands.size());
    auto result = detect_by_gmm(hands[i].labelled.trajectory);
    if (!result) return Error{result.error().code, result.error().message, hands[i].file};
    const std::size_t count = result->gaussians.size();
    example.least_gaussians = std::min(example.least_gaussians, count);
    example.most_gaussians = std::max(example.most_gaussians, count);
    const std::size_t distance = count > gaussians ? count - gaussians : gaussians - count;
    if (distance >= nearest) continue;
    nearest = distance;
    example.hand = hands[i];
    example.result = *std::move(result);
  }
  return example;
}

/// The Gaussians of the thesis or of ours, with thresholds recomputed as 1.5 times the mean of their neighbours.
template <class Gaussian>
struct SaliencySide {
  std::span<const Gaussian> gaussians;
  std::vector<std::optional<double>> recomputed;

  explicit SaliencySide(std::span<const Gaussian> given) : gaussians{given} {
    std::vector<double> saliencies;
    for (const Gaussian& gaussian : gaussians) saliencies.push_back(gaussian.saliency);
    recomputed = mean_neighbour_saliencies(saliencies, GmmAsConfig{}.neighbours);
    for (std::optional<double>& threshold : recomputed) {
      if (threshold) *threshold *= thesis::kThresholdFactor;
    }
  }
};

std::string saliency_text(const std::optional<double>& value) { return value ? fixed(*value, 6) : "–"; }

/// Adds the cells of Gaussian `g`. Returns the same for machines; null where there is none.
template <class Gaussian>
json add_cells(const SaliencySide<Gaussian>& side, std::size_t g, std::vector<std::string>& cells) {
  if (g >= side.gaussians.size()) {
    cells.insert(cells.end(), 4, "–");
    return nullptr;
  }
  const Gaussian& gaussian = side.gaussians[g];
  cells.insert(cells.end(), {saliency_text(gaussian.saliency), saliency_text(side.recomputed[g]),
                             saliency_text(gaussian.threshold), gaussian.is_poi ? "YES" : "NO"});
  return {{"saliency", gaussian.saliency},
          {"recomputed_threshold", optional_json(side.recomputed[g])},
          {"threshold", optional_json(gaussian.threshold)},
          {"poi", gaussian.is_poi}};
}

/// The largest difference between the thresholds as printed and as recomputed.
double threshold_error(const SaliencySide<GaussianSaliency>& printed) {
  double error{0.0};
  for (std::size_t g = 0; g < printed.gaussians.size(); ++g) {
    const std::optional<double>& threshold = printed.gaussians[g].threshold;
    SACCADE_EXPECTS(threshold.has_value() == printed.recomputed[g].has_value());
    if (threshold) error = std::max(error, std::abs(*threshold - *printed.recomputed[g]));
  }
  return error;
}

std::vector<double> label_distances_m(const SaliencyExample& example) {
  std::vector<double> distances_m;
  for (const HandAction& action : example.result.actions) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& label : example.hand.labelled.labels_m) {
      nearest_m = std::min(nearest_m, (action.position_m - label).norm());
    }
    if (std::isfinite(nearest_m)) distances_m.push_back(nearest_m);
  }
  return distances_m;
}

std::string example_note(const SaliencyExample& example, std::size_t gaussians, std::span<const double> distances_m) {
  std::string note =
      "Here: " + example.hand.file + ", of the " + std::to_string(example.recordings) +
      " recordings in its folder the first by name whose number of Gaussians is nearest to the thesis' " +
      std::to_string(gaussians) + " (they have " + std::to_string(example.least_gaussians) + " to " +
      std::to_string(example.most_gaussians) + "). Labels: " + std::to_string(example.hand.labelled.labels_m.size()) +
      ", points of interest: " + std::to_string(example.result.actions.size());
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    note += (i == 0 ? ", from the nearest label " : " and ") + fixed(100.0 * distances_m[i], 1) + " cm";
  }
  return note + ".";
}

struct SaliencySpec {
  std::string caption;
  HandTasks tasks;
  std::span<const GaussianSaliency> printed;
};

Result<ReproducedTable> saliency_table(const SaliencySpec& spec, const ReproduceOptions& options,
                                       const Progress& progress) {
  SACCADE_TRY(std::vector<RecordedHand> hands, read_hand_data(options.hands));
  SACCADE_TRY(const SaliencyExample example,
              choose_example(std::move(hands), spec.tasks, spec.printed.size(), progress));
  const SaliencySide<GaussianSaliency> printed{spec.printed};
  const SaliencySide<SalientGaussian> found{example.result.gaussians};

  ReproducedTable table;
  table.caption = spec.caption;
  const std::string factor = fixed(thesis::kThresholdFactor, 1) + " × mean";
  table.columns = {"Gaussian", "thesis: saliency", factor, "threshold", "POI", "here: saliency",
                   factor,     "threshold",        "POI"};
  json rows = json::array();
  for (std::size_t g = 0; g < std::max(printed.gaussians.size(), found.gaussians.size()); ++g) {
    std::vector<std::string> cells{std::to_string(g + 1)};
    json row{{"gaussian", g + 1}};
    row["thesis"] = add_cells(printed, g, cells);
    row["here"] = add_cells(found, g, cells);
    table.rows.push_back(std::move(cells));
    rows.push_back(std::move(row));
  }

  const double error = threshold_error(printed);
  const double poi_threshold = GmmAsConfig{}.poi_threshold;
  const std::vector<double> distances_m = label_distances_m(example);
  table.notes = {
      example_note(example, spec.printed.size(), distances_m),
      "The thesis does not say which recording its example is, nor the data set which tasks are placements: these are "
      "the saliencies of another task, and compare in kind only.",
      "“" + factor +
          "”: of the saliencies of up to two neighbours on either side, those that exist. From the thesis' "
          "saliencies it gives the thesis' thresholds, within " +
          fixed(1e6 * error, 1) + "e-6 (six decimals are printed), although the text says POITh = 2.5. Here POITh is " +
          fixed(poi_threshold, 1) + ", as Tables 2.2 to 2.4 need it."};
  table.figures = {{"recording", example.hand.file},
                   {"recordings", example.recordings},
                   {"gaussians", {{"least", example.least_gaussians}, {"most", example.most_gaussians}}},
                   {"poi_threshold", poi_threshold},
                   {"thesis_threshold_factor", thesis::kThresholdFactor},
                   {"thesis_threshold_error", error},
                   {"distance_to_label_m", distances_m},
                   {"rows", std::move(rows)}};
  return table;
}

}  // namespace

Result<ReproducedTable> reproduce_table_2_5(const ReproduceOptions& options, const Executor& /*executor*/,
                                            const Progress& progress) {
  return saliency_table({"Table 2.5: saliency of the Gaussians of one placement or removal",
                         HandTasks::placements_and_removals, thesis::kTable2_5},
                        options, progress);
}

Result<ReproducedTable> reproduce_table_2_6(const ReproduceOptions& options, const Executor& /*executor*/,
                                            const Progress& progress) {
  return saliency_table(
      {"Table 2.6: saliency of the Gaussians of one pick-and-place task", HandTasks::pick_and_place, thesis::kTable2_6},
      options, progress);
}

}  // namespace saccade::cli
