// SPDX-License-Identifier: Apache-2.0
// saccade explore: a camera looks, fuses and decides where to look next, until a scene is known.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>

#include "context.hpp"
#include "explore_report.hpp"
#include "explore_run.hpp"
#include "explore_show.hpp"
#include "explore_surfels.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/maps/ternary_export.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/mesh.hpp"
#include "server/report_file.hpp"
#include "server/show/arm_reading.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// An interrupted run must not be written over, nor one be resumed that is not there.
Status check_journal(const ExploreOptions& options) {
  const bool there = has_journal(options.out);
  if (options.resume && !there) {
    return Error{Errc::not_found, "there is no interrupted run here to go on with", options.out.string()};
  }
  if (!options.resume && there && !options.force) {
    return Error{Errc::invalid_argument,
                 "the folder holds an interrupted run; go on with it by --resume, or start anew with --force",
                 options.out.string()};
  }
  return {};
}

/// A new run leaves nothing of an earlier, longer one.
Status make_room(const ExploreOptions& options, const RunFolder& out) {
  if (options.resume) return {};
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{out.path()}) {
    const std::string name = entry.path().filename().string();
    if (is_view_file(name)) names.push_back(name);
  }
  SACCADE_CHECK(remove_journal(out.path()));
  return out.remove(std::vector<std::string_view>{names.begin(), names.end()});
}

std::string phases_text(const json& phases) {
  std::string text;
  const auto add = [&](std::string_view key, std::string_view name) {
    const double s = phases.value(std::string{key}, 0.0);
    if (s <= 0.0) return;
    text += (text.empty() ? "" : ", ") + std::string{name} + " " + fixed(s, s < 10.0 ? 2 : 1) + " s";
  };
  for (const Phase phase : kPhaseNames.values) {
    if (phase != Phase::motion) add(to_string(phase), text_of(phase));
  }
  add("robot", "robot's motion (planned)");
  return text.empty() ? "-" : text;
}

/// Why views were not taken, over all views; empty: none was refused.
std::string refused_in(const std::vector<ViewRecord>& views) {
  RefusalCounts refused;
  std::size_t candidates = 0;
  for (const ViewRecord& view : views) {
    candidates += view.candidates;
    refused.add(view.refused);
  }
  const std::string text = in_words(refused);
  return text.empty() ? "" : text + " of " + std::to_string(candidates) + " candidates";
}

/// Views at which the arm could not tilt the camera all the way; empty: it could everywhere.
std::string tilts_text(const std::vector<ViewRecord>& views, const ExplorerConfig& config) {
  if (config.oscillation_frames < 2) return "";
  std::size_t narrow = 0;
  std::size_t left_out = 0;
  for (const ViewRecord& view : views) {
    left_out += static_cast<std::size_t>(config.oscillation_frames) - view.frames;
    if (view.tilt == Tilt{}) continue;  // a run that an older version began
    narrow += view.tilt.least_rad > -config.oscillation_rad || view.tilt.greatest_rad < config.oscillation_rad ? 1 : 0;
  }
  if (narrow + left_out == 0) return "";
  return std::to_string(narrow) + " of " + std::to_string(views.size()) + " views tilted less than ±" +
         fixed(to_deg(config.oscillation_rad), 0) + "°, " + std::to_string(left_out) + " frames left out";
}

void write_measures(std::ostream& text, const RunRecord& run, bool scanned, const Measures& final) {
  if (final.coverage && scanned) {
    text << "coverage  " << 100.0 * run.scan.measures.coverage.value_or(0.0) << " % after the scan, "
         << 100.0 * *final.coverage << " % at the end\n";
  }
  if (final.f_score) {
    text << "accuracy  " << 1e3 * final.accuracy_m.value_or(0.0) << " mm, Chamfer "
         << 1e3 * final.chamfer_m.value_or(0.0) << " mm, F-score at 5 mm " << std::setprecision(3) << *final.f_score
         << '\n';
  }
}

std::string summary_of(const ExploreOptions& options, const ExploreRun& explored, const Measures& final) {
  std::ostringstream text;
  const RunRecord& run = explored.record();
  text << std::fixed << std::setprecision(1);
  if (options.dry_run) {
    text << "dry run   nothing has moved; only what the scene's file says is taken to be there\n"
         << "scan      " << run.scan.views << " of " << run.scan.attempted << " poses can be taken\n";
    if (!run.views.empty()) {
      const Eigen::Vector3d p = run.views[0].T_world_camera.translation();
      text << "view      from (" << fixed(p.x(), 3) << ", " << fixed(p.y(), 3) << ", " << fixed(p.z(), 3)
           << ") m, after " << fixed(run.views[0].motion_s, 1) << " s of motion\n";
    }
  }
  if (run.scan.refused.total() > 0) {
    text << "scan      " << run.scan.views << " taken, passed over: " << in_words(run.scan.refused) << '\n';
  }
  if (!options.dry_run) write_measures(text, run, explored.scanned(), final);
  const std::string refused = refused_in(run.views);
  if (!refused.empty()) text << "refused   " << refused << '\n';
  const std::string tilts = tilts_text(run.views, options.run.exploration);
  if (!tilts.empty()) text << "tilts     " << tilts << '\n';
  std::string at_end = in_words(run.refused_at_end);
  if (at_end.empty()) at_end = end_text(run, options.run.strategy.gain_unit);
  text << "time      " << phases_text(phases_to_json(run.views)) << '\n'
       << "stopped   " << to_string(run.stopped_because) << (at_end.empty() ? "" : ": " + at_end) << '\n'
       << "results   " << (options.write_pictures ? options.out / "report.html" : options.out).string() << '\n';
  return text.str();
}

