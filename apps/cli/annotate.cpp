// SPDX-License-Identifier: Apache-2.0
// saccade annotate: labels of a cloud's points from a few control points, placed by a person in the browser, a script
// or a simulated annotator.
#include "annotate.hpp"

#include <memory>
#include <set>

#include "annotate_sequence.hpp"
#include "context.hpp"
#include "saccade/io/clouds/label_boxes_io.hpp"
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

/// The clouds that were done, one after the other.
template <class T>
struct Run {
  std::vector<CloudProgress<T>> clouds;
  bool interrupted{false};
};

/// Calls make(job, cloud) for each cloud and writes its files; what was made before an interruption stays.
template <class T, class Make>
Result<Run<T>> run_jobs(std::span<const CloudJob> jobs, AnnotateProgress& progress, const Make& make) {
  Run<T> run;
  for (const CloudJob& job : jobs) {
    run.interrupted = run.interrupted || interrupted();
    if (run.interrupted && run.clouds.empty()) return Error{Errc::cancelled, "interrupted", {}};
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
  for (const CloudProgress<T>& cloud : run.clouds) {
    clouds.push_back(to_json(cloud.made));
    clouds.back()["file"] = cloud.file.string();
  }
  return clouds;
}

std::string clouds_done(std::size_t done, std::size_t all) {
  return std::to_string(done) + " of " + std::to_string(all) + " clouds were done";
}

/// Says how a run ended. `kept` tells what an interrupted one has kept.
Outcome ended(json result, std::string text, bool was_interrupted, const std::string& kept) {
  result["interrupted"] = was_interrupted;
  return {.result = std::move(result),
          .text = std::move(text),
          .cut_short = was_interrupted ? "interrupted; " + kept : std::string{}};
}

Result<Outcome> run_simulations(const AnnotateOptions& options, std::span<const CloudJob> jobs, Context& context) {
  const Executor& executor = context.executor();
  AnnotateProgress progress{context.bar(), options.of_several()};
  const auto simulate = [&](const CloudJob& job, const LoadedCloud& cloud) -> Result<SimulatedAnnotation> {
    SACCADE_TRY(const std::vector<std::uint32_t> truth, read_truth(options, job, cloud.points, progress));
    SACCADE_TRY(SimulatedAnnotation made, simulate_annotation(options, job, cloud.points, truth, executor, progress));
    SACCADE_CHECK(write_label_files(job.files, cloud, labelled_points(made.labels, made.control_points), executor));
    return made;
  };
  SACCADE_TRY(const Run<SimulatedAnnotation> run, run_jobs<SimulatedAnnotation>(jobs, progress, simulate));
  const std::string kept = clouds_done(run.clouds.size(), jobs.size());
  if (!options.of_several()) {
    const SimulatedAnnotation& made = run.clouds.front().made;
    return ended(simulation_json(options, made), simulation_text(options, made), run.interrupted, kept);
  }
  const auto to_json = [&](const SimulatedAnnotation& made) { return simulation_json(options, made); };
  return ended({{"clouds", clouds_json(run, to_json)}, {"mean", mean_json(options, run.clouds)}},
               simulations_text(options, run.clouds), run.interrupted, kept);
}

/// Actions of each cloud: the lines of the script that are for it.
Result<std::vector<PlannedActions>> actions_of_jobs(const AnnotateOptions& options, std::span<const CloudJob> jobs) {
  SACCADE_TRY(PlannedActions all, planned_actions(options));
  SACCADE_TRY(std::vector<std::vector<ScriptedAction>> lines,
              lines_of_clouds(std::move(all.script), jobs, options.script));
  std::vector<PlannedActions> actions(jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    actions[i] = {all.presets, std::move(lines[i]), options.carry && i > 0, {}};
  }
  return actions;
}

Result<Outcome> run_annotations(const AnnotateOptions& options, std::span<const CloudJob> jobs, Context& context) {
  const Executor& executor = context.executor();
  AnnotateProgress progress{context.bar(), options.of_several()};
  SACCADE_TRY(std::vector<PlannedActions> actions, actions_of_jobs(options, jobs));
  std::size_t lines{0};
  std::size_t lines_done{0};
  for (const PlannedActions& of_cloud : actions) lines += of_cloud.script.size();
  bool cut_short{false};
  std::optional<DoneClouds> done;
  if (options.is_sequence()) done.emplace(jobs);
  const auto annotate = [&](const CloudJob& job, const LoadedCloud& cloud) -> Result<AnnotatedCloud> {
    PlannedActions& planned = actions[static_cast<std::size_t>(&job - jobs.data())];
    std::error_code ignored;
    const bool begun = !job.session.empty() && fs::exists(job.session, ignored);
    const bool is_asked = options.is_sequence() && !planned.empty();
    AnnotatedCloud made = untouched(cloud);
    if (done && !planned.empty()) {
      planned.before = done->source_for(job, cloud);
      std::vector<NumberedLabel> shared = done->labels();
      shared.insert(shared.end(), planned.presets.begin(), planned.presets.end());
      planned.presets = std::move(shared);
    }
    if (!options.of_several() || begun || is_asked || !job.seeds.empty()) {
      SACCADE_TRY(made, annotate_cloud(options, job, planned, cloud, executor, progress));
      lines_done += made.action_ms.size();
      cut_short = cut_short || made.interrupted;
      if (!made.interrupted) SACCADE_CHECK(write_label_files(job.files, cloud, made.labels, executor));
    }
    if (done) done->add(job, cloud, made);
    return made;
  };
  SACCADE_TRY(const Run<AnnotatedCloud> run, run_jobs<AnnotatedCloud>(jobs, progress, annotate));
  if (options.of_several()) {
    return ended({{"clouds", clouds_json(run, annotation_json)}, {"mean", mean_json(run.clouds)}},
                 annotations_text(run.clouds), run.interrupted || cut_short,
                 clouds_done(run.clouds.size(), jobs.size()));
  }
  const AnnotatedCloud& made = run.clouds.front().made;
  return ended(annotation_json(made), annotation_text(options, made), run.interrupted || cut_short,
               std::to_string(lines_done) + " of " + std::to_string(lines) + " actions were done" +
                   (options.session.empty() ? "" : " and are in the session") + "; no other file was written");
}

class Annotate final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"annotate",
            "labels of a point cloud from a few control points: opens a page in the browser to place them; or a "
            "script, labels or a simulated annotator do"};
  }
  void declare(Options& options) override { add_annotate_options(options.group(), annotate_); }
  void check(const GlobalOptions& /*global*/) override { check_annotate_options(annotate_); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (annotate_.opens_page()) return open_page(context);
    SACCADE_TRY(const JobList list, plan_jobs(annotate_));
    SACCADE_CHECK(check_outputs(annotate_, list.jobs, context.global()));
    for (const std::string& note : list.notes) context.bar().note(note);
    return annotate_.truth.empty() ? run_annotations(annotate_, list.jobs, context)
                                   : run_simulations(annotate_, list.jobs, context);
  }

 private:
  [[nodiscard]] Result<Outcome> open_page(Context& context) {
    SACCADE_TRY(page_, AnnotatePage::open(annotate_, context.global()));
    json result = page_->result();
    for (const json& note : result.value("notes", json::array())) context.bar().note(note.get<std::string>());
    return Outcome{.result = std::move(result), .afterwards = [this] {
                     page_->serve();
                     page_.reset();
                   }};
  }

  AnnotateOptions annotate_;
  std::unique_ptr<AnnotatePage> page_;
};

}  // namespace

Status check_outputs(const AnnotateOptions& options, std::span<const CloudJob> jobs, const GlobalOptions& global) {
  std::set<fs::path> taken;
  const auto take = [&taken](const fs::path& file) {
    std::error_code ignored;
    return file.empty() || taken.insert(fs::weakly_canonical(file, ignored)).second;
  };
  for (const fs::path& file : {options.script, options.presets, options.poses}) take(file);
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
    if (!job.files.boxes.empty()) SACCADE_CHECK(check_label_boxes_path(job.files.boxes));
    SACCADE_CHECK(check(job.files.boxes, "--boxes"));
  }
  return check(global.json_to_stdout() ? "" : global.json, "--json");
}

void add_annotate(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Annotate>(program, global, action);
}

}  // namespace saccade::cli
