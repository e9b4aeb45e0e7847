// SPDX-License-Identifier: Apache-2.0
// saccade segment: a point cloud, or the surface of a map, in segments, and how much each draws attention.
#include "segment.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "exit_status.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress_bar.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

Status check_outputs(const SegmentOptions& options, const GlobalOptions& global) {
  SACCADE_CHECK(check_output(options.out, "--out", {options.input, options.curve_truth}));
  SACCADE_CHECK(check_output(options.picture, "--picture", {options.input, options.out, options.curve_truth}));
  const fs::path json_file = global.json_to_stdout() ? "" : global.json;
  SACCADE_CHECK(check_output(json_file, "--json", {options.input, options.out, options.picture, options.curve_truth}));
  return check_json_output(global);
}

/// Of a cloud in other units, or one too sparse for the voxels, nothing touches anything.
bool are_too_small(const SegmentFindings& findings) {
  constexpr std::size_t kFewPoints{20};
  return findings.points > kFewPoints && 2 * findings.supervoxels.supervoxels.size() > findings.points;
}

Status stop_if_interrupted() { return interrupted() ? Status{Error{Errc::cancelled, "interrupted", {}}} : Status{}; }

Status judge(const SegmentOptions& options, const SegmentInput& input, const Executor& executor,
             SegmentFindings& findings) {
  const Stopwatch clock;
  SACCADE_TRY(const SegmentedPoints points,
              SegmentedPoints::create(input.cloud.positions_m, findings.labels, findings.segments));
  SACCADE_TRY(findings.measures, measure_segments(points, options.measures, executor));
  findings.saliencies = options.saliency.heuristic({points, findings.measures, options.measures});
  findings.saliency_ms = clock.elapsed_ms();
  findings.points = points.start_of(points.segments());  // those in no segment come last
  return {};
}

Status find_by_supervoxels(const SegmentOptions& options, const SegmentInput& input, const Executor& executor,
                           ProgressBar& bar, SegmentFindings& findings) {
  SupervoxelConfig config = options.supervoxels;
  const Eigen::Vector3d own_m = config.voxels.single_camera ? Eigen::Vector3d::Zero() : input.viewpoint_m;
  config.voxels.viewpoint_m = options.viewpoint_m.value_or(own_m);
  bar.update("supervoxels", 0, 0);
  Stopwatch clock;
  auto supervoxels = find_supervoxels(input.cloud, config, executor);
  if (!supervoxels) return in_file(supervoxels.error(), options.input);
  findings.supervoxels = std::move(*supervoxels);
  findings.supervoxels_ms = clock.lap_ms();
  SACCADE_CHECK(stop_if_interrupted());
  bar.update("segments", 0, 0);
  SupervoxelResult pruned;
  if (options.method == SegmentMethod::sv_lccp) {
    pruned = findings.supervoxels;
    prune_by_color(pruned, options.max_color_difference);
  }
  SACCADE_TRY(
      LccpResult found,
      segment_by_convexity(options.method == SegmentMethod::sv_lccp ? pruned : findings.supervoxels, options.lccp));
  findings.labels = std::move(found.labels);
  findings.segments = found.segments;
  findings.lccp_ms = clock.lap_ms();
  return {};
}

Status find_by_filling(const SegmentOptions& options, SegmentInput& input, const Executor& executor, ProgressBar& bar,
                       SegmentFindings& findings) {
  bar.update("surfels", 0, 0);
  Stopwatch clock;
  input.radii = complete_radii(input.cloud, options.truth.radius_m, executor);
  input.normals = complete_normals(input.cloud, options.viewpoint_m.value_or(input.viewpoint_m), executor);
  findings.surfels_ms = clock.lap_ms();
  SACCADE_CHECK(stop_if_interrupted());
  bar.update("flood fill", 0, 0);
  auto found = flood_fill(input.cloud, options.flood_fill, executor);
  if (!found) return in_file(found.error(), options.input);
  findings.labels = std::move(found->labels);
  findings.segments = found->count;
  findings.flood_fill_ms = clock.lap_ms();
  return {};
}

