// SPDX-License-Identifier: Apache-2.0
#include "experiments/updates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/map/mesh.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/update_pictures.hpp"
#include "text.hpp"
#include "update.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

const OverviewConfig kUpdateOverview{.width = 480, .height = 360};

double mean_abs_error_m(const json& objects) {
  double sum_m = 0.0;
  double count = 0.0;
  for (const json& object : objects) {
    if (object.at("error").is_null()) continue;
    for (const auto& [parameter, error_m] : object.at("error").items()) {
      sum_m += std::abs(error_m.get<double>());
      count += 1.0;
    }
  }
  return count > 0.0 ? sum_m / count : std::nan("");
}

double least_coverage(const json& regions) {
  double least = 1.0;
  for (const json& region : regions) {
    const json& surfaces = region.at("coverage").at("surfaces");
    if (!surfaces.is_null()) least = std::min(least, surfaces.get<double>());
  }
  return least;
}

cli::UpdateOptions options_of(const ThesisExperiment& experiment, const TableOptions& reproduce) {
  cli::UpdateOptions options;
  options.scene = experiment.scene;
  options.fuse_when = experiment.fuse_when;
  options.run.as_printed = reproduce.as_printed;
  if (reproduce.image_width_px > 0)
    options.camera.image_size = {reproduce.image_width_px, reproduce.image_width_px * 3 / 4};
  cli::GlobalOptions global;
  global.seed = reproduce.seed;
  check_update_options(options, global);
  return options;
}

/// Draws the views of an update as they are taken.
class UpdatePainter final : public Recorder {
 public:
  UpdatePainter(const Box& workspace, const PinholeCamera& camera, const Executor& executor)
      : workspace_{workspace}, camera_{camera}, executor_{executor} {}

  [[nodiscard]] Status scanned(ScanRecord& /*scan*/, const TsdfSnapshot& map) override {
    before_ = map;
    return {};
  }
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override {
    std::vector<ScoredPose> candidates;
    for (const RankedView& candidate : view.choice->candidates) {
      candidates.push_back({candidate.T_world_camera, candidate.gain});
    }
    CandidatesPictureConfig choice;
    choice.sensor = camera_;
    choice.overview = kUpdateOverview;
    pictures_.choices.push_back(candidates_picture(
        {before_, view.choice->region, candidates, view.T_world_camera, T_world_earlier_, nullptr}, executor_, choice));
    if (!frames.empty()) {
      const DepthScale scale{camera_.min_range_m, camera_.max_range_m};
      pictures_.seen.push_back(seen_picture(frames[frames.size() / 2], scale, kUpdateOverview.width / 2));
    }
    MapPictureConfig config;
    config.overview = kUpdateOverview;
    pictures_.maps.push_back(map_picture(map, workspace_, executor_, config));
    before_ = map;
    T_world_earlier_.push_back(view.T_world_camera);
    return {};
  }
  [[nodiscard]] UpdatePictures pictures() && { return std::move(pictures_); }

 private:
  Box workspace_;
  PinholeCamera camera_;
  Executor executor_;
  TsdfSnapshot before_;
  std::vector<Pose> T_world_earlier_;
  UpdatePictures pictures_;
};

void draw_task(const cli::WatchedTask& task, const cli::UpdateFigures& figures, const Box& workspace,
               double region_radius_m, const Executor& executor, UpdatePictures& pictures) {
  std::vector<Region> regions;
  for (const RegionOfInterest& region : task.regions) regions.push_back(region.bounds);
  const TaskScene scene{workspace, task.trajectory, task.findings, regions};
  TaskPictureConfig config;
  config.overview = kUpdateOverview;
  config.region_radius_m = region_radius_m;
  pictures.hand = task_picture(figures.before, scene, executor, config);
  pictures.forgotten = forgotten_picture(figures.forgotten, scene, executor, config);
  MapPictureConfig map;
  map.overview = kUpdateOverview;
  pictures.after = map_picture(figures.after, workspace, executor, map);
}

