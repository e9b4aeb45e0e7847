// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `saccade annotate` is made of.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "annotated_cloud.hpp"
#include "command.hpp"
#include "progress_bar.hpp"
#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/neighbourhood.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "saccade/core/names.hpp"
#include "saccade/io/sessions/annotation_script.hpp"
#include "serve.hpp"

namespace saccade::cli {

enum class AnnotationMethod { control_points, rectangle, best_rectangle };
inline constexpr auto kAnnotationMethodNames =
    make_names<AnnotationMethod>({{AnnotationMethod::control_points, "control-points"},
                                  {AnnotationMethod::rectangle, "rectangle"},
                                  {AnnotationMethod::best_rectangle, "best-rectangle"}});

/// Whether true labels of one ten are parts of one object.
enum class Tens { detect, merge, keep };
inline constexpr auto kTensNames =
    make_names<Tens>({{Tens::detect, "detect"}, {Tens::merge, "merge"}, {Tens::keep, "keep"}});

/// An option of the graph that was given: what is to be said where a session's graph has another value.
using GivenGraphOption = std::function<std::optional<std::string>(const NeighbourhoodConfig& saved)>;

struct AnnotateOptions {
  std::filesystem::path cloud;  ///< or a folder of clouds; the paths below are then folders, too, but for names
  std::filesystem::path truth;  ///< labels of the simulated annotator
  Tens tens{Tens::detect};
  int clicks{4};                       ///< per label
  std::optional<std::size_t> actions;  ///< in all, in place of these
  bool background_is_none{false};      ///< the label that most points have counts as none, as in the thesis' score
  AnnotationMethod method{AnnotationMethod::control_points};
  std::filesystem::path script;
  std::filesystem::path session;
  std::filesystem::path presets;
  std::uint64_t client{0};      ///< of actions in the script that name none
  std::filesystem::path seeds;  ///< labels to begin with
  double seed_share{0.99};      ///< of them that control points give back
  std::filesystem::path out;    ///< labels
  std::filesystem::path names;  ///< of labels
  std::filesystem::path picture;
  std::filesystem::path margins;  ///< the cloud with how sure the label of each point is
  NeighbourhoodConfig graph;
  std::vector<GivenGraphOption> given_graph;
  bool page{false};  ///< opened also where there is something else to do
  ServeOptions serve;

  [[nodiscard]] bool of_folder() const;
  /// A person annotates; else it is done without one.
  [[nodiscard]] bool opens_page() const;
};

/// Of one cloud what is being done to it; of several how many are done. Every note once.
class AnnotateProgress {
 public:
  AnnotateProgress(bool quiet, bool of_folder) : bar_{quiet}, of_folder_{of_folder} {}
  void stage(std::string_view name, std::size_t done = 0, std::size_t total = 0) {
    if (!of_folder_) bar_.update(name, done, total);
  }
  void clouds(std::size_t done, std::size_t total) {
    if (of_folder_) bar_.update("clouds", done, total);
  }
  void note(const std::string& line) {
    if (noted_.insert(line).second) bar_.note(line);
  }
  void finish() { bar_.finish(); }

 private:
  ProgressBar bar_;
  bool of_folder_;
  std::set<std::string> noted_;
};

/// Files about one cloud; empty: none.
struct CloudJob {
  std::filesystem::path cloud;
  std::filesystem::path truth;
  std::filesystem::path session;
  std::filesystem::path seeds;
  LabelFiles files;
};

void add_annotate_options(CLI::App& command, AnnotateOptions& options);
/// Throws what is wrong with the options together.
void check_annotate_options(const AnnotateOptions& options);

/// The file of labels in a folder that belongs to a cloud: in its own format, where that is one for labels.
[[nodiscard]] std::filesystem::path labels_beside(const std::filesystem::path& folder,
                                                  const std::filesystem::path& cloud);

/// One cloud, or all of a folder in the order of their names. Errors of list_clouds; not_found for truth that is not
/// there; invalid_argument where two clouds would share a file.
[[nodiscard]] Result<std::vector<CloudJob>> plan_jobs(const AnnotateOptions& options);

/// No file that is written is one of those that are read, or another one that is written.
[[nodiscard]] Status check_outputs(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                                   const GlobalOptions& global);

/// Serves the page until Ctrl-C.
[[nodiscard]] Result<int> serve_annotation(const AnnotateOptions& options, const GlobalOptions& global);

/// Where a simulated annotation is after one action.
struct AnnotationStep {
  std::uint32_t label{0};
  double iou_mean{0.0};
  std::size_t errors{0};
};

struct SimulatedAnnotation {
  std::size_t points{0};   ///< that have a label in truth
  std::size_t objects{0};  ///< labels
  std::vector<AnnotationStep> clicks;
  std::vector<std::uint32_t> labels;          ///< per point; 0: none
  std::vector<std::uint32_t> control_points;  ///< points
  double graph_ms{0.0};
  double full_ms{0.0};
  std::vector<double> add_ms;
  std::vector<double> delete_ms;

