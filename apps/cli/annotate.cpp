// SPDX-License-Identifier: Apache-2.0
// saccade annotate: labels of a cloud's points from a few control points, placed by a person in the browser, a script
// or a simulated annotator.
#include "annotate.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <set>

#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/sessions/label_presets.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

Result<PlannedActions> planned_actions(const AnnotateOptions& options) {
  PlannedActions actions;
  if (!options.script.empty()) {
    SACCADE_TRY(actions.script, read_annotation_script(options.script));
  }
  if (!options.presets.empty()) {
    SACCADE_TRY(actions.presets, read_label_presets(options.presets));
  }
  return actions;
}

/// What became of one cloud after the other.
template <class T>
struct Run {
  std::vector<OfCloud<T>> clouds;
  bool interrupted{false};
};

/// Calls make(job, cloud) for each cloud and writes its files; what was made before an interruption stays.
template <class T, class Make>
Result<Run<T>> run_jobs(std::span<const CloudJob> jobs, AnnotateProgress& progress, const Make& make) {
  Run<T> run;
  for (const CloudJob& job : jobs) {
    run.interrupted = run.interrupted || interrupted();
    if (run.interrupted) break;
    progress.clouds(run.clouds.size(), jobs.size());
    progress.stage("reading");
    SACCADE_TRY(const LoadedCloud cloud, load_cloud(job.cloud));
    Result<T> made = make(job, cloud);
    if (!made && made.error().code == Errc::cancelled && !run.clouds.empty()) {
      run.interrupted = true;
      break;
    }
    if (!made) return made.error();
    run.clouds.push_back({job.cloud, std::move(*made)});
  }
  return run;
}

template <class T, class Json>
json clouds_json(const Run<T>& run, const Json& to_json) {
  json clouds = json::array();
  for (const OfCloud<T>& cloud : run.clouds) {
    clouds.push_back(to_json(cloud.made));
    clouds.back()["file"] = cloud.file.string();
  }
  return clouds;
}

/// The end of a run: its result, and the exit status.
Result<int> finish(const GlobalOptions& global, const Executor& executor, const Stopwatch& clock, json result,
                   bool was_interrupted, const std::string& kept) {
  result["interrupted"] = was_interrupted;
  SACCADE_CHECK(write_result("annotate", global, executor, {{"total", clock.elapsed_ms()}}, std::move(result)));
  if (!was_interrupted) return static_cast<int>(ExitStatus::done);
  print_error("annotate", "interrupted; " + kept);
  return interrupt_status();
}

Result<int> run_simulations(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                            const GlobalOptions& global) {
  const Stopwatch clock;
  const Executor executor = global.executor();
  AnnotateProgress progress{global.quiet, options.of_folder()};
  const auto simulate = [&](const CloudJob& job, const LoadedCloud& cloud) -> Result<SimulatedAnnotation> {
    SACCADE_TRY(const std::vector<std::uint32_t> truth, read_truth(options, job, cloud.points, progress));
    SACCADE_TRY(SimulatedAnnotation made, simulate_annotation(options, job, cloud.points, truth, executor, progress));
    SACCADE_CHECK(write_label_files(job.files, cloud, labelled_points(made.labels, made.control_points), executor));
    return made;
  };
  SACCADE_TRY(const Run<SimulatedAnnotation> run, run_jobs<SimulatedAnnotation>(jobs, progress, simulate));
  progress.finish();
  const auto to_json = [&](const SimulatedAnnotation& made) { return simulation_json(options, made); };
  json result = options.of_folder()
                    ? json{{"clouds", clouds_json(run, to_json)}, {"mean", mean_json(options, run.clouds)}}
                    : to_json(run.clouds.front().made);
  if (!global.json_to_stdout() && options.of_folder()) print_simulations(options, run.clouds);
  if (!global.json_to_stdout() && !options.of_folder()) print_simulation(options, run.clouds.front().made);
  return finish(global, executor, clock, std::move(result), run.interrupted,
                std::to_string(run.clouds.size()) + " of " + std::to_string(jobs.size()) + " clouds were done");
}