std::vector<std::vector<std::size_t>> unknown_of(const cli::UpdateFigures& figures) {
  std::vector<std::vector<std::size_t>> unknown;
  for (std::size_t region = 0; region < figures.unknown_after_task.size(); ++region) {
    unknown.push_back({figures.unknown_after_task[region]});
    for (const UnknownOfRegions& after : figures.unknown_after_view) unknown.back().push_back(after.at(region));
  }
  return unknown;
}

/// How far each point of interest is from the nearest true place.
std::vector<double> distances_m(const AttentionFindings& findings) {
  std::vector<double> all_m;
  for (const HandAction& action : findings.actions) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& place : findings.labels_m) {
      nearest_m = std::min(nearest_m, (action.position_m - place).norm());
    }
    all_m.push_back(nearest_m);
  }
  return all_m;
}

void fill_times(const json& result, OurUpdate& update) {
  const json& phases = result.at("phases_s");
  update.robot_s = phases.at("robot").get<double>();
  for (const auto& [phase, s] : phases.items()) {
    if (phase != "robot" && phase != "motion") update.computing_s += s.get<double>();
  }
  const auto views = static_cast<double>(std::max<std::size_t>(1, update.views));
  update.clear_s =
      phases.at("forgetting").get<double>() / static_cast<double>(std::max<std::size_t>(1, update.regions));
  const auto of = [&](const char* phase) { return phases.value(phase, 0.0); };
  update.nbv_s = (of("candidates") + of("reachability") + of("evaluation")) / views;
  update.movement_s = update.robot_s / (views + 1.0);  // the way back is one more
  for (const json& view : result.at("views")) update.evaluated += view.at("evaluated").get<double>() / views;
}

Result<OurUpdate> carry_out(const ThesisExperiment& experiment, const TableOptions& reproduce, const Executor& executor,
                            const Progress& progress) {
  const cli::UpdateOptions options = options_of(experiment, reproduce);
  SACCADE_TRY(const cli::UpdateCase subject, open_update_case(options));
  SACCADE_TRY(const cli::WatchedTask task, watch_task(options, subject));
  SACCADE_TRY(cli::ExploreDevices devices, open_update_devices(options, subject, executor));
  const Box& workspace = subject.after.scene.workspace;
  UpdatePainter painter{workspace, devices.intrinsics(), executor};
  SACCADE_TRY(const cli::UpdateFigures figures,
              run_update(options, subject, task, devices, executor, progress, reproduce.draws ? &painter : nullptr));
  if (figures.interrupted) return Error{Errc::cancelled, "cancelled", std::string{"experiment "} + experiment.scene};
  SACCADE_TRY(const json result, update_json(options, subject, task, figures, devices, executor, progress));
  OurUpdate update;
  update.mean_abs_error_m = mean_abs_error_m(result.at("objects"));
  update.coverage = least_coverage(result.at("regions"));
  update.regions = result.at("regions").size();
  update.views = result.at("views").size();
  update.method = options.method->name;
  update.gain_width_px = options.run.gain_width_px;
  update.min_gain = options.run.planner.min_gain;
  update.computing_s = 1e-3 * task.ms;
  fill_times(result, update);
  update.unknown = unknown_of(figures);
  for (const ViewRecord& view : figures.run.views) update.region_of_view.push_back(view.region);
  update.samples = task.trajectory.size();
  update.gaussians = task.findings.gaussians.size();
  update.off_m = distances_m(task.findings);
  update.pictures = std::move(painter).pictures();
  if (reproduce.draws) draw_task(task, figures, workspace, options.region_radius_m, executor, update.pictures);
  return update;
}

