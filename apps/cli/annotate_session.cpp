// SPDX-License-Identifier: Apache-2.0
// An annotation that goes on: a session's actions so far, then those of presets and of a script.
#include <utility>
#include <variant>

#include "annotate.hpp"
#include "interrupt.hpp"
#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/label_seeds.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "saccade/io/sessions/label_presets.hpp"
#include "server/annotate/session_start.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

/// The session as it is on the disk, if there is one. It must be of this cloud, and the options that were given must
/// agree with its graph.
Result<std::optional<SavedSession>> saved_session(const AnnotateOptions& options, const CloudJob& job,
                                                  const LoadedCloud& cloud) {
  std::error_code ignored;
  if (job.session.empty() || !fs::exists(job.session, ignored)) return std::optional<SavedSession>{};
  SACCADE_TRY(SavedSession saved, read_journal(job.session));
  const NeighbourhoodConfig& graph = saved.subject.graph;
  const SessionSubject wanted{cloud.path.filename().string(), cloud.points.positions_m.size(),
                              hash_positions(cloud.points), graph};
  if (const Status same = check_same_subject(saved.subject, wanted); !same) return in_file(same.error(), job.session);
  for (const GivenGraphOption& given : options.given_graph) {
    if (const auto differs = given(graph)) return Error{Errc::invalid_argument, *differs, job.session.string()};
  }
  return std::optional{std::move(saved)};
}

/// In memory, or with a journal.
class OpenAnnotation {
 public:
  explicit OpenAnnotation(Annotation annotation) : state_{std::move(annotation)} {}
  explicit OpenAnnotation(AnnotationSession session) : state_{std::move(session)} {}

  [[nodiscard]] const Annotation& annotation() const {
    return is_kept() ? std::get<AnnotationSession>(state_).annotation() : std::get<Annotation>(state_);
  }
  [[nodiscard]] bool is_kept() const { return std::holds_alternative<AnnotationSession>(state_); }
  [[nodiscard]] Result<Applied> apply(AnnotationAction action) {
    if (is_kept()) return std::get<AnnotationSession>(state_).apply(std::move(action));
    auto& annotation = std::get<Annotation>(state_);
    SACCADE_CHECK(annotation.validate(action));
    return annotation.apply(std::move(action));
  }

 private:
  std::variant<Annotation, AnnotationSession> state_;
};

/// For what is to be done: without actions as it was saved.
Result<OpenAnnotation> open_annotation(const CloudJob& job, bool changes, const LoadedCloud& cloud,
                                       const std::optional<SavedSession>& saved,
                                       const std::shared_ptr<const Neighbourhood>& graph, const Executor& executor) {
  if (job.session.empty() || !changes) {
    Annotation annotation{graph, executor};
    if (saved) annotation.restore(saved->actions);
    return OpenAnnotation{std::move(annotation)};
  }
  SACCADE_TRY(AnnotationSession session,
              AnnotationSession::open_or_create(job.session, cloud.path.filename().string(),
                                                hash_positions(cloud.points), graph, executor));
  if (session.read_only()) return *session.read_only();
  return OpenAnnotation{std::move(session)};
}

/// Labels of which something else is known than in the presets, or nothing.
Status define_presets(const std::vector<NumberedLabel>& presets, std::uint64_t client, OpenAnnotation& annotation) {
  DefineLabels define{server::missing_presets(presets, annotation.annotation())};
  if (define.labels.empty()) return {};
  const auto applied = annotation.apply({client, std::move(define)});
  return applied ? Status{} : applied.error();
}

/// One action per label; those before are planted.
Status plant_seeds(const LabelSeeds& seeds, std::size_t before, std::uint64_t client, OpenAnnotation& annotation,
                   AnnotatedCloud& made) {
  made.seeds = SeedOutcome{seeds.points, seeds.reproduced, 0};
  for (std::size_t i = 0; i < seeds.actions.size(); ++i) {
    made.seeds->control_points += seeds.actions[i].points.size();
    if (i < before) continue;
    const auto applied = annotation.apply({client, seeds.actions[i]});
    if (!applied) return applied.error();
  }
  return {};
}