/// The robot, where the viewer finds it whatever folder it is started in: a file by its whole path.
std::string robot_of(const ExploreOptions& options) {
  if (!options.robot_command.empty()) return "external";
  const auto begins = [&](const BuiltinRobot& builtin) { return builtin.name.starts_with(options.robot); };
  const bool is_known = options.robot == "free" || std::ranges::any_of(builtin_robots(), begins);
  std::error_code code;
  if (is_known || !std::filesystem::exists(options.robot, code)) return options.robot;
  const std::filesystem::path path = std::filesystem::absolute(options.robot, code);
  return code ? options.robot : path.lexically_normal().string();
}

json result_json(const ExploreOptions& options, const ExploreSetup& subject, const ExploreDevices& devices,
                 const ExploreRun& explored, const Measures& final, std::size_t unknown_surfels) {
  const RunRecord& run = explored.record();
  const bool ended = run.stopped_because == StopReason::regions_done && !run.regions.empty();
  return {{"scene", subject.scene.name},
          {"out", options.out.string()},
          {"robot", robot_of(options)},
          {"arm_reading", server::arm_reading_to_json(options.arm_reading.urdf)},
          {"strategy", options.run.strategy.name},
          {"compute", explored.compute_to_json()},
          {"gain_unit", options.run.strategy.gain_unit},
          {"min_gain", options.run.planner.min_gain},
          {"noise", options.run.noise && options.camera_command.empty()},
          {"sensor", options.camera_command.empty() ? json(to_string(options.run.sensor)) : json(nullptr)},
          {"camera", camera_to_json(devices.intrinsics())},
          {"voxel_size_m", options.run.voxel_size_m},
          {"truth_spacing_m", subject.truth ? json(subject.truth->spacing_m()) : json(nullptr)},
          {"dry_run", options.dry_run},
          {"unrepeatable", options.has_programs() && !options.dry_run && run.scan.views + run.views.size() > 0},
          {"interrupted", run.stopped_because == StopReason::cancelled},
          {"initial", explored.scanned() ? scan_to_json(run.scan) : json(nullptr)},
          {"views", views_to_json(run.views)},
          {"phases_s", phases_to_json(run.views)},
          {"map", map_to_json(options, explored.map(), unknown_surfels)},
          {"final", measures_to_json(final)},
          {"refused_at_end", refusals_to_json(run.refused_at_end)},
          {"gain_left", ended ? json(run.regions.back().gain_left) : json(nullptr)},
          {"gain_needed", ended ? json(run.regions.back().gain_needed) : json(nullptr)},
          {"stopped_because", to_string(run.stopped_because)}};
}

/// Where there is a journal, an error loses nothing.
Error kept(Error error, const RunFolder& out) {
  if (has_journal(out.path())) error.message += "; what was seen until then is kept, add --resume to go on";
  return error;
}

/// The map, which with surfels says what is free, and the surface: a mesh, or surfels.
Status write_map(const RunFolder& out, const ExploreOptions& options, const ExploreRun& run, const Box& workspace,
                 std::span<const SurfelDisc> unknown, const Executor& executor) {
  SACCADE_CHECK(save_map(run.map(), out / "map.sacmap", executor));
  SACCADE_CHECK(write_surfels(out, options, unknown));
  if (!options.surfels) SACCADE_CHECK(write_mesh(out / "mesh.ply", extract_mesh(run.map(), executor)));
  TernaryVolumeConfig states;
  states.box = workspace;
  const auto written = write_ternary_volume(run.map(), out / "ternary.npy", states);
  return written ? Status{} : Status{written.error()};
}

/// Why there is no result; empty where there is one.
std::string without_result(const RunRecord& run, const TsdfSnapshot& map) {
  if (run.scan.views > 0 && map.grid.empty()) {
    return "not one frame showed any depth within the camera's range; are its depths and its range in metres?";
  }
  if (!run.views.empty() || run.stopped_because == StopReason::cancelled) return {};
  if (run.scan.attempted > 0 && run.scan.views == 0) {
    return "not one pose of the scan could be taken (" + in_words(run.scan.refused) +
           "); give the scene or the cell poses that the robot reaches, under scan";
  }
  if (run.stopped_because != StopReason::no_candidate) return {};
  return "not one view could be taken (" + in_words(run.refused_at_end) + "); does the robot stand where it should?";
}

class Explore final : public Command {
 public:
  explicit Explore(const Planners& planners) : planners_{&planners} {}

  [[nodiscard]] CommandInfo info() const override {
    return {"explore", "explores a scene with a camera, view by view"};
  }

