// SPDX-License-Identifier: Apache-2.0
// saccade segment: a point cloud, or the surface of a map, in segments, and how much each draws attention.
#include "segment.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "context.hpp"
#include "saccade/cloud/point_spacing.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "server/report_file.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

Status check_outputs(const SegmentOptions& options, const GlobalOptions& global) {
  SACCADE_CHECK(check_output(options.out, "--out", {options.input, options.curve_truth}));
  SACCADE_CHECK(check_output(options.picture, "--picture", {options.input, options.out, options.curve_truth}));
  const fs::path json_file = global.json_to_stdout() ? "" : global.json;
  return check_output(json_file, "--json", {options.input, options.out, options.picture, options.curve_truth});
}

std::string rounded(double length_m) {
  std::ostringstream text;
  text << std::setprecision(2) << length_m;
  return text.str();
}

/// Advice for a map whose voxels are larger than those of the segmentation, so that nothing touches anything; empty
/// for others.
std::string advice_on_small_voxels(const SegmentOptions& options, double map_voxel_size_m) {
  const double voxel_m = options.supervoxels.voxels.voxel_size_m;
  if (options.fills() || voxel_m >= map_voxel_size_m) return {};
  return "the voxels are " + rounded(voxel_m) + " m large and those of the map " + rounded(map_voxel_size_m) +
         " m, so that few points touch: leave out --voxel-size and --seed-size, or give no less than the map's";
}

/// Advice for a cloud whose points are far apart against the voxels, so that nothing touches anything; empty for
/// others. What to try: voxels twice as large as the distance between points, and seeds as far apart as usual for them.
std::string advice_on_sparse_points(const SegmentOptions& options, const SegmentInput& input,
                                    const Executor& executor) {
  if (input.is_map()) return advice_on_small_voxels(options, *input.map_voxel_size_m);
  constexpr double kVoxelsPerSpacing{2.0};
  constexpr double kFarApart{1.5};
  const SupervoxelConfig& supervoxels = options.supervoxels;
  const double voxel_m = supervoxels.voxels.voxel_size_m;
  if (options.fills() || supervoxels.voxels.single_camera) return {};
  const std::optional<double> spacing_m = point_spacing_m(input.cloud.positions_m, executor);
  if (!spacing_m || *spacing_m < kFarApart * voxel_m) return {};
  const double try_m = kVoxelsPerSpacing * *spacing_m;
  return "the points are " + rounded(*spacing_m) + " m apart and the voxels " + rounded(voxel_m) +
         " m large, so that few points touch: are the coordinates metres? Try --voxel-size " + rounded(try_m) +
         " --seed-size " + rounded(try_m * supervoxels.seed_spacing_m / voxel_m);
}

Status end_if_interrupted() { return interrupted() ? Status{Error{Errc::cancelled, "interrupted", {}}} : Status{}; }

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
  config.voxels.viewpoint_m = options.viewpoint_m.value_or(own_m) - input.cloud.offset_m;
  bar.update("supervoxels", 0, 0);
  Stopwatch clock;
  auto supervoxels = find_supervoxels(input.cloud, config, executor);
  if (!supervoxels) return in_file(supervoxels.error(), options.input);
  findings.supervoxels = std::move(*supervoxels);
  findings.supervoxels_ms = clock.lap_ms();
  SACCADE_CHECK(end_if_interrupted());
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
  input.normals =
      complete_normals(input.cloud, options.viewpoint_m.value_or(input.viewpoint_m) - input.cloud.offset_m, executor);
  findings.surfels_ms = clock.lap_ms();
  SACCADE_CHECK(end_if_interrupted());
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
  SACCADE_CHECK(end_if_interrupted());
  bar.update("saliency", 0, 0);
  SACCADE_CHECK(judge(options, input, executor, findings));
  SACCADE_CHECK(end_if_interrupted());
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

std::string nothing_to_segment(const SegmentOptions& options, const SegmentInput& input) {
  const std::string why =
      input.cloud.positions_m.empty()
          ? ": has no points"
          : ": has no point with a finite place" +
                std::string{options.supervoxels.voxels.single_camera ? " in front of the camera" : ""};
  return options.input.string() + why + "; there is nothing to segment";
}

class Segment final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"segment", "divides a point cloud or a map into segments, and rates their saliency"};
  }
  void declare(Options& options) override {
    declare_segment(options, segment_);
    command_ = &options.group();
    request_ = &options.request();
  }
  void check(const GlobalOptions& /*global*/) override { check_segment_options(*command_, request_->path, segment_); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_CHECK(open_output(context));
    SACCADE_CHECK(check_outputs(segment_, context.global()));
    context.stage("reading");
    SACCADE_TRY(SegmentInput input, read_segment_input(segment_.input, context.executor()));
    context.lap("read");
    if (input.is_map()) SACCADE_CHECK(fit_to_map(*input.map_voxel_size_m, segment_));
    SACCADE_CHECK(context.stop_if_interrupted());
    SACCADE_TRY(SegmentFindings findings, find_segments(segment_, input, context.executor(), context.bar()));
    context.lap("segment");
    if (!segment_.out.empty()) findings.label_kept_as = add_labels(input.file, findings.labels);
    note(input, findings, context);
    context.stage("writing");
    if (context.folder() != nullptr) SACCADE_CHECK(context.folder()->remove(kSegmentFiles));
    SACCADE_CHECK(write_segment_files(segment_, input, findings, context.executor()));
    context.lap("write");
    Outcome outcome{.result = segment_json(segment_, input, findings)};
    if (findings.points == 0) return std::move(outcome).empty_if(true, nothing_to_segment(segment_, input));
    outcome.text = segments_text(segment_, findings);
    if (findings.curve) outcome.text += curve_text(*findings.curve);
    if (!segment_.report.empty()) {
      SACCADE_CHECK(server::write_report(segment_.report, context.document(outcome.result)));
    }
    return outcome;
  }

 private:
  /// Opens the folder of --out, where one was named, and names the files in it.
  [[nodiscard]] Status open_output(Context& context) {
    segment_.out = context.out();
    if (!is_segment_folder(context.out())) return {};
    SACCADE_CHECK(context.open_folder());
    segment_.out = context.out() / kSegmentCloud;
    segment_.report = context.out() / kSegmentReport;
    if (segment_.write_pictures && segment_.picture.empty()) segment_.picture = context.out() / kSegmentPicture;
    return {};
  }

  /// Says what the user should know of the input.
  void note(const SegmentInput& input, const SegmentFindings& findings, Context& context) const {
    if (!findings.label_kept_as.empty()) {
      context.bar().note("the cloud has a field label already; its values are kept as " + findings.label_kept_as);
    }
    if (!input.cloud.offset_m.isZero(0.0)) context.bar().note(offset_text(input.cloud.offset_m));
    const std::string advice = advice_on_sparse_points(segment_, input, context.executor());
    if (!advice.empty()) context.bar().note(advice);
    if (loses_elements(input.file, segment_.out)) {
      context.bar().note(
          "a PCD holds points only; what else the PLY has, such as faces, stays behind (name a .ply with --out)");
    }
  }

  const CLI::App* command_{nullptr};
  const FolderRequest* request_{nullptr};
  SegmentOptions segment_;
};

}  // namespace

void add_segment(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Segment>(program, global, action);
}

}  // namespace saccade::cli