Result<std::optional<LabelSeeds>> seeds_of(const AnnotateOptions& options, const CloudJob& job,
                                           const LoadedCloud& cloud, const std::shared_ptr<const Neighbourhood>& graph,
                                           AnnotateProgress& progress) {
  if (job.seeds.empty()) return std::optional<LabelSeeds>{};
  progress.stage("seeds");
  SACCADE_TRY(const std::vector<std::uint32_t> labels, read_labels(job.seeds, graph->size()));
  SeedConfig config;
  config.share = options.seed_share;
  SACCADE_TRY(LabelSeeds seeds, in_file(label_seeds(graph, cloud.points, labels, config), job.seeds));
  return std::optional{std::move(seeds)};
}

/// Those before the line stay done.
Error failed_at(Error error, const ScriptedAction& scripted, const fs::path& script, std::size_t done, bool kept) {
  const std::string line = "line " + std::to_string(scripted.line);
  if (error.context.find(line) == std::string::npos) error.context = line;
  if (kept && done > 0) {
    error.message += "; the " + std::to_string(done) + (done == 1 ? " action" : " actions") +
                     " before it are in the session, so take those lines out before you run the script again";
  }
  return in_file(std::move(error), script);
}

/// Takes the labels of the cloud before, where points have none.
Status carry_on(const AnnotateOptions& options, const CarrySource* before, const LoadedCloud& cloud,
                OpenAnnotation& annotation, AnnotatedCloud& made, const Executor& executor,
                AnnotateProgress& progress) {
  if (before == nullptr) return {};
  progress.stage("carrying");
  SACCADE_TRY(CarriedLabels carried,
              carry_labels(*before, cloud.points.positions_m, annotation.annotation(), CarryConfig{}, executor));
  made.carried = carried.paint.points.size();
  if (made.carried == 0) return {};
  const auto applied = annotation.apply({options.client, std::move(carried.paint)});
  return applied ? Status{} : applied.error();
}

/// Subject of the lines of a script.
struct CloudInScript {
  const LoadedCloud& cloud;
  std::span<const std::uint32_t> segments;
  const CarrySource* before;
};

Status replay(const AnnotateOptions& options, std::span<const ScriptedAction> script, const CloudInScript& subject,
              OpenAnnotation& annotation, AnnotatedCloud& made, const Executor& executor, AnnotateProgress& progress) {
  const LoadedCloud& cloud = subject.cloud;
  for (const ScriptedAction& scripted : script) {
    if (interrupted()) {
      made.interrupted = true;
      return {};
    }
    progress.stage("actions", made.action_ms.size(), script.size());
    const Stopwatch stopwatch;
    auto action = resolve_action(scripted, cloud.points.positions_m, annotation.annotation(), options.client, executor,
                                 cloud.points.offset_m, subject.segments, subject.before);
    if (!action)
      return failed_at(action.error(), scripted, options.script, made.action_ms.size(), annotation.is_kept());
    const std::uint64_t client = action->client;
    if (const auto* paint = std::get_if<PaintLabels>(&action->change)) made.carried += paint->points.size();
    const auto applied = annotation.apply(std::move(*action));
    if (!applied)
      return failed_at(applied.error(), scripted, options.script, made.action_ms.size(), annotation.is_kept());
    if (!applied->done) {
      progress.note(options.script.string() + ", line " + std::to_string(scripted.line) + ": client " +
                    std::to_string(client) + " has nothing to " +
                    (std::holds_alternative<UndoAction>(scripted.change) ? "undo" : "redo"));
    }
    made.action_ms.push_back(stopwatch.elapsed_ms());
  }
  return {};
}

void find_margins(const Annotation& annotation, const LoadedCloud& cloud, AnnotatedCloud& made,
                  AnnotateProgress& progress) {
  progress.stage("margins");
  made.labels.margins = label_margins(annotation);
  const std::vector<std::uint8_t> ends =
      cloud_ends(annotation.forest().neighbourhood(), cloud.points.positions_m, cloud.points.normals);
  made.next = next_best_click(annotation, made.labels.margins, ends);
  if (made.next) made.next_m = cloud.points.positions_m[made.next->point].cast<double>() + cloud.points.offset_m;
}

}  // namespace

