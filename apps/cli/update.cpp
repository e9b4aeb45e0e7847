// SPDX-License-Identifier: Apache-2.0
// saccade update: a hand changes a scene, and the robot looks again at what it may have changed.
#include "update.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "exit_status.hpp"
#include "explore_report.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "progress_bar.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
#include "update_cell.hpp"
#include "update_report.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

Status write_maps(const RunFolder& out, const UpdateFigures& figures, const WatchedTask& task,
                  const Executor& executor) {
  SACCADE_CHECK(save_map(figures.before, out / "before.sacmap", executor));
  SACCADE_CHECK(save_map(figures.after, out / "map.sacmap", executor));
  SACCADE_CHECK(write_mesh(out / "mesh.ply", extract_mesh(figures.after, executor)));
  return write_hand_csv(out / "hand.csv", task.trajectory);
}

/// Why there is no result; nullopt where there is one.
std::optional<std::string> without_result(const WatchedTask& task, const UpdateFigures& figures) {
  if (task.trajectory.empty()) return "the trajectory is empty; nothing was updated";
  if (task.regions.empty()) return "the hand did not act anywhere; nothing was updated";
  const RunRecord& explored = figures.run;
  if (!explored.views.empty()) return std::nullopt;
  const UnknownOfRegions& unknown = figures.unknown_after_task;
  if (std::all_of(unknown.begin(), unknown.end(), [](std::size_t count) { return count == 0; })) {
    return "the hand acted outside the workspace; nothing was updated";
  }
  return "not one view of a region could be taken (" + in_words(explored.refused_at_end) +
         "); does the hand's trajectory lie in the scene's frame, within the robot's reach?";
}

Result<int> run_update_command(const UpdateOptions& options, const GlobalOptions& global) {
  const Stopwatch total;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  Progress progress{[&bar](std::string_view stage, std::size_t done, std::size_t of) { bar.update(stage, done, of); }};
  const CancelOnInterrupt cancel{progress};
  SACCADE_CHECK(check_json_output(global));
  SACCADE_TRY(const UpdateCase subject, open_update_case(options));
  SACCADE_TRY(const WatchedTask task, watch_task(options, subject));
  SACCADE_TRY(ExploreDevices devices, open_update_devices(options, subject, executor, &bar));
  SACCADE_TRY(const RunFolder out, RunFolder::open(options.out, {}, "update.json", options.force));
  SACCADE_CHECK(remove_update_pictures(out));

  UpdatePictures pictures{options, subject.after.scene.workspace, task, devices, out, executor};
  SACCADE_TRY(const std::unique_ptr<RunMessages> messages, run_messages(options.messages, devices.intrinsics()));
  Recorder silent;
  Recorders recorders{options.write_pictures ? &pictures : &silent, messages.get()};
  SACCADE_TRY(const UpdateFigures figures, run_update(options, subject, task, devices, executor, progress, &recorders));
  messages->finish();
  SACCADE_CHECK(write_maps(out, figures, task, executor));
  SACCADE_TRY(const json result, update_json(options, subject, task, figures, devices, executor, progress));
  const json document = json_envelope("update", global, executor, {{"total", total.elapsed_ms()}}, result);
  SACCADE_CHECK(write_json(out / "update.json", document));
  if (options.write_pictures) {
    SACCADE_CHECK(pictures.draw_maps(figures));
    SACCADE_CHECK(write_update_report(options, task, figures, out, document));
  }
  bar.finish();
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) print_update(options, task, result);
  if (figures.interrupted || progress.cancelled()) {
    print_error("update", "stopped after " + std::to_string(figures.run.views.size()) +
                              " views; what they gave is in " + options.out.string());
    return interrupt_status();
  }
  const std::optional<std::string> without = without_result(task, figures);
  if (!without) return static_cast<int>(ExitStatus::done);
  print_error("update", *without);
  return static_cast<int>(ExitStatus::no_result);
}

}  // namespace

void add_update(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      program.add_subcommand("update", "looks again at the places of a scene where a hand has changed something");
  auto options = std::make_shared<UpdateOptions>();
  add_update_options(*command, *options);
  command->callback([options, &global, &action] {
    check_update_options(*options, global);
    action = [options, &global] {
      return options->cell_file.empty() ? run_update_command(*options, global) : run_cell_update(*options, global);
    };
  });
}

}  // namespace saccade::cli
