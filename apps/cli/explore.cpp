// SPDX-License-Identifier: Apache-2.0
// saccade explore: a camera looks, fuses and decides where to look next, until a scene is known.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

#include "exit_status.hpp"
#include "explore_report.hpp"
#include "explore_run.hpp"
#include "explore_show.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/maps/ternary_export.hpp"
#include "saccade/io/runs/run_json.hpp"
#include "saccade/map/mesh.hpp"
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
  add("robot", "robot's motion (simulated)");
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

void print_views(const std::vector<ViewRecord>& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewRecord& view = views[i];
    const double gain = view.gain_predicted;
    std::cout << "view " << std::setw(2) << i + 1 << "  gain " << std::setw(7)
              << (std::isfinite(gain) ? fixed(gain, gain == std::floor(gain) ? 0 : 1) : "null");
    if (std::isfinite(view.gain_observed)) {
      std::cout << "  kept " << std::setw(3) << fixed(100.0 * view.gain_observed / gain, 0) << " %";
    }
    if (view.measures.coverage) std::cout << "  coverage " << 100.0 * *view.measures.coverage << " %";
    std::cout << "  unknown " << view.measures.unknown_left << '\n';
  }
}

void print_measures(const RunRecord& run, bool scanned, const Measures& final) {
  if (final.coverage && scanned) {
    std::cout << "coverage  " << 100.0 * run.scan.measures.coverage.value_or(0.0) << " % after the scan, "
              << 100.0 * *final.coverage << " % at the end\n";
  }
  if (final.f_score) {
    std::cout << "accuracy  " << 1e3 * final.accuracy_m.value_or(0.0) << " mm, Chamfer "
              << 1e3 * final.chamfer_m.value_or(0.0) << " mm, F-score at 5 mm " << std::setprecision(3)
              << *final.f_score << '\n';
  }
}

void print_summary(const ExploreOptions& options, const ExploreRun& explored, const Measures& final) {
  const RunRecord& run = explored.record();
  std::cout << std::fixed << std::setprecision(1);
  if (options.dry_run) {
    std::cout << "dry run   nothing has moved; only what the scene's file says is taken to be there\n"
              << "scan      " << run.scan.views << " of " << run.scan.attempted << " poses can be taken\n";
    if (!run.views.empty()) {
      const Eigen::Vector3d p = run.views[0].T_world_camera.translation();
      std::cout << "view      from (" << fixed(p.x(), 3) << ", " << fixed(p.y(), 3) << ", " << fixed(p.z(), 3)
                << ") m, after " << fixed(run.views[0].motion_s, 1) << " s of motion\n";
    }
  }
  if (run.scan.refused.total() > 0) {
    std::cout << "scan      " << run.scan.views << " taken, passed over: " << in_words(run.scan.refused) << '\n';
  }
  if (!options.dry_run) print_views(run.views);
  if (!options.dry_run) print_measures(run, explored.scanned(), final);
  const std::string refused = refused_in(run.views);
  if (!refused.empty()) std::cout << "refused   " << refused << '\n';
  const std::string tilts = tilts_text(run.views, options.run.exploration);
  if (!tilts.empty()) std::cout << "tilts     " << tilts << '\n';
  std::string at_end = in_words(run.refused_at_end);
  if (at_end.empty()) at_end = end_text(run, options.run.strategy.gain_unit);
  std::cout << "time      " << phases_text(phases_to_json(run.views)) << '\n'
            << "stopped   " << to_string(run.stopped_because) << (at_end.empty() ? "" : ": " + at_end) << '\n'
            << "results   " << (options.write_pictures ? options.out / "report.html" : options.out).string() << '\n';
}