/// Notes which of Saccade's own steps took part, or with --as-printed which steps of the thesis replaced them, and
/// which steps of the thesis were left out.
std::vector<std::string> setting_notes(const TableOptions& options, const OurUpdate& update) {
  const std::string rays = std::to_string(update.gain_width_px) + " rays across and IncTh " +
                           fixed(update.min_gain, update.min_gain < 20.0 ? 1 : 0);
  if (!options.as_printed) {
    return {
        "Ours, not the thesis': hands by the dip detector, promises of views are believed only where they are "
        "credible, and gains of views that the arm can take alone, with " +
        rays + ". --as-printed does what the thesis prints; docs/guides/update.md says what differs then."};
  }
  return {
      "As printed (--as-printed): hands by GMM-AS, every promise is believed, and all 960 views are evaluated "
      "before the arm is asked, with " +
          rays + " (the thesis does not print IncTh: here it is the same share of all rays as without --as-printed).",
      "Not as printed: GMM-AS has the formula and POITh that give the thesis' own tables, since by eq. 2.13 and 2.5 "
      "it finds other places than those where the hand acted; after a view the best of the new ranking is next, "
      "where the letter of Algorithm 1 would go on with the number of the last; free space is counted to W_th "
      "(decision 1)."};
}

}  // namespace

Status carry_out_updates(const TableOptions& options, const Executor& executor, const Progress& progress,
                         std::optional<UpdateExperiments>& all) {
  if (all) return {};
  UpdateExperiments made;
  for (const ThesisExperiment& experiment : kUpdateExperiments) {
    progress.report("experiments", made.size(), kUpdateExperiments.size());
    SACCADE_TRY(OurUpdate update, carry_out(experiment, options, executor, progress));
    made.push_back(std::move(update));
  }
  all = std::move(made);
  return {};
}

const char* thesis_name(FuseWhen when) { return when == FuseWhen::viewpoints ? "KFOVP" : "KFOM"; }

std::string here_name(const TableOptions& options) { return options.as_printed ? "here, as printed" : "here"; }

json updates_json(const UpdateExperiments& all, bool as_printed) {
  json rows = json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ThesisExperiment& thesis = kUpdateExperiments.at(i);
    const OurUpdate& update = all[i];
    rows.push_back({{"experiment", thesis.number},
                    {"scene", thesis.scene},
                    {"fuse_when", to_string(thesis.fuse_when)},
                    {"thesis",
                     {{"error_m", thesis.error_m},
                      {"completeness_of_10", thesis.completeness},
                      {"views", thesis.views},
                      {"time_s", thesis.time_s},
                      {"clear_s", thesis.clear_s},
                      {"nbv_s", thesis.nbv_s},
                      {"movement_s", thesis.movement_s}}},
                    {"error_m", update.mean_abs_error_m},
                    {"coverage", update.coverage},
                    {"regions", update.regions},
                    {"views", update.views},
                    {"robot_s", update.robot_s},
                    {"computing_s", update.computing_s},
                    {"clear_s", update.clear_s},
                    {"nbv_s", update.nbv_s},
                    {"movement_s", update.movement_s},
                    {"evaluated", update.evaluated},
                    {"method", update.method},
                    {"gain_width_px", update.gain_width_px},
                    {"min_gain", update.min_gain}});
  }
  return {{"as_printed", as_printed}, {"rows", std::move(rows)}};
}

void add_update_notes(const TableOptions& options, const OurUpdate& update, ReproducedTable& table) {
  for (std::string& note : setting_notes(options, update)) table.notes.push_back(std::move(note));
  table.notes.emplace_back(
      "Here the scenes, the hand, the arm and the camera with its noise are simulated (`saccade update --scene "
      "bottle|jug`); the thesis' were real. The objects, the table and the room are of our making, so figures compare "
      "in "
      "kind, not to the digit.");
  if (options.image_width_px > 0) {
    table.notes.push_back("Images are " + std::to_string(options.image_width_px) +
                          " pixels wide (--image-width), which is quicker, but not what the thesis did.");
  }
}

}  // namespace saccade::reproduce