double AnnotatedCloud::labelled_share() const {
  return points == 0 ? 0.0 : static_cast<double>(labels.labelled()) / static_cast<double>(points);
}

AnnotatedCloud untouched(const LoadedCloud& cloud) {
  AnnotatedCloud made;
  for (const Eigen::Vector3f& p : cloud.points.positions_m) made.points += p.allFinite() ? 1 : 0;
  made.labels.labels.assign(cloud.points.positions_m.size(), kNoLabel);
  return made;
}

Result<AnnotatedCloud> annotate_cloud(const AnnotateOptions& options, const CloudJob& job,
                                      const PlannedActions& actions, const LoadedCloud& cloud, const Executor& executor,
                                      AnnotateProgress& progress) {
  SACCADE_TRY(const std::optional<SavedSession> saved, saved_session(options, job, cloud));
  if (!saved && actions.empty() && job.seeds.empty()) {
    if (!options.script.empty()) return Error{Errc::invalid_argument, "holds no action", options.script.string()};
    return Error{Errc::not_found, "there is no such session; --script, --seeds or --presets begin one",
                 job.session.string()};
  }
  if (saved && saved->torn_bytes > 0) {
    progress.note(job.session.string() + ": the last action was never finished (" + std::to_string(saved->torn_bytes) +
                  " bytes) and does not count");
  }
  if (!cloud.points.offset_m.isZero(0.0)) progress.note(offset_text(cloud.points.offset_m));
  const NeighbourhoodConfig& config = saved ? saved->subject.graph : options.graph;
  const Status checked = check_script(actions.script, cloud.points.positions_m.size(), config.max_path);
  if (!checked) return in_file(checked.error(), options.script);
  progress.stage("graph");
  const Stopwatch stopwatch;
  SACCADE_TRY(Neighbourhood built, in_file(build_graph(cloud.points, config, options.room, executor), job.cloud));
  const auto graph = std::make_shared<const Neighbourhood>(std::move(built));
  AnnotatedCloud made = untouched(cloud);
  made.graph_ms = stopwatch.elapsed_ms();
  SACCADE_TRY(std::optional<LabelSeeds> seeds, seeds_of(options, job, cloud, graph, progress));
  std::optional<std::size_t> planted{0};
  if (seeds && saved) planted = server::planted_before(*seeds, options.client, saved->actions);
  if (!planted && !options.of_several()) {
    return Error{Errc::invalid_argument,
                 "holds " + std::to_string(saved->actions.size()) +
                     " actions already; seeds begin a session: leave --seeds out, or name another file",
                 job.session.string()};
  }
  if (!planted) seeds.reset();  // a folder's seeds begin what is not begun
  const bool changes = !actions.empty() || seeds;
  SACCADE_TRY(OpenAnnotation annotation, open_annotation(job, changes, cloud, saved, graph, executor));
  if (seeds) SACCADE_CHECK(plant_seeds(*seeds, *planted, options.client, annotation, made));
  SACCADE_CHECK(define_presets(actions.presets, options.client, annotation));
  std::vector<std::uint32_t> segments;
  if (!job.segments.empty()) {
    SACCADE_TRY(segments, read_labels(job.segments, cloud.points.positions_m.size()));
  }
  const CarrySource* before = actions.before ? &*actions.before : nullptr;
  if (actions.carry) SACCADE_CHECK(carry_on(options, before, cloud, annotation, made, executor, progress));
  const CloudInScript in_script{cloud, segments, before};
  SACCADE_CHECK(replay(options, actions.script, in_script, annotation, made, executor, progress));
  made.labels = labelled_points(annotation.annotation());
  for (const auto& [number, info] : annotation.annotation().label_table().defined()) {
    made.defined.push_back({number, info});
  }
  made.actions = annotation.annotation().history().size();
  if (!options.margins.empty()) find_margins(annotation.annotation(), cloud, made, progress);
  return made;
}

}  // namespace saccade::cli