json result_json(const ExploreOptions& options, const ExploreCase& subject, const ExploreDevices& devices,
                 const ExploreRun& explored, const Measures& final) {
  const RunRecord& run = explored.record();
  const bool ended = run.stopped_because == StopReason::regions_done && !run.regions.empty();
  return {{"scene", subject.scene.name},
          {"out", options.out.string()},
          {"robot", options.robot_command.empty() ? options.robot : "external"},
          {"arm_reading", server::arm_reading_to_json(options.arm_reading.urdf)},
          {"strategy", options.run.strategy.name},
          {"noise", options.run.noise && options.camera_command.empty()},
          {"sensor", options.camera_command.empty() ? json(to_string(options.run.sensor)) : json(nullptr)},
          {"camera", camera_to_json(devices.intrinsics())},
          {"voxel_size_m", options.run.voxel_size_m},
          {"truth_spacing_m", subject.truth ? json(subject.truth->spacing_m()) : json(nullptr)},
          {"dry_run", options.dry_run},
          {"interrupted", run.stopped_because == StopReason::cancelled},
          {"initial", explored.scanned() ? scan_to_json(run.scan) : json(nullptr)},
          {"views", views_to_json(run.views)},
          {"phases_s", phases_to_json(run.views)},
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

Status write_map(const RunFolder& out, const ExploreRun& run, const Box& workspace, const Executor& executor) {
  SACCADE_CHECK(save_map(run.map(), out / "map.sacmap", executor));
  SACCADE_CHECK(write_mesh(out / "mesh.ply", extract_mesh(run.map(), executor)));
  TernaryVolumeConfig states;
  states.box = workspace;
  const auto written = write_ternary_volume(run.map(), out / "ternary.npy", states);
  return written ? Status{} : Status{written.error()};
}

Result<int> run_explore(const ExploreOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  const Executor executor = global.executor();
  ProgressBar progress{global.quiet};
  SACCADE_CHECK(check_json_output(global));
  if (options.cell_problem) return *options.cell_problem;
  SACCADE_CHECK(check_journal(options));
  SACCADE_TRY(const std::optional<ArmModel> arm, read_arm(options, &progress));  // before anything is written
  SACCADE_TRY(const RunFolder out,
              RunFolder::open(options.out, {}, options.resume ? "journal.json" : "run.json", options.force));
  SACCADE_CHECK(make_room(options, out));
  std::optional<SavedExploration> saved;  // read first: a damaged one is said before the scene is prepared
  if (options.resume) {
    SACCADE_TRY(saved, load_journal(out.path(), executor));
  }
  SACCADE_TRY(const ExploreCase subject, open_case(options, executor));
  SACCADE_TRY(ExploreDevices devices, ExploreDevices::open(options, subject, arm, executor));
  SACCADE_TRY(const std::unique_ptr<ExploreRun> run,
              ExploreRun::create(options, subject, devices, out, executor, progress));
  if (saved) SACCADE_CHECK(run->resume(std::move(*saved)));

  std::unique_ptr<ExploreShow> show;
  if (options.show) {
    SACCADE_TRY(show, ExploreShow::start(options.serve, global, subject.scene, out.path()));
    if (options.resume) show->changed();
  }
  const auto recorded = [&show] {
    if (show) show->changed();
  };
  const Status ended = run->run(recorded, show ? show->message_sink() : nullptr);
  if (!ended) return kept(ended.error(), out);
  const StopReason reason = run->record().stopped_because;
  const Status written = write_map(out, *run, subject.scene.workspace, executor);
  if (!written) return kept(written.error(), out);
  const Measures final = run->measure_now();
  const json result = result_json(options, subject, devices, *run, final);
  progress.finish();
  const json document = json_envelope("explore", global, executor, {{"total", total.elapsed_ms()}}, result);
  SACCADE_CHECK(write_json(out / "run.json", document));
  if (options.write_pictures) SACCADE_CHECK(write_report(out, run->record(), final, document, options));
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) print_summary(options, *run, final);
  if (reason != StopReason::cancelled) {
    SACCADE_CHECK(remove_journal(out.path()));
    if (show) show->finish();
    const ScanRecord& scan = run->record().scan;
    if (run->record().views.empty() && scan.attempted > 0 && scan.views == 0) {
      print_error("explore", "not one pose of the scan could be taken (" + in_words(scan.refused) +
                                 "); give the scene or the cell poses that the robot reaches, under scan");
      return static_cast<int>(ExitStatus::no_result);
    }
    if (!run->record().views.empty() || reason != StopReason::no_candidate) return static_cast<int>(ExitStatus::done);
    print_error("explore", "not one view could be taken (" + in_words(run->record().refused_at_end) +
                               "); does the robot stand where it should?");
    return static_cast<int>(ExitStatus::no_result);
  }
  print_error("explore", "stopped after " + std::to_string(run->record().views.size()) +
                             " views; what they gave is in " + options.out.string() +
                             (has_journal(out.path()) ? "; to go on, add --resume" : ""));
  return interrupted() ? interrupt_status() : static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_explore(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("explore", "a camera explores a scene, view by view");
  auto options = std::make_shared<ExploreOptions>();
  add_explore_options(*command, *options, global.planners);
  command->callback([options, &global, &action] {
    check_explore_options(*options, global);
    action = [options, &global] { return run_explore(*options, global); };
  });
}

}  // namespace saccade::cli