Result<int> run_annotations(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                            const GlobalOptions& global) {
  const Stopwatch clock;
  const Executor executor = global.executor();
  AnnotateProgress progress{global.quiet, options.of_folder()};
  SACCADE_TRY(const PlannedActions actions, planned_actions(options));
  bool cut_short{false};
  const auto annotate = [&](const CloudJob& job, const LoadedCloud& cloud) -> Result<AnnotatedCloud> {
    std::error_code ignored;
    const bool begun = !job.session.empty() && fs::exists(job.session, ignored);
    if (options.of_folder() && !begun && job.seeds.empty()) return untouched(cloud);
    SACCADE_TRY(AnnotatedCloud made, annotate_cloud(options, job, actions, cloud, executor, progress));
    cut_short = cut_short || made.interrupted;
    if (!made.interrupted) SACCADE_CHECK(write_label_files(job.files, cloud, made.labels, executor));
    return made;
  };
  SACCADE_TRY(const Run<AnnotatedCloud> run, run_jobs<AnnotatedCloud>(jobs, progress, annotate));
  progress.finish();
  json result = options.of_folder()
                    ? json{{"clouds", clouds_json(run, annotation_json)}, {"mean", mean_json(run.clouds)}}
                    : annotation_json(run.clouds.front().made);
  if (!global.json_to_stdout() && options.of_folder()) print_annotations(run.clouds);
  if (!global.json_to_stdout() && !options.of_folder()) print_annotation(options, run.clouds.front().made);
  const std::string kept =
      options.of_folder()
          ? std::to_string(run.clouds.size()) + " of " + std::to_string(jobs.size()) + " clouds were done"
          : std::to_string(run.clouds.front().made.action_ms.size()) + " of " + std::to_string(actions.script.size()) +
                " actions were done" + (options.session.empty() ? "" : " and are in the session") +
                "; no other file was written";
  return finish(global, executor, clock, std::move(result), run.interrupted || cut_short, kept);
}

Result<int> run_annotate(const AnnotateOptions& options, const GlobalOptions& global) {
  if (options.opens_page()) return serve_annotation(options, global);
  SACCADE_TRY(const std::vector<CloudJob> jobs, plan_jobs(options));
  SACCADE_CHECK(check_outputs(options, jobs, global));
  return options.truth.empty() ? run_annotations(options, jobs, global) : run_simulations(options, jobs, global);
}

}  // namespace

Status check_outputs(const AnnotateOptions& options, std::span<const CloudJob> jobs, const GlobalOptions& global) {
  std::set<fs::path> taken;
  const auto take = [&taken](const fs::path& file) {
    std::error_code ignored;
    return file.empty() || taken.insert(fs::weakly_canonical(file, ignored)).second;
  };
  for (const fs::path& file : {options.script, options.presets}) take(file);
  for (const CloudJob& job : jobs) {
    for (const fs::path& file : {job.cloud, job.truth, job.session, job.seeds}) take(file);
  }
  const auto check = [&](const fs::path& file, const char* option) {
    return check_output(file, option, take(file) ? std::vector<fs::path>{} : std::vector{file});
  };
  for (const CloudJob& job : jobs) {
    if (!job.files.out.empty()) SACCADE_CHECK(check_labels_path(job.files.out));
    SACCADE_CHECK(check(job.files.out, "--out"));
    SACCADE_CHECK(check(job.files.names, "--names"));
    SACCADE_CHECK(check(job.files.picture, "--picture"));
    SACCADE_CHECK(check(job.files.margins, "--margins"));
  }
  SACCADE_CHECK(check(global.json_to_stdout() ? "" : global.json, "--json"));
  return check_json_output(global);
}

void add_annotate(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("annotate",
                                             "labels of a point cloud from a few control points: opens a page in the "
                                             "browser to place them; or a script, labels "
                                             "or a simulated annotator do");
  auto options = std::make_shared<AnnotateOptions>();
  add_annotate_options(*command, *options);
  command->callback([&global, &action, options] {
    check_annotate_options(*options);
    action = [&global, options] { return run_annotate(*options, global); };
  });
}

}  // namespace saccade::cli
