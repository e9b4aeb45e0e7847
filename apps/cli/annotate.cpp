// SPDX-License-Identifier: Apache-2.0
// saccade annotate: labels of a cloud's points from a few control points, here placed by a simulated annotator.
#include "annotate.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/label_output.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

Status check_outputs(const AnnotateOptions& options, const GlobalOptions& global) {
  if (!options.out.empty()) SACCADE_CHECK(check_labels_path(options.out));
  SACCADE_CHECK(check_output(options.out, "--out", {options.cloud, options.truth}));
  const fs::path json_file = global.json_to_stdout() ? "" : global.json;
  SACCADE_CHECK(check_output(json_file, "--json", {options.cloud, options.truth, options.out}));
  return check_json_output(global);
}

Result<int> run_annotate(const AnnotateOptions& options, const GlobalOptions& global) {
  Stopwatch clock;
  const Stopwatch total;
  TimingsMs timings_ms;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(check_outputs(options, global));
  bar.update("reading", 0, 0);
  SACCADE_TRY(const CloudFile cloud, read_cloud(options.cloud));
  timings_ms["read"] = clock.lap_ms();
  SACCADE_TRY(const SimulatedAnnotation annotation, simulate_annotation(options, cloud, executor, bar));
  timings_ms["simulate"] = clock.lap_ms();
  if (!options.out.empty()) {
    bar.update("writing", 0, 0);
    SACCADE_CHECK(write_labels(options.out, cloud, annotation.labels));
    timings_ms["write"] = clock.lap_ms();
  }
  timings_ms["total"] = total.elapsed_ms();
  bar.finish();
  SACCADE_CHECK(write_json_output(
      global, json_envelope("annotate", global, executor, timings_ms, annotation_json(options, annotation))));
  if (!global.json_to_stdout()) print_annotation(options, annotation);
  return static_cast<int>(ExitStatus::done);
}

void add_graph_options(CLI::App& command, NeighbourhoodConfig& graph) {
  command.add_option("--neighbours", graph.neighbours, "nearest points that each point is joined to")
      ->type_name("K")
      ->capture_default_str();
  command.add_option("--position-weight", graph.position_weight_per_m, "cost of a metre")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_option("--normal-weight", graph.normal_weight, "cost of a difference of normals of 1 (a right angle)")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_option("--color-weight", graph.color_weight, "cost of an edge of the colour cube")
      ->type_name("WEIGHT")
      ->capture_default_str();
  command.add_option("--max-path", graph.max_path, "a control point reaches as far as paths cost less than this")
      ->type_name("COST")
      ->capture_default_str();
  command.add_flag("--adapt-to-density", graph.adapt_to_density,
                   "distances count by the local spacing of points, for clouds that thin out (LiDAR)");
}

}  // namespace

void add_annotate(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("annotate", "labels of a point cloud from a few control points");
  auto options = std::make_shared<AnnotateOptions>();
  command->add_option("cloud", options->cloud, "point cloud: PCD, PLY, text (XYZ, CSV) or KITTI .bin")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("CLOUD");
  command
      ->add_option("--simulate", options->truth,
                   "true labels of its points (PCD, PLY, .label, .npy, text): a simulated annotator clicks at the "
                   "centre of the largest error, again and again")
      ->required()
      ->check(CLI::ExistingFile)
      ->type_name("TRUTH");
  command->add_option("--clicks", options->clicks, "clicks per label")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  const std::map<std::string, AnnotationMethod> methods{{"control-points", AnnotationMethod::control_points},
                                                        {"rectangle", AnnotationMethod::rectangle}};
  command
      ->add_option("--method", options->method,
                   "control-points, or rectangle: the best rectangle of six views, action by action")
      ->transform(CLI::CheckedTransformer(methods))
      ->type_name("METHOD")
      ->default_str("control-points");
  const std::map<std::string, Tens> tens{{"detect", Tens::detect}, {"merge", Tens::merge}, {"keep", Tens::keep}};
  command
      ->add_option("--tens", options->tens,
                   "true labels of one ten are parts of one object, as in mOSD (1 to 9: the table); merge, keep, or "
                   "detect")
      ->transform(CLI::CheckedTransformer(tens))
      ->type_name("HOW")
      ->default_str("detect");
  command->add_option("--out", options->out, "labels: .pcd, .ply, .csv, .xyz, .txt, .label or .npy")->type_name("FILE");
  add_graph_options(*command, options->graph);
  command->callback([&global, &action, options] {
    if (const Status valid = options->graph.validate(); !valid) {
      throw CLI::ValidationError{"annotate", valid.error().message};
    }
    action = [&global, options] { return run_annotate(*options, global); };
  });
}

}  // namespace saccade::cli
