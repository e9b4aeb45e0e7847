// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotateOptions and the parts of `saccade annotate`: its jobs, a simulated annotator, sessions and scripts, the page.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
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
#include "saccade/annotate/carried_labels.hpp"
#include "saccade/annotate/graph_room.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
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

/// Format of boxes in a folder of them.
enum class BoxFormat { json, kitti };
inline constexpr auto kBoxFormatNames = make_names<BoxFormat>({{BoxFormat::json, "json"}, {BoxFormat::kitti, "kitti"}});

/// An option of the graph that was given: what is to be said where a session's graph has another value.
using GivenGraphOption = std::function<std::optional<std::string>(const NeighbourhoodConfig& saved)>;

struct AnnotateOptions {
  std::vector<std::filesystem::path> clouds;  ///< or one folder of clouds
  std::filesystem::path cloud;  ///< the first; where there are several, the paths below are folders, but for names
  std::filesystem::path poses;  ///< poses of the clouds
  bool sequence{false};         ///< a folder without poses is one, too
  bool carry{false};            ///< each cloud takes labels from the one before it
  std::filesystem::path truth;  ///< labels of the simulated annotator
  Tens tens{Tens::detect};
  int clicks{4};                       ///< per label
  std::optional<std::size_t> actions;  ///< in all, in place of these
  bool background_is_none{false};      ///< the label that most points have counts as none, as in the thesis' score
  AnnotationMethod method{AnnotationMethod::control_points};
  std::filesystem::path script;
  std::filesystem::path session;
  std::filesystem::path presets;
  std::uint64_t client{0};         ///< does the actions in the script that name no client
  std::filesystem::path seeds;     ///< labels to begin with
  std::filesystem::path segments;  ///< labels of points, to be accepted segment by segment
  double seed_share{0.99};         ///< share of the seeds that control points give back
  std::filesystem::path out;       ///< labels
  std::filesystem::path names;     ///< names of labels
  std::filesystem::path picture;
  std::filesystem::path margins;  ///< the cloud with how sure the label of each point is
  std::filesystem::path boxes;    ///< boxes around the labels
  BoxFormat boxes_as{BoxFormat::json};
  NeighbourhoodConfig graph;
  GraphRoom room;
  std::vector<GivenGraphOption> given_graph;
  std::size_t tiles_above_points{4'000'000};  ///< larger clouds are sent to the page in tiles
  bool page{false};                           ///< opened also where there is something else to do
  ServeOptions serve;

  [[nodiscard]] bool of_folder() const;
  [[nodiscard]] bool of_several() const;
  /// Clouds seen one after the other: labels are carried between them, and mean the same in all.
  [[nodiscard]] bool is_sequence() const;
  /// Sessions that are not there are begun; else they are only read.
  [[nodiscard]] bool begins_sessions() const;
  /// A person annotates; else it is done without one.
  [[nodiscard]] bool opens_page() const;
};

/// Shows the work on one cloud, or the number of clouds of a folder that are done. Says every note once.
class AnnotateProgress {
 public:
  AnnotateProgress(ProgressBar& bar, bool of_several) : bar_{bar}, of_several_{of_several} {}
  void stage(std::string_view name, std::size_t done = 0, std::size_t total = 0) {
    if (!of_several_) bar_.update(name, done, total);
  }
  void clouds(std::size_t done, std::size_t total) {
    if (of_several_) bar_.update("clouds", done, total);
  }
  void note(const std::string& line) {
    if (noted_.insert(line).second) bar_.note(line);
  }

 private:
  ProgressBar& bar_;
  bool of_several_;
  std::set<std::string> noted_;
};

/// Files about one cloud; empty: none.
struct CloudJob {
  std::filesystem::path cloud;
  std::filesystem::path truth;
  std::filesystem::path session;
  std::filesystem::path seeds;
  std::filesystem::path segments;
  LabelFiles files;
  Pose T_world_cloud{Pose::Identity()};  ///< from the coordinates of the cloud's file
};

/// What is to be done, cloud by cloud.
struct JobList {
  std::vector<CloudJob> jobs;
  std::vector<std::string> notes;  ///< to be said
};

void add_annotate_options(CLI::App& command, AnnotateOptions& options);
/// Throws what is wrong with the options together.
void check_annotate_options(const AnnotateOptions& options);