Result<SegmentFindings> find_segments(const SegmentOptions& options, SegmentInput& input, const Executor& executor,
                                      ProgressBar& bar) {
  SegmentFindings findings;
  if (options.fills()) {
    SACCADE_CHECK(find_by_filling(options, input, executor, bar, findings));
  } else {
    SACCADE_CHECK(find_by_supervoxels(options, input, executor, bar, findings));
  }
  SACCADE_CHECK(stop_if_interrupted());
  bar.update("saliency", 0, 0);
  SACCADE_CHECK(judge(options, input, executor, findings));
  SACCADE_CHECK(stop_if_interrupted());
  if (!options.curve_truth.empty()) {
    SACCADE_TRY(findings.curve, segment_curve(options, input, findings, executor, bar));
  }
  return findings;
}

/// Whether the PLY has more than its points and a PCD is wanted.
bool loses_elements(const CloudFile& cloud, const fs::path& out) {
  const auto* ply = std::get_if<PlyFile>(&cloud.file);
  return ply != nullptr && !out.empty() && out.extension() != ".ply" && ply->elements.size() > 1;
}

Status write_segment_files(const SegmentOptions& options, const SegmentInput& input, const SegmentFindings& findings,
                           const Executor& executor) {
  if (!options.out.empty()) SACCADE_CHECK(write_cloud(options.out, input.file));
  if (options.picture.empty() || findings.points == 0) return {};
  return write_png(options.picture, segment_sheet(options, input, findings, executor));
}

Result<int> run_segment(const SegmentOptions& options, const GlobalOptions& global) {
  Stopwatch clock;
  const Stopwatch total;
  TimingsMs timings_ms;
  const Executor executor = global.executor();
  ProgressBar bar{global.quiet};
  SACCADE_CHECK(check_outputs(options, global));
  bar.update("reading", 0, 0);
  SACCADE_TRY(SegmentInput input, read_segment_input(options.input, executor));
  timings_ms["read"] = clock.lap_ms();
  SACCADE_CHECK(stop_if_interrupted());
  SACCADE_TRY(SegmentFindings findings, find_segments(options, input, executor, bar));
  timings_ms["segment"] = clock.lap_ms();
  if (!options.out.empty()) findings.label_kept_as = add_labels(input.file, findings.labels);
  if (!findings.label_kept_as.empty()) {
    bar.note("the cloud has a field label already; its values are kept as " + findings.label_kept_as);
  }
  if (are_too_small(findings)) {
    bar.note(
        "most supervoxels hold a point or two: are the coordinates metres? Else take larger --voxel-size and "
        "--seed-size");
  }
  if (loses_elements(input.file, options.out)) {
    bar.note("a PCD holds points only; what else the PLY has, such as faces, stays behind (name a .ply with --out)");
  }
  bar.update("writing", 0, 0);
  SACCADE_CHECK(write_segment_files(options, input, findings, executor));
  timings_ms["write"] = clock.lap_ms();
  timings_ms["total"] = total.elapsed_ms();
  bar.finish();
  SACCADE_CHECK(write_result("segment", global, executor, timings_ms, segment_json(options, input, findings)));
  if (findings.points == 0) {
    const bool empty = input.cloud.positions_m.empty();
    print_error(
        "segment",
        options.input.string() +
            (empty ? ": has no points"
                   : ": has no point with a finite place" +
                         std::string{options.supervoxels.voxels.single_camera ? " in front of the camera" : ""}) +
            "; there is nothing to segment");
    return static_cast<int>(ExitStatus::no_result);
  }
  if (global.json_to_stdout()) return static_cast<int>(ExitStatus::done);
  print_segments(options, findings);
  if (findings.curve) print_curve(*findings.curve);
  return static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_segment(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("segment", "a point cloud or a map in segments, and their saliency");
  auto options = std::make_shared<SegmentOptions>();
  add_segment_options(*command, *options);
  command->callback([command, options, &global, &action] {
    check_segment_options(*command, *options);
    action = [options, &global] { return run_segment(*options, global); };
  });
}

}  // namespace saccade::cli
