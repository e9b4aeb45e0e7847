// SPDX-License-Identifier: Apache-2.0
// Tables 3.1 to 3.3 and Fig. 3.17: object-driven attention and the standard method, five views in four scenes with the
// arm (thesis §3.2.2).
#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "saccade/arm/urdf.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/report/plot.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "summary.hpp"
#include "tables/thesis_table.hpp"

namespace saccade::cli {

/// Runs of each strategy, one per scene.
struct ExplorationExperiments {
  std::vector<RunRecord> attention;
  std::vector<RunRecord> standard;
  std::vector<RunRecord> surface;  ///< ours
};

namespace {

using nlohmann::json;
using Experiments = ExplorationExperiments;

constexpr std::array<const char*, 4> kScenes{"tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4"};
constexpr int kViews{5};
constexpr double kMost_m{2.0};  // beyond, depth is too coarse for things on a table
constexpr int kUsualWidth_px{160};

/// As the thesis': a Kinect v2 on the Comau arm, all of whose rays count.
Result<SimulatedRunConfig> config_of(const NamedPlanner& strategy, const ReproduceOptions& options) {
  SimulatedRunConfig config = SimulatedRunConfig{}.with(strategy);
  SACCADE_TRY(config.camera, camera_preset("kinect-v2"));
  config.camera.max_range_m = kMost_m;
  if (options.image_width_px > 0) {
    config.camera = config.camera.scaled_to_width(std::min(options.image_width_px, config.camera.width));
  }
  config.sensor = DepthSensor::kinect_v2;
  config.gain_width_px = config.camera.width;
  const double scale = static_cast<double>(config.gain_width_px) / kUsualWidth_px;
  config.planner.min_gain *= scale * scale;
  config.exploration.max_views = kViews;
  config.seed = options.seed;
  config.as_printed = strategy.name != surface_planner().name;
  SACCADE_TRY(UrdfArm arm, find_robot("comau"));
  config.arm = std::make_shared<const ArmModel>(std::move(arm.arm));
  return config;
}

Result<RunRecord> carry_out(const char* scene, const char* strategy, const ReproduceOptions& options,
                            const Executor& executor, const Progress& progress) {
  SACCADE_TRY(Scene found, find_scene(scene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(found)));
  SACCADE_TRY(const Truth truth, Truth::build(rays, kTruthSpacing_m, executor));
  SACCADE_TRY(const NamedPlanner planner, builtin_planners().find(strategy));
  SACCADE_TRY(const SimulatedRunConfig config, config_of(planner, options));
  SACCADE_TRY(RunRecord run, run_simulated(truth, config, executor, progress));
  if (run.stopped_because == StopReason::cancelled) return Error{Errc::cancelled, "cancelled", scene};
  return run;
}

Status carry_out_explorations(const ReproduceOptions& options, const Executor& executor, const Progress& progress) {
  if (options.experiments) return {};
  auto all = std::make_shared<Experiments>();
  std::size_t done = 0;
  for (const char* scene : kScenes) {
    for (const auto& [strategy, runs] : {std::pair{"attention", &all->attention}, std::pair{"standard", &all->standard},
                                         std::pair{"surface", &all->surface}}) {
      progress.report("experiments", done++, 3 * kScenes.size());
      SACCADE_TRY(RunRecord run, carry_out(scene, strategy, options, executor, {}));
      runs->push_back(std::move(run));
      if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", scene};
    }
  }
  options.experiments = std::move(all);
  return {};
}

void add_exploration_notes(const ReproduceOptions& options, ReproducedTable& table) {
  table.notes.emplace_back(
      "Here the four tabletop scenes, the arm and the Kinect v2 with its filter are simulated; the thesis' were real, "
      "with other objects. Figures compare in kind.");
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

/// A row of Table 3.1: seconds of five views, mean and standard deviation over the experiments.
struct TimedPhase {
  const char* name;
  const char* thesis_attention;
  const char* thesis_standard;
  double (*seconds)(const ViewRecord&);
};

double seconds_of(const ViewRecord& view, std::initializer_list<saccade::Phase> phases) {
  double ms = 0.0;
  for (const saccade::Phase phase : phases) ms += view.times.ms(phase);
  return 1e-3 * ms;
}

double next_best_view_s(const ViewRecord& view) {
  return seconds_of(view, {saccade::Phase::segmentation, saccade::Phase::saliency, saccade::Phase::candidates,
                           saccade::Phase::reachability, saccade::Phase::gain});
}

const std::array<TimedPhase, 8> kTimedPhases{
    {{"segmentation + saliency", "46.1 ± 2.5", "-",
      [](const ViewRecord& view) {
        return seconds_of(view, {saccade::Phase::segmentation, saccade::Phase::saliency});
      }},
     {"views generation", "2.1 ± 0.1", "2.1 ± 0.1",
      [](const ViewRecord& view) {
        return seconds_of(view, {saccade::Phase::candidates, saccade::Phase::reachability});
      }},
     {"views evaluation", "26.0 ± 4.1", "288.5 ± 39.0",
      [](const ViewRecord& view) { return seconds_of(view, {saccade::Phase::gain}); }},
     {"subtotal", "74.2 ± 4.8", "290.6 ± 39.0", next_best_view_s},
     {"planner map update", "46.0 ± 1.6", "44.6 ± 0.4",
      [](const ViewRecord& view) { return seconds_of(view, {saccade::Phase::obstacles}); }},
     {"motion planning", "88.1 ± 17.9", "78.3 ± 13.8",
      [](const ViewRecord& view) { return seconds_of(view, {saccade::Phase::planning}); }},
     {"robot motion", "110.5 ± 3.9", "108.5 ± 7.7", [](const ViewRecord& view) { return view.motion_s; }},
     {"total", "318.7 ± 19.1", "522.0 ± 42.0", [](const ViewRecord& view) {
        return view.motion_s + next_best_view_s(view) +
               seconds_of(view, {saccade::Phase::obstacles, saccade::Phase::planning});
      }}}};

MeanEstimate seconds_of(const std::vector<RunRecord>& experiments, const TimedPhase& phase) {
  std::vector<double> sums;
  for (const RunRecord& experiment : experiments) {
    double sum = 0.0;
    for (const ViewRecord& view : experiment.views) sum += phase.seconds(view);
    sums.push_back(sum);
  }
  return estimate_mean(sums);
}

std::string seconds_text(const MeanEstimate& seconds) {
  return fixed(seconds.mean, 2) + " ± " + fixed(seconds.standard_deviation.value_or(0.0), 2);
}

/// "400 to 14000".
template <class Of>
std::string range_text(const std::vector<RunRecord>& experiments, Of of) {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::size_t most = 0;
  for (const RunRecord& experiment : experiments) {
    for (const ViewRecord& view : experiment.views) {
      least = std::min(least, of(view));
      most = std::max(most, of(view));
    }
  }
  return most < least ? std::string{"none"} : std::to_string(least) + " to " + std::to_string(most);
}

std::string name_of_object(const Truth& truth, const RayScene& rays, std::span<const Eigen::Vector3f> points,
                           const std::vector<MeshDistance>& distances) {
  constexpr double kBeyond_m{0.1};
  constexpr std::size_t kSamples{200};
  std::map<std::string, std::size_t> votes;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kSamples)) {
    const Eigen::Vector3d p = points[i].cast<double>();
    std::size_t nearest = 0;
    for (std::size_t object = 1; object < distances.size(); ++object) {
      if (distances[object].distance_m(p, kBeyond_m) < distances[nearest].distance_m(p, kBeyond_m)) nearest = object;
    }
    const bool of_object = truth.to_objects_m(p, kBeyond_m) < truth.to_supports_m(p, kBeyond_m);
    const ObjectMesh& mesh = rays.meshes()[nearest];
    ++votes[of_object && !mesh.support ? mesh.name : "part of the table"];
  }
  return std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::string mark(const std::vector<ViewRecord>& views, std::size_t k, std::optional<bool> ViewRecord::*points) {
  if (k >= views.size()) return "-";
  return (views[k].*points).value_or(false) ? "✓" : "×";
}

json experiments_json(const Experiments& all) {
  json rows = json::array();
  for (const auto& [name, experiments] : {std::pair{"attention", &all.attention}, std::pair{"standard", &all.standard},
                                          std::pair{"surface", &all.surface}}) {
    for (std::size_t i = 0; i < experiments->size(); ++i) {
      json views = json::array();
      for (const ViewRecord& view : (*experiments)[i].views) {
        views.push_back({{"candidates", view.candidates},
                         {"evaluated", view.evaluated},
                         {"gain", view.gain_predicted},
                         {"coverage", *view.measures.coverage},
                         {"unknown_near_objects", *view.measures.unknown_near_objects},
                         {"points_at_object", *view.reveals_object},
                         {"looks_at_object", *view.looks_at_object},
                         {"nbv_ms", 1e3 * next_best_view_s(view)},
                         {"motion_s", view.motion_s}});
      }
      rows.push_back({{"scene", kScenes.at(i)},
                      {"strategy", name},
                      {"unknown_near_objects", (*experiments)[i].scan.measures.unknown_near_objects.value_or(0)},
                      {"views", std::move(views)}});
    }
  }
  return {{"experiments", std::move(rows)}};
}

}  // namespace

Result<ReproducedTable> reproduce_table_3_1(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  SACCADE_CHECK(carry_out_explorations(options, executor, progress));
  const Experiments& all = *options.experiments;
  ReproducedTable table;
  table.caption = "Table 3.1: seconds of each phase of five views, mean and standard deviation of four experiments";
  table.columns = {"phase", "proposed, thesis", "attention", "standard, thesis", "standard"};
  json rows = json::array();
  for (const TimedPhase& phase : kTimedPhases) {
    const MeanEstimate attention = seconds_of(all.attention, phase);
    const MeanEstimate standard = seconds_of(all.standard, phase);
    table.rows.push_back(
        {phase.name, phase.thesis_attention, seconds_text(attention), phase.thesis_standard, seconds_text(standard)});
    rows.push_back({{"phase", phase.name}, {"attention_s", attention.mean}, {"standard_s", standard.mean}});
  }
  const auto candidates = [](const ViewRecord& view) { return view.candidates; };
  const auto evaluated = [](const ViewRecord& view) { return view.evaluated; };
  const double ratio = seconds_of(all.standard, kTimedPhases[3]).mean / seconds_of(all.attention, kTimedPhases[3]).mean;
  table.notes = {
      "Subtotal: the computation of the views. Standard over attention: thesis 3.9, here " + fixed(ratio, 1) + ".",
      "The thesis names \"thousands\" of candidates of the standard method, and 91,960 in one view. Here a view has " +
          range_text(all.standard, candidates) + " candidates (40 per contour point), of which the arm can take " +
          range_text(all.standard, evaluated) + ", and these alone are evaluated; attention evaluates " +
          range_text(all.attention, evaluated) + " (the thesis: \"rarely more than two hundred\").",
      "Views generation: with the question which of them the arm can take, which the thesis asked afterwards. Robot "
      "motion: of the simulated arm, oscillation included. Fusion is in neither total."};
  add_exploration_notes(options, table);
  table.figures = experiments_json(all);
  table.figures["rows"] = std::move(rows);
  return table;
}

Result<ReproducedTable> reproduce_table_3_2(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  constexpr std::size_t kThird{2};
  progress.report("experiment 1", 0, 1);
  SACCADE_TRY(Scene scene, find_scene(kScenes[0]));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(const Truth truth, Truth::build(rays, kTruthSpacing_m, executor));
  SACCADE_TRY(const RunRecord experiment, carry_out(kScenes[0], "attention", options, executor, progress));
  if (experiment.views.size() <= kThird || !experiment.views[kThird].choice->surface) {
    return Error{Errc::unavailable, "the exploration ended before its third view", kScenes[0]};
  }
  std::vector<MeshDistance> distances;
  for (const ObjectMesh& object : rays.meshes()) {
    SACCADE_TRY(MeshDistance distance, MeshDistance::build(object.mesh));
    distances.push_back(std::move(distance));
  }
  const ViewRecord& third = experiment.views[kThird];
  const ViewChoice& choice = *third.choice;
  const SalientSurface& seen = *choice.surface;
  const std::size_t per_point = ContourViewConfig{}.views_per_point();
  const auto contours_of = choice.contours->points_of_segments(seen.points.segments());
  ReproducedTable table;
  table.caption =
      "Table 3.2: saliency and view poses of the segments before the third view of experiment 1, up to the first one "
      "that is no object's";
  table.columns = {"saliency", "no. of poses", "description"};
  json rows = json::array();
  std::size_t of_objects = 0;
  for (const std::uint32_t segment : seen.order) {
    if (contours_of[segment].empty()) continue;
    const std::string name = name_of_object(truth, rays, seen.points.points_of(segment), distances);
    const std::size_t poses = per_point * contours_of[segment].size();
    const double saliency = seen.saliency[segment].value;
    table.rows.push_back({fixed(saliency, 3), std::to_string(poses), name});
    rows.push_back({{"saliency", saliency}, {"poses", poses}, {"object", name}});
    if (name == "part of the table") break;
    of_objects += poses;
  }
  const std::size_t chosen = choice.segment ? per_point * contours_of[*choice.segment].size() : 0;
  table.notes = {
      "Thesis: 0.589 (960 poses, top of a jug) down to 0.177 for nine segments of objects, then 0.172 (7720 "
      "poses) for a part of the table; 10,480 poses point at objects, 91,960 in all, 960 were evaluated.",
      "Here: " + std::to_string(of_objects) + " poses of the segments before the first that is no object's, " +
          std::to_string(third.candidates) + " in all; the segment that was chosen has " + std::to_string(chosen) +
          ", of which the arm can take " + std::to_string(choice.candidates.size()) +
          ". Segments without contour points are left out.",
      "A segment is of the object that most of its points are nearest to."};
  add_exploration_notes(options, table);
  table.figures = {{"rows", std::move(rows)},
                   {"candidates", third.candidates},
                   {"of_objects", of_objects},
                   {"of_chosen", chosen},
                   {"evaluated", third.evaluated}};
  return table;
}

Result<ReproducedTable> reproduce_table_3_3(const ReproduceOptions& options, const Executor& executor,
                                            const Progress& progress) {
  constexpr std::array<const char*, 8> kThesis{"✓✓✓✓×", "✓✓✓××", "✓✓✓××", "✓✓✓✓✓", "×✓×✓×", "✓×××✓", "××✓×✓", "××✓××"};
  SACCADE_CHECK(carry_out_explorations(options, executor, progress));
  const Experiments& all = *options.experiments;
  ReproducedTable table;
  table.caption = "Table 3.3: views that point towards the objects (✓) or not (×)";
  table.columns = {"method", "experiment", "thesis", "by the axis", "by what became known"};
  const auto marks = [](const RunRecord& experiment, std::optional<bool> ViewRecord::*looks) {
    std::string text;
    for (std::size_t k = 0; k < kViews; ++k) text += mark(experiment.views, k, looks);
    return text;
  };
  std::size_t row = 0;
  std::array<std::array<std::size_t, 2>, 2> counts{};
  for (const bool attention : {true, false}) {
    const std::vector<RunRecord>& experiments = attention ? all.attention : all.standard;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
      table.rows.push_back({attention ? "attention" : "standard", std::to_string(i + 1) + ", " + kScenes.at(i),
                            kThesis.at(row++), marks(experiments[i], &ViewRecord::looks_at_object),
                            marks(experiments[i], nullptr)});
      for (const ViewRecord& view : experiments[i].views) {
        counts[attention ? 0 : 1][0] += view.looks_at_object.value_or(false) ? 1 : 0;
        counts[attention ? 0 : 1][1] += view.reveals_object.value_or(false) ? 1 : 0;
      }
    }
  }
  const auto of_20 = [](std::size_t count) { return std::to_string(count) + " of 20"; };
  table.notes = {
      "Attention: thesis 15 of 20, by the axis " + of_20(counts[0][0]) + ", by what became known " +
          of_20(counts[0][1]) + "; standard: thesis 7 of 20, " + of_20(counts[1][0]) + " and " + of_20(counts[1][1]) +
          ".",
      "By the axis: it comes within 5 cm of an object before it meets anything. By what became known: at least a "
      "quarter "
      "of the voxels lie within 5 cm of an object. The thesis does not say how it judged; by the second rule hardly a "
      "first view points at an object, since it also shows what was hidden behind (docs/metrics.md)."};
  add_exploration_notes(options, table);
  table.figures = experiments_json(all);
  return table;
}