/// The file of labels in a folder that belongs to a cloud: in its own format, where that is one for labels.
[[nodiscard]] std::filesystem::path labels_beside(const std::filesystem::path& folder,
                                                  const std::filesystem::path& cloud);

/// One cloud, or all of a folder or a sequence in their order. Errors of list_clouds and read_cloud_poses; not_found
/// for truth that is not there; invalid_argument where two clouds would share a file.
[[nodiscard]] Result<JobList> plan_jobs(const AnnotateOptions& options);

/// No file that is written is one of those that are read, or another one that is written.
[[nodiscard]] Status check_outputs(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                                   const GlobalOptions& global);

/// The page in which a person annotates.
class AnnotatePage {
 public:
  /// Listens, and prepares the cloud, unless there are several. Errors: those of plan_jobs, check_outputs, listen() and
  /// of the cloud with its session; invalid_argument where labels would replace those of another program.
  [[nodiscard]] static Result<std::unique_ptr<AnnotatePage>> open(const AnnotateOptions& options,
                                                                  const GlobalOptions& global);
  virtual ~AnnotatePage() = default;
  /// Returns where sessions and labels go.
  [[nodiscard]] virtual nlohmann::json result() const = 0;
  /// Serves until Ctrl-C.
  virtual void serve() = 0;
};

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
  /// Returns the state after a number of clicks per label, or after the last click where nothing was wrong any more.
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

/// Labels that control points give back.
struct SeedOutcome {
  std::size_t points{0};  ///< with a label
  std::size_t reproduced{0};
  std::size_t control_points{0};
};

/// A cloud as a session, a script or both have labelled it.
struct AnnotatedCloud {
  std::size_t points{0};  ///< that are finite
  LabelledPoints labels;
  std::vector<NumberedLabel> defined;  ///< what is known about labels
  std::size_t carried{0};              ///< points that took labels of the cloud before
  std::uint64_t actions{0};            ///< since the annotation began
  std::optional<SeedOutcome> seeds;
  std::optional<BestClick> next;    ///< where margins are asked for
  Eigen::Vector3d next_m{0, 0, 0};  ///< its place
  double graph_ms{0.0};
  std::vector<double> action_ms;  ///< time of each action of this run
  bool interrupted{false};

  [[nodiscard]] double labelled_share() const;
};

/// What is to be done on a cloud.
struct PlannedActions {
  std::vector<NumberedLabel> presets;
  std::vector<ScriptedAction> script;
  bool carry{false};                  ///< before the script, where a point takes a label
  std::optional<CarrySource> before;  ///< cloud whose labels are carried
  [[nodiscard]] bool empty() const { return presets.empty() && script.empty() && !carry; }
};

/// The annotation so far, of the job's session, with the actions done on it, after those of seeds. Where there are
/// none, the session is read and not opened; not_found if it was never begun. invalid_argument for seeds where it was.
[[nodiscard]] Result<AnnotatedCloud> annotate_cloud(const AnnotateOptions& options, const CloudJob& job,
                                                    const PlannedActions& actions, const LoadedCloud& cloud,
                                                    const Executor& executor, AnnotateProgress& progress);
/// Returns a cloud on which nothing was done.
[[nodiscard]] AnnotatedCloud untouched(const LoadedCloud& cloud);

/// A cloud of a folder with what was made of it.
template <class T>
struct CloudProgress {
  std::filesystem::path file;
  T made;
};

[[nodiscard]] nlohmann::json simulation_json(const AnnotateOptions& options, const SimulatedAnnotation& annotation);
[[nodiscard]] nlohmann::json mean_json(const AnnotateOptions& options,
                                       std::span<const CloudProgress<SimulatedAnnotation>> clouds);
[[nodiscard]] nlohmann::json annotation_json(const AnnotatedCloud& cloud);
[[nodiscard]] nlohmann::json mean_json(std::span<const CloudProgress<AnnotatedCloud>> clouds);
/// Summaries for people: of one cloud, and a table of several.
[[nodiscard]] std::string simulation_text(const AnnotateOptions& options, const SimulatedAnnotation& annotation);
[[nodiscard]] std::string simulations_text(const AnnotateOptions& options,
                                           std::span<const CloudProgress<SimulatedAnnotation>> clouds);
[[nodiscard]] std::string annotation_text(const AnnotateOptions& options, const AnnotatedCloud& cloud);
[[nodiscard]] std::string annotations_text(std::span<const CloudProgress<AnnotatedCloud>> clouds);

}  // namespace saccade::cli
