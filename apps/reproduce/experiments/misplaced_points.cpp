// SPDX-License-Identifier: Apache-2.0
#include "experiments/misplaced_points.hpp"

#include <algorithm>
#include <map>

#include "saccade/report/segment_picture.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

constexpr std::size_t kByControlPoints{0};  // index into kAnnotators: with our weights
constexpr std::size_t kByRectangles{3};

/// The label that most points have, and that counts as none (the thesis' background).
std::uint32_t background_of(const std::vector<std::uint32_t>& truth) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : truth) {
    if (label != 0) ++counts[label];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

/// Per point whether it is misplaced; one that has no true label never is.
std::vector<bool> find_misplaced(Misplaced what, const std::vector<std::uint32_t>& truth,
                                 const std::vector<std::uint32_t>& labels) {
  const std::uint32_t background = background_of(truth);
  const auto is_object = [background](std::uint32_t label) { return label != 0 && label != background; };
  std::vector<bool> misplaced(truth.size(), false);
  for (std::size_t i = 0; i < truth.size() && i < labels.size(); ++i) {
    if (truth[i] == 0 || truth[i] == labels[i]) continue;
    misplaced[i] = is_object(what == Misplaced::stray ? labels[i] : truth[i]);
  }
  return misplaced;
}

Panel panel_of_cloud(const AnnotationExperiment& experiment, const std::vector<bool>& misplaced,
                     const std::string& title, const Executor& executor) {
  const PointCloud& cloud = experiment.cloud.points;
  std::vector<std::uint32_t> labels;
  for (std::size_t i = 0; i < misplaced.size(); ++i) {
    labels.push_back(misplaced[i] ? 2 : experiment.cloud.truth[i] == background_of(experiment.cloud.truth) ? 0 : 1);
  }
  const std::vector<Rgb8> colors{Rgb8{196, 200, 206}, Rgb8{96, 140, 190}, Rgb8{214, 40, 40}};
  const Viewpoint view = camera_view_of(cloud.positions_m, 520, 390);
  return {
      draw_segments({cloud.positions_m, cloud.normals, labels, {}, 0.004}, view, colors, executor), title, {}, {}, {}};
}

void draw(Misplaced what, const std::string& number, const AnnotationExperiment& experiment, const Executor& executor,
          ReproducedTable& table) {
  Sheet sheet{std::string{what == Misplaced::stray ? "Stray" : "Missing"} + " points on " + experiment.name() +
                  " (thesis Fig. " + number + ")",
              {},
              "red: misplaced; blue: objects; grey: background"};
  for (const std::size_t a : {kByRectangles, kByControlPoints}) {
    sheet.panels.push_back(
        panel_of_cloud(experiment, find_misplaced(what, experiment.cloud.truth, experiment.annotations.at(a).labels),
                       kAnnotators.at(a).method, executor));
  }
  table.pictures.push_back({"fig-4-" + number.substr(2) + ".png", compose(sheet)});
}

}  // namespace

Result<ReproducedTable> misplaced_points(Misplaced what, const std::string& number, const TableOptions& options,
                                         const Executor& executor, const Progress& progress,
                                         std::optional<AnnotationExperiments>& all) {
  SACCADE_CHECK(carry_out_annotations(options, executor, progress, all));
  const char* const name = what == Misplaced::stray ? "stray" : "missing";
  ReproducedTable table;
  table.caption = "Fig. " + number + ": " + name + " points of annotation, simulated";
  table.columns = {"cloud", "points"};
  for (const Annotator& by : kAnnotators) {
    table.columns.push_back(std::string{by.method} + (by.by == cli::AnnotationMethod::control_points
                                                          ? std::string{", weights "} + by.weights
                                                          : std::string{}));
  }
  json rows = json::array();
  const AnnotationExperiment* most = nullptr;
  std::ptrdiff_t most_by_rectangles = -1;
  for (const AnnotationExperiment& experiment : all->clouds) {
    std::vector<std::string> row{experiment.name(), std::to_string(experiment.annotations[0].points)};
    json counts = json::array();
    for (std::size_t a = 0; a < kAnnotators.size(); ++a) {
      const std::vector<bool> misplaced =
          find_misplaced(what, experiment.cloud.truth, experiment.annotations.at(a).labels);
      const std::ptrdiff_t count = std::count(misplaced.begin(), misplaced.end(), true);
      row.push_back(std::to_string(count));
      counts.push_back({{"method", kAnnotators.at(a).method}, {"weights", kAnnotators.at(a).weights}, {name, count}});
      if (a != kByRectangles || count <= most_by_rectangles) continue;
      most = &experiment;
      most_by_rectangles = count;
    }
    table.rows.push_back(std::move(row));
    rows.push_back({{"cloud", experiment.name()}, {"points", experiment.annotations[0].points}, {"methods", counts}});
  }
  table.notes = {
      what == Misplaced::stray
          ? "Stray points have the label of an object that they are not on. The thesis shows some that rectangles left "
            "behind a small horse and on a box, without figures."
          : "Missing points are on an object and do not have its label. The thesis shows some that rectangles left "
            "inside a cork jug, without figures.",
      "Counted after the last action of Tables 4.5 and 4.6. " + all->about};
  table.figures = {{"rows", std::move(rows)}};
  if (options.draws && most != nullptr) draw(what, number, *most, executor, table);
  return table;
}

}  // namespace saccade::reproduce
