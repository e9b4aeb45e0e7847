// SPDX-License-Identifier: Apache-2.0
#include "experiments/surfel_trials.hpp"

#include "text.hpp"

namespace saccade::reproduce {

using nlohmann::json;
using thesis::SurfelTrial;

thesis::SurfelTrialConfig surfel_trial_config(const TableOptions& options) {
  thesis::SurfelTrialConfig config;
  config.frames = options.frames;
  config.image_width_px = options.image_width_px;
  config.placements = options.placements;
  config.seed = options.seed;
  if (options.as_printed) {
    config.mode_filter = ModeFilterConfig::as_printed();
    config.places_of_modes = true;
    config.flood_fill = FloodFillConfig::as_printed();
    config.sv_lccp = SvLccpConfig::as_printed();
  }
  return config;
}

Result<const SurfelTrial*> surfel_trial(const TableOptions& options, std::size_t scene, const Executor& executor,
                                        const Progress& progress, SurfelExperiments& all) {
  std::optional<SurfelTrial>& trial = all.at(scene);
  if (trial) return &*trial;
  SACCADE_TRY(trial, carry_out_surfel_trial(kSurfelScenes.at(scene), surfel_trial_config(options), executor, progress));
  return &*trial;
}

namespace {

/// Notes what --as-printed does, and where it does not follow the thesis.
void add_printed_notes(const TableOptions& options, bool is_of_sv_lccp, ReproducedTable& table) {
  table.notes.push_back(
      "As printed (--as-printed): the mode filter is Algorithm 6 with eq. 4.11, the heaviest mode in its own place, "
      "and "
      "depths as far as the guided filter moves them" +
      std::string{is_of_sv_lccp ? "; supervoxels and LCCP do what PCL 1.13 does where nothing is set." : "."});
  std::string open =
      "Not as printed: which pixel sees which surfel, normals and radii are ours, where the thesis has ElasticFusion's "
      "(decision 16); guidance is that of the modes at the frame's beginning, as line 18 needs whole images; "
      "boundaries "
      "are assigned exactly where that can be done, the thesis' approximately.";
  if (is_of_sv_lccp) {
    open += " Supervoxels are the project's own by PCL's rules, not PCL's";
    open += options.placements == 1 ? "."
                                    : ", with several places of the grid, of which the thesis has one "
                                      "(--placements 1).";
  }
  table.notes.push_back(open);
}

}  // namespace

void add_surfel_notes(const TableOptions& options, bool is_of_sv_lccp, ReproducedTable& table) {
  if (is_of_sv_lccp) {
    table.notes.push_back("SV-LCCP is done with the grid of seeds in " + std::to_string(options.placements) +
                          (options.placements == 1 ? " place." : " places, and the figures are taken together."));
  }
  table.notes.push_back(
      "Here scenes are rendered, with noise of depth, colours and poses (docs/guides/surfel-scenes.md), and truth "
      "comes from "
      "the renderer; the thesis' were recorded and annotated by hand. Figures compare in kind.");
  if (options.as_printed) add_printed_notes(options, is_of_sv_lccp, table);
  if (options.frames > 0) {
    table.notes.push_back("Only " + std::to_string(options.frames) +
                          " frames of each (--frames), which is quicker, but not what the thesis did.");
  }
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

void mark_missing(const std::vector<std::string>& scenes, ReproducedTable& table) {
  if (scenes.empty()) return;
  table.complete = false;
  table.notes.push_back("Interrupted: without " + joined(scenes) + ".");
}

namespace {

/// Indices into kSurfelScenes.
std::vector<std::size_t> chosen_scenes(const TableOptions& options) {
  std::vector<std::size_t> chosen;
  for (std::size_t scene = 0; scene < kSurfelScenes.size(); ++scene) {
    if (options.surfel_scene.empty() || options.surfel_scene == kSurfelScenes.at(scene)) chosen.push_back(scene);
  }
  return chosen;
}

}  // namespace

Result<DoneTrials> surfel_trials(const TableOptions& options, const Executor& executor, const Progress& progress,
                                 SurfelExperiments& all) {
  DoneTrials trials;
  Status interruption;
  for (const std::size_t scene : chosen_scenes(options)) {
    const auto trial = surfel_trial(options, scene, executor, progress, all);
    if (trial) {
      trials.done.push_back({scene, *trial});
    } else if (trial.error().code == Errc::cancelled) {
      trials.missing.emplace_back(kSurfelScenes.at(scene));
      interruption = trial.error();
    } else {
      return trial.error();
    }
  }
  if (trials.done.empty()) return interruption.error();
  return trials;
}

nlohmann::json json_of(const ScoreCurve& curve) {
  json points = json::array();
  for (const CurvePoint& point : curve.points) {
    points.push_back({{"threshold", point.threshold},
                      {"segments", point.segments},
                      {"precision", optional_json(point.score.precision())},
                      {"recall", optional_json(point.score.recall())},
                      {"f", optional_json(point.score.f())},
                      {"bce", point.score.bce}});
  }
  const std::optional<CurvePoint> best_f = curve.best_f();
  const std::optional<CurvePoint> least_bce = curve.least_bce();
  return {{"points", std::move(points)},
          {"area", curve.area()},
          {"best_f", best_f ? optional_json(best_f->score.f()) : json(nullptr)},
          {"least_bce", least_bce ? json(least_bce->score.bce) : json(nullptr)}};
}

}  // namespace saccade::reproduce