Result<ReproducedTable> reproduce_figure_3_17(const ReproduceOptions& options, const Executor& executor,
                                              const Progress& progress) {
  SACCADE_CHECK(carry_out_explorations(options, executor, progress));
  const Experiments& all = *options.experiments;
  ReproducedTable table;
  table.caption = "Fig. 3.17: unknown voxels near the objects after each of five views, attention / standard / surface";
  table.columns = {"experiment", "scan", "1", "2", "3", "4", "5"};
  for (std::size_t i = 0; i < kScenes.size(); ++i) {
    Plot plot;
    plot.title = std::string{"Unknown near the objects, "} + kScenes.at(i) + " (thesis Fig. 3.17)";
    plot.x_label = "views after the initial scan";
    plot.y_label = "unknown voxels within 3 cm of objects";
    plot.min_x_step = 1.0;
    std::vector<std::string> row{std::to_string(i + 1) + ", " + kScenes.at(i)};
    row.resize(table.columns.size());
    for (const auto& [name, runs] : {std::pair{"attention", &all.attention}, std::pair{"standard", &all.standard},
                                     std::pair{"surface", &all.surface}}) {
      const RunRecord& run = (*runs)[i];
      PlotSeries series{name, {}, {}};
      for (std::size_t k = 0; k <= kViews; ++k) {
        const std::size_t taken = std::min(k, run.views.size());
        const Measures& map = taken == 0 ? run.scan.measures : run.views[taken - 1].measures;
        const std::size_t unknown = map.unknown_near_objects.value_or(0);
        series.x.push_back(static_cast<double>(k));
        series.y.push_back(static_cast<double>(unknown));
        row[k + 1] += (plot.series.empty() ? "" : " / ") + std::to_string(unknown);
      }
      plot.series.push_back(std::move(series));
    }
    plot.y_range = {0.0, static_cast<double>(all.attention[i].scan.measures.unknown_near_objects.value_or(0))};
    table.rows.push_back(std::move(row));
    table.plots.push_back({kTablePlotFiles.at(3 + i), plot_svg(plot)});
  }
  table.notes = {
      "The thesis shows curves without figures: its proposed method ends below the standard one in every "
      "experiment, and is above it here and there before. Attention and standard are as printed (--as-printed of "
      "explore); surface is what Saccade does by itself."};
  add_exploration_notes(options, table);
  table.figures = experiments_json(all);
  return table;
}

}  // namespace saccade::cli