  /// Clicks until the mean IoU was at least this; none: never.
  [[nodiscard]] std::optional<std::size_t> clicks_to(double iou_mean) const;
  /// After so many clicks per label, or the last one where nothing was wrong any more.
  [[nodiscard]] AnnotationStep after(std::size_t clicks_per_label) const;
};

/// A label per point, 0 for those that are not finite. Errors of read_labels.
[[nodiscard]] Result<std::vector<std::uint32_t>> read_truth(const AnnotateOptions& options, const CloudJob& job,
                                                            const PointCloud& cloud, AnnotateProgress& progress);
/// Errors name the job's files.
[[nodiscard]] Result<SimulatedAnnotation> simulate_annotation(const AnnotateOptions& options, const CloudJob& job,
                                                              const PointCloud& cloud,
                                                              const std::vector<std::uint32_t>& truth,
                                                              const Executor& executor, AnnotateProgress& progress);

/// What control points give back of labels.
struct SeedOutcome {
  std::size_t points{0};  ///< with a label
  std::size_t reproduced{0};
  std::size_t control_points{0};
};

/// What a session, a script or both made of a cloud.
struct AnnotatedCloud {
  std::size_t points{0};  ///< that are finite
  LabelledPoints labels;
  std::uint64_t actions{0};  ///< since the annotation began
  std::optional<SeedOutcome> seeds;
  std::optional<BestClick> next;    ///< where margins are asked for
  Eigen::Vector3f next_m{0, 0, 0};  ///< its place
  double graph_ms{0.0};
  std::vector<double> action_ms;  ///< of this run
  bool interrupted{false};

  [[nodiscard]] double labelled_share() const;
};

/// What is to be done on a cloud.
struct PlannedActions {
  std::vector<NumberedLabel> presets;
  std::vector<ScriptedAction> script;
  [[nodiscard]] bool empty() const { return presets.empty() && script.empty(); }
};

/// The annotation so far, of the job's session, with the actions done on it, after those of seeds. Where there are
/// none, the session is read and not opened; not_found if it was never begun. invalid_argument for seeds where it was.
[[nodiscard]] Result<AnnotatedCloud> annotate_cloud(const AnnotateOptions& options, const CloudJob& job,
                                                    const PlannedActions& actions, const LoadedCloud& cloud,
                                                    const Executor& executor, AnnotateProgress& progress);
/// Of a cloud on which nothing was done.
[[nodiscard]] AnnotatedCloud untouched(const LoadedCloud& cloud);

/// A cloud of a folder with what was made of it.
template <class T>
struct OfCloud {
  std::filesystem::path file;
  T made;
};

[[nodiscard]] nlohmann::json simulation_json(const AnnotateOptions& options, const SimulatedAnnotation& annotation);
[[nodiscard]] nlohmann::json mean_json(const AnnotateOptions& options,
                                       std::span<const OfCloud<SimulatedAnnotation>> clouds);
[[nodiscard]] nlohmann::json annotation_json(const AnnotatedCloud& cloud);
[[nodiscard]] nlohmann::json mean_json(std::span<const OfCloud<AnnotatedCloud>> clouds);
void print_simulation(const AnnotateOptions& options, const SimulatedAnnotation& annotation);
void print_simulations(const AnnotateOptions& options, std::span<const OfCloud<SimulatedAnnotation>> clouds);
void print_annotation(const AnnotateOptions& options, const AnnotatedCloud& cloud);
void print_annotations(std::span<const OfCloud<AnnotatedCloud>> clouds);

}  // namespace saccade::cli
