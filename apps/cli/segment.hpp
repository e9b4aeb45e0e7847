// SPDX-License-Identifier: Apache-2.0
#pragma once
// Request, input and findings of `saccade segment`, for its output.

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "json_output.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/core/names.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/lccp.hpp"
#include "saccade/segment/score_curve.hpp"
#include "segment_saliency.hpp"
#include "surfel_input.hpp"

namespace saccade::cli {

class Options;
class ProgressBar;

/// How a cloud is cut into segments; sv_lccp and flood_fill as the thesis does it with surfels.
enum class SegmentMethod { lccp, sv_lccp, flood_fill };
inline constexpr auto kSegmentMethodNames = make_names<SegmentMethod>(
    {{SegmentMethod::lccp, "lccp"}, {SegmentMethod::sv_lccp, "sv-lccp"}, {SegmentMethod::flood_fill, "flood-fill"}});

/// Files in the folder of --out.
inline constexpr std::string_view kSegmentCloud{"segments.ply"};
inline constexpr std::string_view kSegmentPicture{"segments.png"};
inline constexpr std::string_view kSegmentReport{"report.html"};
inline constexpr std::string_view kSegmentJson{"segment.json"};
inline constexpr std::array kSegmentFiles{kSegmentCloud, kSegmentPicture, kSegmentReport, kSegmentJson};

struct SegmentOptions {
  std::filesystem::path input;  ///< a cloud, or a map
  SegmentMethod method{SegmentMethod::lccp};
  bool as_printed{false};         ///< sv_lccp and flood_fill to the letter, where no option says otherwise
  std::filesystem::path out;      ///< file of the labelled cloud; empty: none
  std::filesystem::path picture;  ///< empty: none
  std::filesystem::path report;   ///< page of the report; empty: none
  bool write_pictures{true};      ///< into the folder of --out
  SupervoxelConfig supervoxels;
  bool has_voxel_size{false};  ///< given, so not chosen by the voxels of a map
  bool has_seed_size{false};
  std::optional<Eigen::Vector3d> viewpoint_m;  ///< default: what the cloud says
  LccpConfig lccp;
  double max_color_difference{SvLccpConfig{}.max_color_difference};
  FloodFillConfig flood_fill;
  std::optional<double> threshold;    ///< flood_fill's threshold, or the greatest difference of colours
  std::size_t list_from{1};           ///< points of the smallest segment in the JSON result
  std::filesystem::path curve_truth;  ///< empty: no curve
  std::vector<double> curve_thresholds;
  TruthOptions truth;  ///< for the curve; its radius is for the flood fill, too
  MeasureConfig measures;
  SaliencyOptions saliency;

  [[nodiscard]] bool fills() const { return method == SegmentMethod::flood_fill; }
};

/// Input of the segmentation: a cloud with all its fields, or the surface of a map.
struct SegmentInput {
  CloudFile file;
  PointCloud cloud;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< surface of a map; empty for a cloud
  Eigen::Vector3d viewpoint_m{Eigen::Vector3d::Zero()};
  std::optional<double> map_voxel_size_m;  ///< none for a cloud
  [[nodiscard]] bool is_map() const { return map_voxel_size_m.has_value(); }
  Origin radii{Origin::file};
  Origin normals{Origin::file};
};

struct SegmentFindings {
  SupervoxelResult supervoxels;  ///< with the edges that were there before colours pruned any; of a flood fill none
  std::vector<std::uint32_t> labels;
  std::size_t segments{0};
  std::vector<SegmentMeasures> measures;
  std::vector<Saliency> saliencies;
  std::size_t points{0};  ///< with a position, so in a segment
  double supervoxels_ms{0.0};
  double lccp_ms{0.0};
  double surfels_ms{0.0};  ///< radii and normals that the file lacks
  double flood_fill_ms{0.0};
  double saliency_ms{0.0};
  std::optional<ScoreCurve> curve;
  std::string label_kept_as;  ///< the name of the input's own field "label" in the output; empty: it has none
};

/// Declares the options; they outlive the parsing.
void declare_segment(Options& declared, SegmentOptions& options);
/// Throws usage errors, and sets the defaults of the method. `out`: value of --out.
void check_segment_options(const CLI::App& command, const std::filesystem::path& out, SegmentOptions& options);
/// Sets the sizes that were not given for a map with this voxel size: 1, 2, 4 or 8 of its voxels, as LiveSegments has
/// them, and seeds as many voxels apart as otherwise. Answers invalid_argument for seeds closer than voxels.
[[nodiscard]] Status fit_to_map(double map_voxel_size_m, SegmentOptions& options);
/// Whether --out names a folder for all results: a name without the ending of a cloud.
[[nodiscard]] bool is_segment_folder(const std::filesystem::path& out);

/// By its name: .sacmap.
[[nodiscard]] bool is_map(const std::filesystem::path& input);
/// A map's surface points are the vertices of its mesh, with TSDF-gradient normals (thesis §3.1).
[[nodiscard]] Result<SegmentInput> read_segment_input(const std::filesystem::path& path, const Executor& executor);

[[nodiscard]] nlohmann::json segment_json(const SegmentOptions& options, const SegmentInput& input,
                                          const SegmentFindings& findings);
/// Scores at all thresholds against the labels of a truth.
[[nodiscard]] Result<ScoreCurve> segment_curve(const SegmentOptions& options, const SegmentInput& input,
                                               const SegmentFindings& findings, const Executor& executor,
                                               ProgressBar& bar);
[[nodiscard]] nlohmann::json curve_json(const SegmentOptions& options, const ScoreCurve& curve);
[[nodiscard]] std::string curve_text(const ScoreCurve& curve);

[[nodiscard]] std::string segments_text(const SegmentOptions& options, const SegmentFindings& findings);
[[nodiscard]] ColorImage segment_sheet(const SegmentOptions& options, const SegmentInput& input,
                                       const SegmentFindings& findings, const Executor& executor);

}  // namespace saccade::cli
