// SPDX-License-Identifier: Apache-2.0
// saccade update: a hand changes a scene, and the robot looks again at what it may have changed.
#include "update.hpp"

#include <algorithm>
#include <memory>

#include "context.hpp"
#include "explore_report.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
#include "update_cell.hpp"
#include "update_report.hpp"
#include "view_lines.hpp"

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

/// Says why there is no result; empty where there is one.
std::string without_result(const WatchedTask& task, const UpdateFigures& figures) {
  if (task.trajectory.empty()) return "the trajectory is empty; nothing was updated";
  if (task.regions.empty()) return "the hand did not act anywhere; nothing was updated";
  const RunRecord& explored = figures.run;
  if (!explored.views.empty()) return {};
  const UnknownOfRegions& unknown = figures.unknown_after_task;
  if (std::all_of(unknown.begin(), unknown.end(), [](std::size_t count) { return count == 0; })) {
    return "the hand acted outside the workspace; nothing was updated";
  }
  return "not one view of a region could be taken (" + in_words(explored.refused_at_end) +
         "); does the hand's trajectory lie in the scene's frame, within the robot's reach?";
}

Result<Outcome> update_scene(const UpdateOptions& options, Context& context) {
  const Executor& executor = context.executor();
  if (const std::string mixed = mixed_camera(options); !mixed.empty()) context.bar().note(mixed);
  SACCADE_TRY(const UpdateCase subject, open_update_case(options));
  SACCADE_TRY(const WatchedTask task, watch_task(options, subject));
  SACCADE_TRY(ExploreDevices devices, open_update_devices(options, subject, executor, &context.bar()));
  SACCADE_CHECK(context.open_folder());
  const RunFolder& out = *context.folder();
  SACCADE_CHECK(remove_update_pictures(out));

  UpdatePictures pictures{options, subject.after.scene.workspace, task, devices, out, executor};
  SACCADE_TRY(const std::unique_ptr<RunMessages> messages,
              run_messages(options.messages, devices.intrinsics(), context.bar()));
  Recorder silent;
  ViewLines lines{context.bar(), static_cast<std::size_t>(options.run.exploration.max_views),
                  options.run.strategy.gain_unit};
  Recorders recorders{options.write_pictures ? &pictures : &silent, messages.get(), &lines};
  SACCADE_TRY(const UpdateFigures figures,
              run_update(options, subject, task, devices, executor, context.progress(), &recorders));
  messages->finish();
  SACCADE_CHECK(write_maps(out, figures, task, executor));
  Outcome outcome;
  SACCADE_TRY(outcome.result, update_json(options, subject, task, figures, devices, executor, context.progress()));
  SACCADE_TRY(const json document, context.write_document(outcome.result));
  if (options.write_pictures) {
    SACCADE_CHECK(pictures.draw_maps(figures));
    SACCADE_CHECK(write_update_report(task, out, document));
  }
  outcome.text = update_text(options, task, outcome.result);
  if (figures.interrupted || context.progress().cancelled()) {
    outcome.cut_short = "stopped after " + std::to_string(figures.run.views.size()) + " views; what they gave is in " +
                        context.out().string();
    return outcome;
  }
  outcome.empty = without_result(task, figures);
  return outcome;
}

class Update final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"update", "looks again at the places of a scene where a hand has changed something"};
  }

  void declare(Options& options) override {
    options.folder({.help = "folder for the results (default: update-SCENE)",
                    .document = "update.json",
                    .otherwise = [this] { return "update-" + subject_path().stem().string(); },
                    .opened_by_command = true});
    folder_ = &options.request();
    add_update_options(options.group(), update_);
  }

  void check(const GlobalOptions& global) override {
    update_.out = folder_->path;
    update_.force = folder_->force;
    check_update_options(update_, global);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    return update_.cell_file.empty() ? update_scene(update_, context) : update_cell(update_, context);
  }

 private:
  /// Returns the cell or the scene that was named.
  [[nodiscard]] std::filesystem::path subject_path() const {
    return update_.cell_file.empty() ? update_.scene : update_.cell_file;
  }

  const FolderRequest* folder_{nullptr};
  UpdateOptions update_;
};

}  // namespace

void add_update(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Update>(program, global, action);
}

}  // namespace saccade::cli