  void declare(Options& options) override {
    options.folder({.value = "RUN",
                    .help = "folder for the results; made if it is not there",
                    .document = "run.json",
                    .required = true,
                    .opened_by_command = true});
    folder_ = &options.request();
    command_ = &options.group();
    add_explore_options(options.group(), explore_, *planners_);
  }

  void check(const GlobalOptions& global) override {
    explore_.out = folder_->path;
    explore_.force = folder_->force;
    check_explore_options(*command_, explore_, global);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (explore_.cell_problem) return *explore_.cell_problem;
    const std::string mixed = explore_.camera_command.empty() ? mixed_camera(explore_) : "";
    if (!mixed.empty()) context.bar().note(mixed);
    if (explore_.dry_run && explore_.run.strategy.name != explore_.strategy) {
      context.bar().note("the rehearsal chooses by " + explore_.run.strategy.name + " instead of " + explore_.strategy +
                         ": no surface is expected where nothing was seen yet");
    }
    SACCADE_CHECK(check_journal(explore_));
    SACCADE_TRY(const std::optional<ArmModel> arm, read_arm(explore_, &context.bar()));  // before anything is written
    SACCADE_CHECK(context.open_folder(explore_.resume ? "journal.json" : "run.json"));
    const RunFolder& out = *context.folder();
    SACCADE_CHECK(make_room(explore_, out));
    std::optional<SavedExploration> saved;  // read first: a damaged one is said before the scene is prepared
    if (explore_.resume) {
      SACCADE_TRY(saved, load_journal(out.path(), context.executor()));
    }
    SACCADE_TRY(ExploreSetup subject, open_case(explore_, context.executor()));
    subject_.emplace(std::move(subject));
    SACCADE_TRY(ExploreDevices devices, ExploreDevices::open(explore_, *subject_, arm, context.executor()));
    devices_.emplace(std::move(devices));
    SACCADE_TRY(run_, ExploreRun::create(explore_, *subject_, *devices_, out, context.executor(), context.bar()));
    if (saved) SACCADE_CHECK(run_->resume(std::move(*saved)));
    if (explore_.show) {
      SACCADE_TRY(show_,
                  ExploreShow::start(explore_.serve, context.global(), subject_->scene, out.path(), context.bar()));
      if (explore_.resume) show_->changed();
    }
    const auto recorded = [this] {
      if (show_) show_->changed();
    };
    const Status ended = run_->run(recorded, show_ ? show_->message_sink() : nullptr);
    if (!ended) return kept(ended.error(), out);
    return outcome_of(context);
  }

 private:
  /// Writes the map, run.json and the page. The journal is there until all of them are.
  [[nodiscard]] Status write_results(Context& context, const json& result, std::span<const SurfelDisc> unknown) const {
    const RunFolder& out = *context.folder();
    SACCADE_CHECK(write_map(out, explore_, *run_, subject_->scene.workspace, unknown, context.executor()));
    SACCADE_TRY(const json document, context.write_document(result));
    return explore_.write_pictures ? server::write_report(out / "report.html", document) : Status{};
  }

  /// Writes the results of the run, and returns its outcome.
  [[nodiscard]] Result<Outcome> outcome_of(Context& context) {
    const RunFolder& out = *context.folder();
    const RunRecord& run = run_->record();
    const Measures final = run_->measure_now();
    SACCADE_TRY(const std::vector<SurfelDisc> unknown, unknown_surfels_of(explore_, run_->map(), context.executor()));
    Outcome outcome{.result = result_json(explore_, *subject_, *devices_, *run_, final, unknown.size()),
                    .text = summary_of(explore_, *run_, final)};
    if (explore_.backend == ComputeBackend::cuda && outcome.result["compute"]["used"] == "cpu" && !run.views.empty()) {
      outcome.warnings.push_back("note: the strategy " + explore_.run.strategy.name + " asked nothing of the GPU");
    }
    if (const Status written = write_results(context, outcome.result, unknown); !written)
      return kept(written.error(), out);
    if (run.stopped_because == StopReason::cancelled) {
      outcome.cut_short =
          "stopped after " + std::to_string(run.views.size()) + " views; what they gave is in " +
          context.out().string() +
          (has_journal(out.path()) ? "; to go on, add --resume"
                                   : "; nothing was seen yet to go on from, so begin again with --force");
      return outcome;
    }
    SACCADE_CHECK(remove_journal(out.path()));
    if (show_) outcome.afterwards = [this] { show_->finish(); };
    const std::string why = without_result(run, run_->map());
    return std::move(outcome).empty_if(!why.empty(), why);
  }

  const Planners* planners_;
  const FolderRequest* folder_{nullptr};
  const CLI::App* command_{nullptr};
  ExploreOptions explore_;
  std::optional<ExploreSetup> subject_;
  std::optional<ExploreDevices> devices_;
  std::unique_ptr<ExploreRun> run_;
  std::unique_ptr<ExploreShow> show_;  // last: it reads what the others write
};

}  // namespace

void add_explore(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command(program, global, action, std::make_shared<Explore>(global.planners));
}

}  // namespace saccade::cli
