// SPDX-License-Identifier: Apache-2.0
#include "experiments/hand_example.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "saccade/report/attention_picture.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::GaussianSaliency;

/// Gaussians of the thesis or of Saccade, with thresholds recomputed as 1.5 times the mean of their neighbours.
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

}  // namespace

Result<SaliencyExample> choose_example(const TableOptions& options, HandTasks tasks, std::size_t gaussians,
                                       const Progress& progress) {
  SACCADE_TRY(std::vector<RecordedHand> hands, read_hand_data(options.hands));
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

Result<ReproducedTable> saliency_table(const SaliencySpec& spec, const TableOptions& options,
                                       const Progress& progress) {
  SACCADE_TRY(const SaliencyExample example, choose_example(options, spec.tasks, spec.printed.size(), progress));
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

Result<ReproducedTable> mixture_figure(const SaliencySpec& spec, const std::string& file, const TableOptions& options,
                                       const Progress& progress) {
  SACCADE_TRY(const SaliencyExample example, choose_example(options, spec.tasks, spec.printed.size(), progress));
  ReproducedTable table;
  table.caption = spec.caption;
  table.columns = {"Gaussian", "time, s", "mean, m", "standard deviations, cm", "weight", "saliency", "POI"};
  json rows = json::array();
  AttentionFindings findings;
  for (const SalientGaussian& gaussian : example.result.gaussians) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{gaussian.covariance_m2, Eigen::EigenvaluesOnly};
    const Eigen::Vector3d sigma_m = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const auto three = [](const Eigen::Vector3d& v, double scale, int decimals) {
      return fixed(scale * v.x(), decimals) + ", " + fixed(scale * v.y(), decimals) + ", " +
             fixed(scale * v.z(), decimals);
    };
    table.rows.push_back({std::to_string(table.rows.size() + 1), fixed(gaussian.time_s, 2),
                          three(gaussian.mean_m, 1.0, 3), three(sigma_m, 100.0, 1), fixed(gaussian.weight, 3),
                          saliency_text(gaussian.saliency), gaussian.is_poi ? "YES" : "NO"});
    rows.push_back({{"time_s", gaussian.time_s},
                    {"mean_m", {gaussian.mean_m.x(), gaussian.mean_m.y(), gaussian.mean_m.z()}},
                    {"standard_deviations_m", {sigma_m.x(), sigma_m.y(), sigma_m.z()}},
                    {"weight", gaussian.weight},
                    {"saliency", gaussian.saliency},
                    {"poi", gaussian.is_poi}});
    findings.gaussians.push_back({gaussian.mean_m, gaussian.covariance_m2, gaussian.is_poi});
  }
  const std::vector<double> off_m = label_distances_m(example);
  table.notes = {example_note(example, spec.printed.size(), off_m),
                 "The thesis shows pictures without figures. Ellipsoids are of two standard deviations; the thick ones "
                 "are points of interest."};
  table.figures = {{"recording", example.hand.file},
                   {"samples", example.hand.labelled.trajectory.size()},
                   {"distance_to_label_m", off_m},
                   {"rows", std::move(rows)}};
  if (!options.draws) return table;
  findings.actions = example.result.actions;
  findings.labels_m = example.hand.labelled.labels_m;
  AttentionPictureConfig config;
  config.title = spec.caption;
  table.pictures.push_back({file, attention_picture(example.hand.labelled.trajectory, findings, config)});
  return table;
}

}  // namespace saccade::reproduce
